//! Why a collider is left out, and what to do about it.

use thiserror::Error;

#[cfg(feature = "mesh_colliders")]
use crate::{error::ClothError, solver::MeshError};

/// Why a collider is left out. The message names the cause, where that isn't plain, and the mend.
#[derive(Clone, Debug, PartialEq, Error)]
pub(crate) enum ColliderError {
    /// It has no size, or something of it isn't finite.
    #[error("give its shape, friction and transform finite values, and its shape a size greater than zero")]
    NoSize,
    /// The mesh can't be read, or isn't there.
    #[cfg(feature = "mesh_colliders")]
    #[error(transparent)]
    Mesh(#[from] ClothError),
    /// It is to be made from its entity's mesh, and there is none.
    #[cfg(feature = "mesh_colliders")]
    #[error(
        "it has no Mesh3d and waits for one; insert ClothCollider next to the Mesh3d, in a loaded scene on the entity \
         that carries it, or name a mesh with ClothCollider::mesh_of"
    )]
    NoMesh,
    /// Its mesh belongs to a cloth.
    #[cfg(feature = "mesh_colliders")]
    #[error(
        "its mesh is a cloth's and never stays the same; let the cloth collide by its own settings, or name another mesh \
         with ClothCollider::mesh_of"
    )]
    IsCloth,
    /// Its points enclose nothing.
    #[cfg(feature = "mesh_colliders")]
    #[error("all of its points lie in one plane, so that it has no convex hull; use ClothCollider::mesh")]
    Flat,
    /// No hull was found.
    #[cfg(feature = "mesh_colliders")]
    #[error("no convex hull was found around its points ({reason}); use ClothCollider::mesh")]
    NoHull {
        /// What the search says.
        reason: String,
    },
    /// The heights are no grid.
    #[cfg(feature = "mesh_colliders")]
    #[error(
        "its height field has {heights} heights in {columns} columns; give it at least 2 columns and 2 rows, and as many \
         heights as fill them"
    )]
    NoGrid {
        /// Number of heights.
        heights: usize,
        /// Number of columns.
        columns: u32,
    },
    /// The skeleton doesn't fit the mesh.
    #[cfg(feature = "mesh_colliders")]
    #[error(
        "its skin follows {needed} joints, of which its SkinnedMesh has {found} with a Transform; give it the skeleton \
         that the mesh was made for, or remove SkinnedMesh"
    )]
    Skeleton {
        /// Number of joints that the skin follows.
        needed: usize,
        /// How many of them were found before one was missing.
        found: usize,
    },
}

#[cfg(feature = "mesh_colliders")]
impl From<MeshError> for ColliderError {
    fn from(error: MeshError) -> Self {
        Self::Mesh(error.into())
    }
}
