//! Why a mesh can't be cloth, and what to do about it.

use bevy::prelude::{Entity, Reflect};
use drape_solver::MeshError;
use thiserror::Error;

/// Why a cloth can't be built. The message names the cause and the mend.
#[derive(Clone, Debug, PartialEq, Reflect, Error)]
#[reflect(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum ClothError {
    /// The mesh's primitives are points or lines.
    #[error("the mesh has no triangles but a {topology}; use a triangle list or a triangle strip")]
    NotTriangles {
        /// The mesh's primitive topology.
        topology: String,
    },
    /// The position attribute is missing or isn't `Float32x3`.
    #[error("the mesh has no positions of three floats; insert `Mesh::ATTRIBUTE_POSITION` as `Float32x3`")]
    NoPositions,
    /// The mesh's data lives in the render world only.
    #[error(
        "the mesh is kept in the render world only; create or load it with `RenderAssetUsages::default()`, so that \
         the main world keeps it as well"
    )]
    NotInMainWorld,
    /// The mesh's file couldn't be loaded.
    #[error("the mesh couldn't be loaded ({reason}); check the asset path and the log of its loader")]
    NotLoaded {
        /// What the asset server says.
        reason: String,
    },
    /// The mesh's geometry can't be cloth.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The entity's scale, or one of its parents', makes the mesh flat or is not finite.
    #[error("the entity's transform can't be inverted; make every scale of it and its parents finite and not zero")]
    FlatTransform,
    /// The skeleton doesn't fit the mesh.
    #[error(
        "its skin follows {needed} joints, of which its SkinnedMesh has {found} with a Transform that can be inverted; give it the \
         skeleton that the mesh was made for, or remove SkinnedMesh"
    )]
    Skeleton {
        /// Number of joints that the skin follows.
        needed: usize,
        /// How many there are.
        found: usize,
    },
    /// A mesh of a garment is no part of its cloth.
    #[error("the mesh of {part} can't be joined with the others of the garment: {reason}")]
    Part {
        /// The entity of the mesh.
        part: Entity,
        /// What is wrong with it, and how to mend it.
        reason: String,
    },
    /// A pin names a vertex that the mesh doesn't have.
    #[error("a pin names vertex {vertex}, but the mesh has {count} vertices; pin vertices below that")]
    PinOutOfRange {
        /// The vertex that was asked for.
        vertex: u32,
        /// Number of vertices of the mesh.
        count: u32,
    },
    /// A pin selector needs a vertex attribute that the mesh lacks.
    #[error("pins are chosen by {attribute}, which the mesh lacks; add that attribute or choose pins otherwise")]
    PinsNeedAttribute {
        /// What is missing.
        attribute: String,
    },
    /// A pin selector chose no vertex.
    #[error("{selector} chooses no vertex of the mesh; choose pins otherwise, or use `Pins::none()` for a free cloth")]
    NothingPinned {
        /// The selector.
        selector: String,
    },
    /// A setting is out of its range.
    #[error("{name} is {value}, and it has to be {rule}; set it within that range")]
    InvalidParameter {
        /// Component and field.
        name: String,
        /// Its value.
        value: f32,
        /// The rule that it breaks.
        rule: String,
    },
}
