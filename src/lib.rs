//! Real-time cloth for the Bevy game engine, in real units.
//!
//! Add [`ClothPlugin`](prelude::ClothPlugin), put a [`Cloth`](prelude::Cloth) next to a `Mesh3d`, and that mesh hangs,
//! blows in the [`Wind`](prelude::Wind) and drapes over every [`ClothCollider`](prelude::ClothCollider).
//!
//! ```no_run
//! use bevy::prelude::*;
//! use bevy_drape::prelude::*;
//!
//! fn setup(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>) {
//!     commands.spawn((
//!         Mesh3d(meshes.add(ClothGrid::new(1.0, 1.0, 32, 32))),
//!         Cloth::default(),
//!         Fabric { density: 0.1, ..default() },
//!         Pins::edge_corners(ClothEdge::Top),
//!         Transform::from_xyz(0.0, 2.0, 0.0),
//!     ));
//!     commands.spawn(Wind { velocity: Vec3::Z * 4.0, ..default() });
//! }
//! ```
//!
//! How a mesh becomes what is drawn, and where to look for it:
//!
//! ```text
//! mesh -> build -> particles and topology
//!                           |
//!   settings, pins, hands, obstacles, winds -> [ forces -> levels -> tethers -> strands -> contact ] x substeps -> state
//!                                                                                                                  |
//!                                            renderer <- mesh <- normals, tangents <- interpolation <- draw <------+
//! ```
//!
//! All quantities are in SI units: m, kg, s, N. The solver is in [`solver`] and can be used without Bevy's ECS.

/// Compiles the code of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

mod cloth;
mod error;
mod fabric;
mod pins;
mod state;

pub mod build;
mod mesh_input;

mod attach;
mod frame;
mod simulate;
mod surroundings;

mod draw;

mod commands;
mod schedule;

#[cfg(any(feature = "avian", feature = "rapier"))]
mod engine;
#[cfg(any(feature = "debug", feature = "panel", feature = "picking"))]
mod tools;

pub use drape_solver as solver;
pub use error::ClothError;
pub use surroundings::collider::Obstacles;
#[cfg(feature = "debug")]
pub use tools::debug;
#[cfg(feature = "panel")]
pub use tools::panel;
#[cfg(feature = "picking")]
pub use tools::picking;

/// What a game needs.
pub mod prelude {
    #[cfg(any(feature = "avian", feature = "rapier"))]
    pub use crate::engine::NotClothCollider;
    #[cfg(feature = "avian")]
    pub use crate::engine::avian::{ClothAvianPlugin, ClothAvianSettings};
    #[cfg(feature = "rapier")]
    pub use crate::engine::rapier::{ClothRapierPlugin, ClothRapierSettings};
    #[cfg(feature = "mesh_colliders")]
    pub use crate::surroundings::collider::mesh::HeightField;
    #[cfg(feature = "picking")]
    pub use crate::tools::picking::{ClothPickingPlugin, ClothPickingSettings, PointerGrabs};
    pub use crate::{
        cloth::{Cloth, ClothSolver},
        commands::{ClothCommands, WorldShiftCommands},
        error::ClothError,
        fabric::{ClothSprings, Fabric, FabricPreset, file::FabricFileError, handle::FabricHandle},
        frame::ColliderTeleportThreshold,
        mesh_input::{ATTRIBUTE_WARP, ClothGrid},
        pins::{ATTRIBUTE_PIN, ClothEdge, PinGroup, PinPredicate, PinSelector, PinTarget, PinVertex, Pins},
        schedule::{ClothPlugin, ClothSystems},
        solver::{Ellipsoid, LevelPass, MeshError, SelfCollision, Solid, TaperedCapsule},
        state::{
            ClothAttachments, ClothFailed, ClothGrabbed, ClothGrabs, ClothGrip, ClothPoint, ClothReady, ClothReleased,
            ClothReport, ClothReset, ClothState, ClothStatus, GrabId, ResetCause,
        },
        surroundings::{
            ClothGravity,
            collider::{ClothCollider, ColliderShape},
            wind::{Wind, WindShape},
        },
    };
}
