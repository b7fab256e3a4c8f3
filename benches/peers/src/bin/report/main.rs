//! Makes a table and a plot of JSON lines, those of the peers and those of bevy_drape's lab.
//!
//! ```text
//! cargo run --release --no-default-features --bin report -- peers.jsonl lab.jsonl
//! ```

use std::{error::Error, fs, path::PathBuf};

use clap::Parser;

mod plot;
mod read;
mod table;

#[derive(Parser)]
#[command(about = "Makes a table and a plot of the lines of `peers` and of `lab -- hang`")]
struct Cli {
    /// Files of JSON lines
    #[arg(required = true)]
    lines: Vec<PathBuf>,
    /// The table, Markdown
    #[arg(long, default_value = "peers.md")]
    table: PathBuf,
    /// The plot, SVG
    #[arg(long, default_value = "peers.svg")]
    plot: PathBuf,
    /// Particles along each side of the cloth that is plotted
    #[arg(long, default_value_t = 64)]
    n: usize,
}

fn main() -> Result<(), Box<dyn Error>> {
    let cli = Cli::parse();
    let mut lines = Vec::new();
    for file in &cli.lines {
        let text = fs::read_to_string(file).map_err(|error| format!("{}: {error}", file.display()))?;
        lines.extend(read::lines(&text).map_err(|error| format!("{}, {error}", file.display()))?);
    }
    read::sort(&mut lines);
    fs::write(&cli.table, table::markdown(&lines))?;
    let plotted: Vec<_> = lines.iter().filter(|line| line.n == cli.n).collect();
    fs::write(&cli.plot, plot::svg(&plotted, cli.n)?)?;
    Ok(())
}
