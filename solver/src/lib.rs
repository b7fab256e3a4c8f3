//! Simulates cloth on plain data: what `bevy_drape` does without entities, assets and windows.
//!
//! [`build()`] makes a [`Topology`] of a triangle mesh, [`Particles`] are its state, and [`step()`] advances it by some
//! seconds; [`step_together`] does so with cloths that may touch each other. All quantities are in SI units and relative to
//! one origin per cloth, so `f32` keeps its precision however far the cloth is from the world's origin.
//!
//! `docs/architecture.md` in the repository has the modules in the order in which a step uses them.

/// Compiles the code of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

pub mod build;
pub mod constraint;
pub mod contact;
pub mod embedding;
pub mod explicit;
pub mod force;
pub mod geometry;
pub(crate) mod imperfection;
pub mod input;
pub(crate) mod integrate;
pub mod layout;
pub mod linear;
pub mod material;
pub mod measure;
pub(crate) mod noise;
pub(crate) mod parallel;
pub mod particles;
pub mod scratch;
pub mod shape;
pub(crate) mod step;
pub mod topology;

pub use crate::{
    build::{MeshError, SourceMesh, Welded, build, grab_tethers, tethers},
    contact::StepReach,
    input::{
        AttachedPin, Backstop, Body, BodyAttachment, BodyDisplacement, BodyImpulse, CollisionFilter, Grab, GrabTether,
        Gusts, MAX_TIME_STEP, Method, Obstacle, PinMotion, Skin, SkinLimit, SkinLimits, SkinPose, StepContext,
        StepSettings, SubstepPolicy, Tether, Tethers, WindRegion, WindSource,
    },
    layout::simd::SimdLevel,
    material::{Elasticity, Material, Moduli, SpringConstants, SpringLaw},
    measure::{Energy, Strain},
    particles::{
        Particles,
        contact_load::{ContactLoad, FeatureLoad},
    },
    scratch::Scratch,
    shape::{DeformedPoints, Ellipsoid, MeshShape, Shape, Solid, TaperedCapsule, TriangleMesh},
    step::{
        Member,
        report::{StepReport, SubstepReason},
        step, step_together,
    },
    topology::{
        Bend, BendBatch, Face, Grain, Spring, SpringBatch, SpringKind, Topology,
        lattice::{Lattice, StrandSet},
        level::{Level, LevelPass, LinearWeights, Prolongation, TransferOperator},
        strand_pack::StrandPack,
        structure::MeshStructure,
    },
};
