//! Experiments without a window: one JSON line each on standard output, for comparing machines and versions.
//!
//! ```text
//! cargo run --release --example lab -- hang --n 64 --substeps 8 --frames 300 --solver xpbd
//! cargo run --release --example lab -- hang --n 64 --mesh delaunay --compare-oracle
//! cargo run --release --example lab -- drape --n 64 --mesh assets/flag.glb
//! cargo run --release --example lab -- --sweep
//! cargo run --release --example lab -- --help
//! ```

use std::{io, path::PathBuf, process::ExitCode, str::FromStr};

use bevy_drape::{
    prelude::Fabric,
    solver::{Effort, LevelPass, Topology},
};
use clap::{Args, Parser, Subcommand, ValueEnum, builder::PossibleValuesParser};
use serde_json::Value;

mod app;
mod laboratory;
mod measure;
mod mesh;
mod oracle;
mod pins;
mod report;
mod scene;
mod shares;
mod sizes;
mod sweep;
mod threads;

use laboratory::{EXPERIMENTS, Extent};
use mesh::MeshSource;
use oracle::Oracle;

#[derive(Parser)]
#[command(about = "Experiments without a window: one JSON line each on standard output")]
#[command(args_conflicts_with_subcommands = true, arg_required_else_help = true)]
struct Cli {
    /// Measures all that has a target, in two minutes: one line each
    #[arg(long)]
    sweep: bool,
    #[command(subcommand)]
    experiment: Option<Experiment>,
}

#[derive(Subcommand)]
enum Experiment {
    /// A square metre of cloth, horizontal at first, swings from two corners or an edge
    Hang {
        #[command(flatten)]
        options: Options,
        /// grid, delaunay, hex, skirt, ell, sleeve, or a FILE.glb, which is scaled to 1 m
        #[arg(long, default_value = "grid")]
        mesh: MeshSource,
        /// What is pinned: two corners of the top, or all of it, as always with a skirt or sleeve; of a file's mesh, the top is
        /// its highest 2 %
        #[arg(long, value_enum, default_value = "corners")]
        pins: PinnedPart,
        /// Also runs the same springs in tiny steps of f64, to 0.5 s, and says how far the cloth is from them then
        #[arg(long)]
        compare_oracle: bool,
    },
    /// What a frame costs in a headless Bevy app: an app without cloth, one with the hanging cloth, and its solver
    App {
        #[command(flatten)]
        options: Options,
    },
    /// What a frame costs in a headless Bevy app while a mesh becomes cloth, and in which it has become cloth
    Build {
        #[command(flatten)]
        options: Options,
    },
    /// What a frame costs with many flags of 32 x 20 particles in the wind
    Many {
        /// Flags
        #[arg(long, default_value_t = 100)]
        cloths: u32,
        /// Frames of 1/60 s
        #[arg(long, default_value_t = 300, value_parser = clap::value_parser!(u32).range(1..))]
        frames: u32,
        /// Steps all cloths on one thread
        #[arg(long)]
        single_threaded: bool,
    },
    /// What threads gain: one hanging cloth shared by them, against as many cloths as threads side by side
    Threads {
        #[command(flatten)]
        options: Options,
    },
    /// Hanging cloths of several sizes, by the strain and at settings that were found for each, on one and two threads: a
    /// line each
    Sizes {
        /// Particles along each side
        #[arg(long, num_args = 1.., default_values_t = sizes::ALL)]
        n: Vec<u32>,
    },
    /// Where the time of the hanging cloth's frame goes, found by leaving out one thing after the other
    Shares {
        #[command(flatten)]
        options: Options,
    },
    /// Experiments whose answers are on paper: a line for each measurement
    Laboratory {
        /// Only these of them
        #[arg(value_parser = laboratory_name())]
        names: Vec<String>,
        /// The few small cases of the tests
        #[arg(long)]
        brief: bool,
        /// All of them, with tables for the places that this document has for them, and plots beside it
        #[arg(long, value_name = "FILE.md", conflicts_with_all = ["names", "brief"])]
        report: Option<PathBuf>,
    },
    /// The same cloth falls on a sphere over a ground
    Drape {
        #[command(flatten)]
        options: Options,
        /// grid, delaunay, hex, skirt, ell, sleeve, or a FILE.glb, which is scaled to 1 m
        #[arg(long, default_value = "grid")]
        mesh: MeshSource,
    },
}

