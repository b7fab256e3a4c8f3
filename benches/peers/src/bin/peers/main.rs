//! Runs the scene `hang` in the peers: one JSON line a run on standard output.
//!
//! ```text
//! cargo run --release --bin peers > peers.jsonl
//! cargo run --release --bin peers -- --n 64
//! ```

use bevy_drape_peers::{line::Line, scene::Cloth};
use clap::Parser;

#[cfg(feature = "jolt")]
mod jolt;
#[cfg(feature = "rapier")]
mod rapier;
#[cfg(feature = "silk")]
mod silk;

#[derive(Parser)]
#[command(about = "The scene `hang` in other cloth solvers: one JSON line a run on standard output")]
struct Cli {
    /// Particles along each side
    #[arg(long, num_args = 1.., default_values_t = [32, 64, 128], value_parser = clap::value_parser!(u16).range(2..=512))]
    n: Vec<u16>,
}

/// Runs a cloth in a peer, with all settings, and hands out a line for each.
type Sweep = fn(&Cloth, fn(&Line));

fn main() {
    let sweeps: &[Sweep] = &[
        #[cfg(feature = "silk")]
        silk::sweep,
        #[cfg(feature = "jolt")]
        jolt::sweep,
        #[cfg(feature = "rapier")]
        rapier::sweep,
    ];
    for n in Cli::parse().n {
        let cloth = Cloth::hanging(n.into());
        sweeps.iter().for_each(|sweep| sweep(&cloth, print));
    }
}

/// Prints a line as soon as it is there.
fn print(line: &Line) {
    println!("{}", serde_json::to_string(line).expect("a line is plain data"));
}
