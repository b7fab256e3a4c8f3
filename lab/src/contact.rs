//! Experiments on what touches: the command line of the scenes.

use std::io;

use clap::{Subcommand, ValueEnum};
use serde_json::Value;

use super::{
    hang, measure,
    mesh::MeshSource,
    options::Options,
    scene::{bullet, drape, fold, layers, needle, ribbon, storm, twist},
};

#[derive(Subcommand)]
pub enum Contact {
    /// The same cloth falls on a sphere, or a table, over a ground
    Drape {
        #[command(flatten)]
        options: Options,
        /// grid, delaunay, hex, skirt, ell, sleeve, or a FILE.glb, which is scaled to 1 m
        #[arg(long, default_value = "grid")]
        mesh: MeshSource,
        /// A ball of 0.3 m radius, or a table of 0.5 m x 0.5 m
        #[arg(long, value_enum, default_value = "ball")]
        on: Below,
        /// More spheres around, which are too far away for the cloth to reach
        #[arg(long, default_value_t = 0)]
        others: u32,
    },
    /// The same, where the sphere is a mesh of 20,480 triangles
    Mesh {
        #[command(flatten)]
        options: Options,
        /// Takes the triangles for a thin shell, instead of what encloses a volume
        #[arg(long)]
        open: bool,
    },
    /// A square metre stands on its edge in waves and falls in folds
    Fold {
        #[command(flatten)]
        options: Options,
    },
    /// A ribbon of 5 cm x 2 m falls end first into a pile
    Ribbon {
        #[command(flatten)]
        options: Options,
    },
    /// A strip of 20 cm x 1 m is turned three times at its ends, and back
    Twist {
        #[command(flatten)]
        options: Options,
    },
    /// Three square metres fall on each other, on a sphere over a ground
    Layers {
        #[command(flatten)]
        options: Options,
    },
    /// A flag of a square metre in gusts of 15 to 25 m/s from all sides, until it gets calm
    Storm {
        #[command(flatten)]
        options: Options,
    },
    /// A square metre falls on something sharp
    Needle {
        #[command(flatten)]
        options: Options,
        /// grid, delaunay or hex
        #[arg(long, default_value = "grid")]
        mesh: MeshSource,
        /// A capsule of 2 mm radius, the corner of a box, or the tip of a cone
        #[arg(long, value_enum, default_value = "needle")]
        on: Sharp,
    },
    /// An impact at 30 m/s
    Bullet {
        #[command(flatten)]
        options: Options,
        /// grid, delaunay or hex: of what a ball hits
        #[arg(long, default_value = "grid")]
        mesh: MeshSource,
        /// A ball of 20 or 5 mm radius hits a square metre that is held all around, or one that flies hits a wall of 4 mm or
        /// a ball of 10 cm radius
        #[arg(long, value_enum, default_value = "ball")]
        of: Impact,
    },
}

#[derive(Clone, Copy, ValueEnum)]
pub enum Below {
    Ball,
    Table,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum Sharp {
    Needle,
    Corner,
    Cone,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum Impact {
    Ball,
    Pellet,
    Wall,
    Post,
}

impl Contact {
    pub fn measure(&self) -> io::Result<Value> {
        let grid = &MeshSource::Grid;
        let (name, options, mesh, scene) = match self {
            Self::Drape { options, mesh, on, others } => {
                let settings = options.settings(false)?;
                let (cloth, _) = hang::free(options, &settings, mesh)?;
                let (name, scene) = match on {
                    Below::Ball => ("drape", drape::on_ball(&settings, [drape::raised(cloth)])),
                    Below::Table => ("drape: table", drape::on_table(&settings, drape::raised(cloth))),
                };
                (name, options, mesh, drape::among(scene, *others))
            }
            Self::Mesh { options, open } => {
                let settings = options.settings(false)?;
                let (cloth, _) = hang::free(options, &settings, grid)?;
                ("mesh", options, grid, drape::on_mesh(&settings, drape::raised(cloth), !open)?)
            }
            Self::Fold { options } => ("fold", options, grid, fold::fold(&options.settings(true)?)?),
            Self::Ribbon { options } => ("ribbon", options, grid, ribbon::ribbon(&options.settings(true)?)?),
            Self::Twist { options } => ("twist", options, grid, twist::twist(&options.settings(true)?)?),
            Self::Layers { options } => ("layers", options, grid, layers::layers(&options.settings(true)?)?),
            Self::Storm { options } => ("storm", options, grid, storm::storm(&options.settings(true)?)?),
            Self::Needle { options, mesh, on } => {
                let settings = options.settings(false)?;
                let (cloth, _) = hang::free(options, &settings, mesh)?;
                let (name, sharp) = match on {
                    Sharp::Needle => ("needle", needle::Sharp::Needle),
                    Sharp::Corner => ("needle: corner", needle::Sharp::Corner),
                    Sharp::Cone => ("needle: cone", needle::Sharp::Cone),
                };
                (name, options, mesh, needle::below(&settings, cloth, sharp))
            }
            Self::Bullet { options, mesh, of } => {
                let settings = options.settings(false)?;
                let (cloth, _) = hang::free(options, &settings, mesh)?;
                let (name, scene) = match of {
                    Impact::Ball => ("bullet: ball", bullet::ball_against(&settings, cloth, 0.02)),
                    Impact::Pellet => ("bullet: pellet", bullet::ball_against(&settings, cloth, 0.005)),
                    Impact::Wall => ("bullet: wall", bullet::wall(&settings)?),
                    Impact::Post => ("bullet: post", bullet::post(&settings, 0.1)?),
                };
                let mesh = if matches!(of, Impact::Ball | Impact::Pellet) { mesh } else { grid };
                (name, options, mesh, scene)
            }
        };
        measure::run(name, options, mesh, scene, None)
    }
}
