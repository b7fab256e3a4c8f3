//! Writes the tables and plots of docs/performance.md, from JSON lines of the peers and of bevy_drape's lab.
//!
//! ```text
//! cargo run --release --no-default-features --bin report
//! ```

use std::{
    error::Error,
    fs, io,
    path::{Path, PathBuf},
};

use bevy_drape_peers::line::Line;
use clap::Parser;
use serde_json::Value;

mod document;
mod own;
mod plot;
mod read;
mod table;

/// Particles along each side of the cloth that is plotted.
const PLOTTED: usize = 64;

#[derive(Parser)]
#[command(about = "Writes tables and plots of the lines of `peers` and of bevy_drape's lab into a document")]
struct Cli {
    /// Where the lines are: a file of JSON lines for each table. The plots are written there too
    #[arg(long, default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/performance"))]
    lines: PathBuf,
    /// Markdown with places for the tables: between `<!-- NAME -->` and `<!-- end NAME -->`
    #[arg(long, default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/performance.md"))]
    document: PathBuf,
}

/// Makes a table of the lines of a file.
type Table = fn(&[Value]) -> String;

const TABLES: [(&str, Table); 7] = [
    ("machine", own::machine),
    ("sweep", own::sweep),
    ("sizes", own::sizes),
    ("many", own::many),
    ("shares", own::shares),
    ("app", own::app),
    ("builds", own::builds),
];

fn main() -> Result<(), Box<dyn Error>> {
    let Cli { lines: folder, document } = Cli::parse();
    let mut text = read_file(&document)?;
    for (name, table) in TABLES {
        text = document::fill(&text, name, &table(&read::values(&read_file(&file(&folder, name))?)?))?;
    }
    let mut lines = read::lines(&read_file(&file(&folder, "peers"))?)?;
    lines.extend(read::lines(&read_file(&file(&folder, "hang"))?)?);
    read::sort(&mut lines);
    text = document::fill(&text, "peers", &table::markdown(&lines))?;
    fs::write(&document, text)?;
    let plotted: Vec<&Line> = lines.iter().filter(|line| line.n == PLOTTED).collect();
    fs::write(folder.join("peers.svg"), plot::svg(&plotted, PLOTTED)?)?;
    Ok(())
}

fn file(folder: &Path, name: &str) -> PathBuf {
    folder.join(name).with_extension("jsonl")
}

fn read_file(file: &Path) -> io::Result<String> {
    fs::read_to_string(file).map_err(|error| io::Error::new(error.kind(), format!("{}: {error}", file.display())))
}
