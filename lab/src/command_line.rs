//! The lab's command line.

use std::{io, path::PathBuf, process::ExitCode};

use clap::{Parser, Subcommand, builder::PossibleValuesParser};
use serde_json::Value;

use crate::{
    app, chaos,
    character::Character,
    contact::Contact,
    hang,
    laboratory::{EXPERIMENTS, Extent},
    measure,
    mesh::MeshSource,
    options::{Options, PinnedPart},
    oracle::{self, Oracle},
    report, shares, sizes, sweep, threads,
};

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
    Many(app::Many),
    /// Clothes on animated characters: cost, strain
    Character(Character),
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
    /// Random scenes: counts what panics, isn't finite or is put back. A line for each seed that fails, and one for all
    Chaos(chaos::Options),
    #[command(flatten)]
    Contact(Contact),
}

/// Measures what the command line asks for.
pub fn main() -> ExitCode {
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
        _ if sweep => sweep::run(measure),
        Some(Experiment::Sizes { n }) => sizes::run(&n, measure),
        Some(Experiment::Laboratory { report: Some(document), .. }) => report::write(&document),
        Some(Experiment::Laboratory { names, brief, report: None }) => {
            run_laboratory(&names, brief);
            Ok(())
        }
        Some(Experiment::Chaos(options)) => run_chaos(&options),
        Some(experiment) => experiment.measure().map(|line| println!("{line}")),
        None => Ok(()),
    }
}

/// Runs random scenes. An error where something happened that never may.
fn run_chaos(options: &chaos::Options) -> io::Result<()> {
    let tally = chaos::run(options, |outcome| println!("{}", outcome.json()));
    println!("{}", tally.json());
    if tally.has_failed() { Err(io::Error::other("seeds have failed: run one alone with --verbose")) } else { Ok(()) }
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
                let scene = hang::hang(options, mesh, *pins)?;
                let oracle = compare_oracle.then(|| Oracle::run(&scene));
                measure::run("hang", options, mesh, scene, oracle.as_ref())
            }
            Self::Contact(contact) => contact.measure(),
            Self::Threads { options } => threads::compare(options),
            Self::Shares { options } => shares::of_frame(options),
            Self::App { options } => app::one_cloth(options),
            Self::Build { options } => Ok(app::building(options)),
            Self::Many(many) => Ok(many.measure()),
            Self::Character(character) => character.measure(),
            Self::Sizes { .. } | Self::Laboratory { .. } | Self::Chaos(_) => {
                Err(io::Error::other("these are several measurements"))
            }
        }
    }
}
