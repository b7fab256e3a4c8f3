//! Experiments whose answers are on paper, as a textile laboratory would make them: what goes in as a fabric's constants has
//! to come out of the simulated measurement.
//!
//! What is expected comes from formulas and from small numeric solutions of their own, never from the solver. Where an
//! experiment needs rest, the velocities are damped, which moves no place of rest, until the fastest particle is slow.

use bevy_drape::solver::Method;

mod bed;
mod cantilever;
mod catenary;
mod cusick;
mod elastica;
mod energy;
mod fall;
mod literature;
pub mod mesh;
mod pendulum;
mod pull;
mod rates;
mod record;
mod roots;
pub mod shadow;
mod shear;
mod slope;
mod terminal_speed;

pub use record::{Curve, Measurement, Outcome};

/// How much of an experiment is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// A few small cases, in seconds.
    Brief,
    /// All.
    Full,
}

/// Ways to integrate, and substeps where the method doesn't find them. What is held by springs that are solved one after the
/// other is softer than its springs where substeps are few: the more of them, the less.
const EFFORTS: [(Method, Option<u32>); 6] = [
    (Method::Strands, Some(8)),
    (Method::Strands, Some(32)),
    (Method::Strands, Some(128)),
    (Method::Xpbd, Some(8)),
    (Method::Xpbd, Some(128)),
    (Method::Explicit, None),
];

/// Those of the tests.
const BRIEF: [(Method, Option<u32>); 2] = [(Method::Strands, Some(8)), (Method::Explicit, None)];

/// The same on triangles, which are solved one after the other.
const BRIEF_OF_TRIANGLES: [(Method, Option<u32>); 2] = [(Method::Strands, Some(128)), (Method::Explicit, None)];

/// A kind of measurement.
pub struct Experiment {
    /// Its name on the command line and in the lines.
    pub name: &'static str,
    /// Makes it.
    pub run: fn(Extent) -> Outcome,
}

/// All experiments, in the order of the document.
pub const EXPERIMENTS: [Experiment; 12] = [
    Experiment { name: "free-fall", run: fall::run },
    Experiment { name: "pendulum", run: pendulum::run },
    Experiment { name: "energy", run: energy::run },
    Experiment { name: "pull", run: pull::run },
    Experiment { name: "shear", run: shear::run },
    Experiment { name: "catenary", run: catenary::run },
    Experiment { name: "cantilever", run: cantilever::run },
    Experiment { name: "cusick", run: cusick::run },
    Experiment { name: "terminal-speed", run: terminal_speed::run },
    Experiment { name: "slope", run: slope::run },
    Experiment { name: "frame-rates", run: rates::of_frames },
    Experiment { name: "step-rates", run: rates::of_steps },
];