#[derive(Args, Clone)]
struct Options {
    /// Particles along each side, n; n² or about as many on other meshes than the grid, and without effect on a file
    #[arg(long, default_value_t = 64, value_parser = clap::value_parser!(u32).range(2..=1024))]
    n: u32,
    /// Moves the vertices inside a grid, delaunay, hex or ell at random by up to so much of a cell
    #[arg(long, default_value_t = 0.0)]
    jitter: f32,
    /// Substeps a frame; by default as many as the strain needs (strands) or 8 (xpbd). The explicit solver finds its own
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..))]
    substeps: Option<u32>,
    /// The largest strain that is wanted: strands choose their substeps by it
    #[arg(long, default_value_t = 0.01)]
    max_strain: f32,
    /// Frames of 1/60 s
    #[arg(long, default_value_t = 300, value_parser = clap::value_parser!(u32).range(1..))]
    frames: u32,
    /// How the springs are integrated
    #[arg(long, value_enum, default_value = "strands")]
    solver: Solver,
    /// Coarse levels of strands: auto, none, or STRIDExITERATIONS,.. as in 8x8,4x4
    #[arg(long, default_value = "auto")]
    levels: Levels,
    /// Whether particles are tethered to the pins (xpbd only)
    #[arg(long, value_enum, default_value = "on")]
    tethers: Switch,
    /// By how much of its length a tether gives
    #[arg(long, default_value_t = 0.002)]
    tether_slack: f32,
    /// Stiffness of springs along the threads, of those along diagonals, and of those that bend, N/m; 0 leaves them out
    #[arg(long, value_names = ["STRUCTURAL", "SHEAR", "BEND"], num_args = 3, default_values_t = [5000.0, 500.0, 20.0])]
    stiffness: Vec<f32>,
    /// A preset in place of those springs and of 0.2 kg/m², as cotton_woven: its density, moduli and rigidity
    #[arg(long, value_parser = fabric)]
    fabric: Option<Fabric>,
    /// Bending rigidity of that fabric, N·m
    #[arg(long, requires = "fabric")]
    rigidity: Option<f32>,
    /// Damping of the velocity, 1/s
    #[arg(long, default_value_t = 1.0)]
    damping: f32,
    /// What of the cloth meets itself
    #[arg(long, value_enum, default_value = "off")]
    self_collision: SelfContact,
    /// Threads that a large grid is shared by; with more than one, time is the wall clock's instead of the thread's own
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=64))]
    threads: u32,
    /// Writes the positions as text, a particle a line: x y z in m
    #[arg(long, value_name = "FILE")]
    positions: Option<PathBuf>,
    /// Writes the positions of this moment instead of the last
    #[arg(long, requires = "positions", value_name = "SECONDS")]
    at_seconds: Option<f32>,
}

fn fabric(name: &str) -> Result<Fabric, String> {
    let known = Fabric::PRESETS.iter().map(|preset| preset.name).collect::<Vec<_>>().join(", ");
    let preset = Fabric::PRESETS.into_iter().find(|preset| preset.name == name);
    preset.map(|preset| preset.fabric).ok_or(format!("fabrics are {known}"))
}

/// Which coarse levels are used.
#[derive(Clone)]
enum Levels {
    Auto,
    Set(Vec<LevelPass>),
}

impl FromStr for Levels {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let pass = |level: &str| {
            let (stride, iterations) = level.split_once('x')?;
            Some(LevelPass { stride: stride.parse().ok()?, iterations: iterations.parse().ok()? })
        };
        match text {
            "auto" => Ok(Self::Auto),
            "none" => Ok(Self::Set(Vec::new())),
            list => {
                let passes: Option<Vec<LevelPass>> = list.split(',').map(pass).collect();
                passes.map(Self::Set).ok_or("levels are auto, none, or strides and iterations as in 8x8,4x4")
            }
        }
    }
}

