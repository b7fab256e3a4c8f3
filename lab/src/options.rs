//! Options that all experiments have.

use std::{io, path::PathBuf, str::FromStr};

use bevy_drape::{
    prelude::{ClothError, Fabric},
    solver::{Elasticity, LevelPass, Material, Method, SpringConstants, SpringKind},
};
use clap::{Args, ValueEnum};

use super::scene::{DENSITY, STIFFNESS, Settings};

#[derive(Args, Clone)]
pub struct Options {
    /// Particles along each side, n; n² or about as many on other meshes than the grid, and without effect on a file
    #[arg(long, default_value_t = 64, value_parser = clap::value_parser!(u32).range(2..=1024))]
    pub n: u32,
    /// Moves the vertices inside a grid, delaunay, hex or ell at random by up to so much of a cell
    #[arg(long, default_value_t = 0.0)]
    pub jitter: f32,
    /// Substeps a frame; by default as many as the strain needs (strands) or 8 (xpbd). The explicit solver finds its own
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..))]
    pub substeps: Option<u32>,
    /// The largest strain that is wanted: strands choose their substeps by it
    #[arg(long, default_value_t = 0.01)]
    pub max_strain: f32,
    /// Frames of 1/60 s
    #[arg(long, default_value_t = 300, value_parser = clap::value_parser!(u32).range(1..))]
    pub frames: u32,
    /// How the springs are integrated
    #[arg(long, value_enum, default_value = "strands")]
    pub solver: Solver,
    /// Coarse levels of strands: auto, none, or STRIDExITERATIONS,.. as in 8x8,4x4
    #[arg(long, default_value = "auto")]
    pub levels: Levels,
    /// Whether particles are tethered to the pins (xpbd only)
    #[arg(long, value_enum, default_value = "on")]
    pub tethers: Switch,
    /// By how much of its length a tether gives
    #[arg(long, default_value_t = 0.002)]
    pub tether_slack: f32,
    /// Stiffness of springs along the threads, of those along diagonals, and of those that bend, N/m; 0 leaves them out
    #[arg(long, value_names = ["STRUCTURAL", "SHEAR", "BEND"], num_args = 3, default_values_t = STIFFNESS)]
    pub stiffness: Vec<f32>,
    /// A preset in place of those springs and of 0.2 kg/m², as cotton_woven: its density, moduli and rigidity
    #[arg(long, value_parser = fabric)]
    pub fabric: Option<Fabric>,
    /// Bending rigidity of that fabric, N·m
    #[arg(long, requires = "fabric")]
    pub rigidity: Option<f32>,
    /// Damping of the velocity, 1/s
    #[arg(long, default_value_t = 1.0)]
    pub damping: f32,
    /// Thickness, m
    #[arg(long, default_value_t = 0.0)]
    pub thickness: f32,
    /// Whether the cloth meets itself; where nothing is said, what the experiment is about
    #[arg(long, value_enum)]
    pub self_collision: Option<Switch>,
    /// Distance that parts of cloth keep from each other, m
    #[arg(long, default_value_t = 0.004)]
    pub self_distance: f32,
    /// Distance that the cloth keeps from obstacles beside its thickness, m; a `Cloth` keeps 0.005
    #[arg(long, default_value_t = 0.0)]
    pub margin: f32,
    /// Threads that a large grid is shared by; with more than one, time is the wall clock's instead of the thread's own
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=64))]
    pub threads: u32,
    /// Writes the positions as text, a particle a line: x y z in m
    #[arg(long, value_name = "FILE")]
    pub positions: Option<PathBuf>,
    /// Writes the positions of this moment instead of the last
    #[arg(long, requires = "positions", value_name = "SECONDS")]
    pub at_seconds: Option<f32>,
}

fn fabric(name: &str) -> Result<Fabric, String> {
    let known = Fabric::PRESETS.iter().map(|preset| preset.name).collect::<Vec<_>>().join(", ");
    let preset = Fabric::PRESETS.into_iter().find(|preset| preset.name == name);
    preset.map(|preset| preset.fabric).ok_or(format!("fabrics are {known}"))
}

/// Which coarse levels are used.
#[derive(Clone)]
pub enum Levels {
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
    /// What they say of a scene, of which `self_collision` is what it is about.
    pub fn settings(&self, self_collision: bool) -> io::Result<Settings> {
        let self_collision = self.self_collision.map_or(self_collision, |switch| switch == Switch::On);
        Ok(Settings {
            method: match self.solver {
                Solver::Strands => Method::Strands,
                Solver::Xpbd => Method::Xpbd,
                Solver::Explicit => Method::Explicit,
            },
            substeps: self.substeps,
            max_strain: self.max_strain,
            levels: match &self.levels {
                Levels::Auto => None,
                Levels::Set(levels) => Some(levels.clone()),
            },
            material: Material {
                damping: self.damping,
                friction: 0.5,
                thickness: self.thickness,
                ..self.material().map_err(io::Error::other)?
            },
            tether_slack: self.tether_slack,
            self_distance: self.self_distance,
            margin: self.margin,
            ..Settings::standard(self.n, self.frames, self_collision)
        })
    }

    /// The sheet or the springs that are asked for, without air.
    fn material(&self) -> Result<Material, ClothError> {
        if let Some(fabric) = &self.fabric {
            let bending_rigidity = self.rigidity.unwrap_or(fabric.bending_rigidity);
            let Material { density, elasticity, .. } = Fabric { bending_rigidity, ..fabric.clone() }.material()?;
            return Ok(Material::bare(density, elasticity));
        }
        let spring = |kind: SpringKind| SpringConstants { stiffness: self.stiffness[kind.index()], damping: 0.0 };
        Ok(Material::bare(DENSITY, Elasticity::Springs(SpringKind::ALL.map(spring))))
    }
}

#[derive(Clone, Copy, ValueEnum)]
pub enum PinnedPart {
    Corners,
    Top,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum Solver {
    Strands,
    Xpbd,
    Explicit,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
pub enum Switch {
    On,
    Off,
}
