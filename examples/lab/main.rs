//! Experiments without a window: one JSON line each on standard output, for comparing machines and versions.
//!
//! ```text
//! cargo run --release --example lab -- hang --n 64 --substeps 8 --frames 300 --solver xpbd
//! cargo run --release --example lab -- drape --n 64
//! cargo run --release --example lab -- --help
//! ```

use std::{path::PathBuf, process::ExitCode};

use clap::{Args, Parser, Subcommand, ValueEnum};

mod app;
mod measure;
mod scene;

#[derive(Parser)]
#[command(about = "Experiments without a window: one JSON line each on standard output")]
struct Cli {
    #[command(subcommand)]
    experiment: Experiment,
}

#[derive(Subcommand)]
enum Experiment {
    /// A square metre of cloth, horizontal at first, swings from two corners or an edge
    Hang {
        #[command(flatten)]
        options: Options,
        /// What is pinned
        #[arg(long, value_enum, default_value = "corners")]
        pins: PinnedPart,
    },
    /// What a frame costs in a headless Bevy app: an app without cloth, one with the hanging cloth, and its solver
    App {
        #[command(flatten)]
        options: Options,
    },
    /// What a frame costs with a hundred flags of 32 x 20 particles in the wind
    Many {
        /// Frames of 1/60 s
        #[arg(long, default_value_t = 300, value_parser = clap::value_parser!(u32).range(1..))]
        frames: u32,
        /// Steps all cloths on one thread
        #[arg(long)]
        single_threaded: bool,
    },
    /// The same cloth falls on a sphere over a ground
    Drape {
        #[command(flatten)]
        options: Options,
    },
}

#[derive(Args)]
struct Options {
    /// Particles along each side
    #[arg(long, default_value_t = 64, value_parser = clap::value_parser!(u32).range(2..=1024))]
    n: u32,
    /// Substeps a frame; the explicit solver finds its own
    #[arg(long, default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..))]
    substeps: u32,
    /// Frames of 1/60 s
    #[arg(long, default_value_t = 300, value_parser = clap::value_parser!(u32).range(1..))]
    frames: u32,
    /// How the springs are integrated
    #[arg(long, value_enum, default_value = "xpbd")]
    solver: Solver,
    /// Whether particles are tethered to the pins (xpbd only)
    #[arg(long, value_enum, default_value = "on")]
    tethers: Switch,
    /// By how much of its length a tether gives
    #[arg(long, default_value_t = 0.002)]
    tether_slack: f32,
    /// Damping of the velocity, 1/s
    #[arg(long, default_value_t = 1.0)]
    damping: f32,
    /// Threads; one cloth runs on one thread so far
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1))]
    threads: u32,
    /// Writes the positions as text, a particle a line: x y z in m
    #[arg(long, value_name = "FILE")]
    positions: Option<PathBuf>,
    /// Writes the positions of this moment instead of the last
    #[arg(long, requires = "positions", value_name = "SECONDS")]
    at_seconds: Option<f32>,
}

#[derive(Clone, Copy, ValueEnum)]
enum PinnedPart {
    Corners,
    Top,
}

#[derive(Clone, Copy, ValueEnum)]
enum Solver {
    Xpbd,
    Explicit,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Switch {
    On,
    Off,
}

fn main() -> ExitCode {
    let Cli { experiment } = Cli::parse();
    let result = match &experiment {
        Experiment::Hang { options, pins } => measure::run("hang", options, scene::hang(options, *pins)),
        Experiment::Drape { options } => measure::run("drape", options, scene::drape(options)),
        Experiment::App { options } => Ok(app::one_cloth(options)),
        Experiment::Many { frames, single_threaded } => Ok(app::many_flags(*frames, *single_threaded)),
    };
    match result {
        Ok(line) => {
            println!("{line}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