impl Options {
    /// Substeps and levels for a mesh.
    fn effort(&self, topology: &Topology) -> Effort {
        let mut effort = match (self.solver, self.substeps) {
            (Solver::Strands, None) => Effort::to_hold(self.max_strain, topology),
            (Solver::Strands, Some(substeps)) => Effort::fixed(substeps, Effort::levels_for(substeps, topology)),
            (_, substeps) => Effort::fixed(substeps.unwrap_or(8), Vec::new()),
        };
        if let Levels::Set(levels) = &self.levels {
            effort.levels.clone_from(levels);
            effort.careful_levels.clone_from(levels);
        }
        effort
    }
}

#[derive(Clone, Copy, ValueEnum)]
enum PinnedPart {
    Corners,
    Top,
}

#[derive(Clone, Copy, ValueEnum)]
enum Solver {
    Strands,
    Xpbd,
    Explicit,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum SelfContact {
    Off,
    Particles,
    Robust,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Switch {
    On,
    Off,
}

fn main() -> ExitCode {
    match run(Cli::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// Prints a line for each measurement as soon as it is there.
fn run(Cli { sweep, experiment }: Cli) -> io::Result<()> {
    match experiment {
        _ if sweep => sweep::run(),
        Some(Experiment::Sizes { n }) => sizes::run(&n),
        Some(Experiment::Laboratory { report: Some(document), .. }) => report::write(&document),
        Some(Experiment::Laboratory { names, brief, report: None }) => {
            run_laboratory(&names, brief);
            Ok(())
        }
        Some(experiment) => experiment.measure().map(|line| println!("{line}")),
        None => Ok(()),
    }
}

fn laboratory_name() -> PossibleValuesParser {
    EXPERIMENTS.iter().map(|experiment| experiment.name).collect::<Vec<_>>().into()
}

/// Makes the experiments of these names, or all.
fn run_laboratory(names: &[String], brief: bool) {
    let extent = if brief { Extent::Brief } else { Extent::Full };
    let is_asked_for = |name: &str| names.is_empty() || names.iter().any(|other| other == name);
    for experiment in EXPERIMENTS.iter().filter(|experiment| is_asked_for(experiment.name)) {
        for measurement in (experiment.run)(extent).measurements {
            println!("{}", measurement.json());
        }
    }
}

/// Measures what `arguments` ask for on a command line of the lab.
fn measure(arguments: &str) -> io::Result<Value> {
    let words = ["lab"].into_iter().chain(arguments.split(' '));
    let experiment = Cli::try_parse_from(words).map_err(io::Error::other)?.experiment;
    experiment.ok_or_else(|| io::Error::other("there is nothing to measure"))?.measure()
}

impl Experiment {
    fn measure(&self) -> io::Result<Value> {
        match self {
            Self::Hang { options, mesh, pins, compare_oracle } => {
                if *compare_oracle && options.frames < oracle::FRAME {
                    let need = format!("--compare-oracle compares after {} frames; run as many or more", oracle::FRAME);
                    return Err(io::Error::other(need));
                }
                let scene = scene::hang(options, mesh, *pins)?;
                let oracle = compare_oracle.then(|| Oracle::run(&scene, &scene.context(options, None)));
                measure::run("hang", options, scene, oracle.as_ref())
            }
            Self::Drape { options, mesh } => measure::run("drape", options, scene::drape(options, mesh)?, None),
            Self::Threads { options } => threads::compare(options),
            Self::Shares { options } => shares::of_frame(options),
            Self::App { options } => app::one_cloth(options),
            Self::Build { options } => Ok(app::building(options)),
            Self::Many { cloths, frames, single_threaded } => Ok(app::many_flags(*cloths, *frames, *single_threaded)),
            Self::Sizes { .. } | Self::Laboratory { .. } => Err(io::Error::other("these are several measurements")),
        }
    }
}
