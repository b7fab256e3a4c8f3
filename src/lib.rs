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
mod grid;
mod state;

pub mod build;
mod pins;

mod anchor;
mod clock;
mod collider;
mod grab;
mod margin;
mod origin;
mod parallel;
mod pose;
mod rest_scale;
mod settings;
mod simulate;
mod teleport;
mod wind;

mod draw;

mod commands;
mod schedule;
mod shift;

#[cfg(feature = "avian")]
mod avian;
#[cfg(any(feature = "avian", feature = "rapier"))]
mod engine;
#[cfg(feature = "rapier")]
mod rapier;

#[cfg(feature = "debug")]
pub mod debug;
#[cfg(feature = "panel")]
pub mod panel;
#[cfg(feature = "picking")]
pub mod picking;

pub use collider::Obstacles;
pub use drape_solver as solver;
pub use error::ClothError;

/// What a game needs.
pub mod prelude {
    #[cfg(feature = "avian")]
    pub use crate::avian::{ClothAvianPlugin, ClothAvianSettings};
    #[cfg(feature = "mesh_colliders")]
    pub use crate::collider::mesh::HeightField;
    #[cfg(any(feature = "avian", feature = "rapier"))]
    pub use crate::engine::NotClothCollider;
    #[cfg(feature = "picking")]
    pub use crate::picking::{ClothPickingPlugin, ClothPickingSettings, PointerGrabs};
    #[cfg(feature = "rapier")]
    pub use crate::rapier::{ClothRapierPlugin, ClothRapierSettings};
    pub use crate::{
        build::source::ATTRIBUTE_WARP,
        cloth::{Cloth, ClothFailed, ClothGravity, ClothReady, ClothReset, ClothSolver, ClothStatus, ResetCause},
        collider::{ClothCollider, ColliderShape},
        commands::ClothCommands,
        error::ClothError,
        fabric::{ClothSprings, Fabric, FabricPreset, file::FabricFileError, handle::FabricHandle},
        grab::{ClothGrabbed, ClothGrip, ClothPoint, ClothReleased, GrabId},
        grid::ClothGrid,
        pins::{ATTRIBUTE_PIN, ClothEdge, PinGroup, PinPredicate, PinSelector, PinTarget, PinVertex, Pins},
        schedule::{ClothPlugin, ClothSystems},
        shift::WorldShiftCommands,
        solver::{Ellipsoid, LevelPass, MeshError, SelfCollision, Solid, TaperedCapsule},
        state::ClothState,
        teleport::ColliderTeleportThreshold,
        wind::{Wind, WindShape},
    };
}
