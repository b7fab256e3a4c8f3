//! Why a body has no capsules, and what to do about it.

use bevy::prelude::Entity;
use thiserror::Error;

use crate::error::ClothError;

/// Why a body has no capsules, or too few. The message names the cause and the mend.
#[derive(Clone, Debug, PartialEq, Error)]
pub(super) enum BodyError {
    /// A setting is out of its range.
    #[error("{0}")]
    Settings(ClothError),
    /// There is nothing to make it of.
    #[error(
        "there is no skinned mesh on its entity or below, besides cloth and what is excepted, and it waits for one; insert ClothBody \
         on the root of a character whose body has Mesh3d and SkinnedMesh, or make obstacles by ClothCollider"
    )]
    NoSkin,
    /// A mesh has a skeleton, and doesn't say how it follows that.
    #[error(
        "no mesh of it has joints and weights for each vertex; give it `Mesh::ATTRIBUTE_JOINT_INDEX` and \
         `Mesh::ATTRIBUTE_JOINT_WEIGHT`, as skinned models have them"
    )]
    NoWeights,
    /// A mesh can't be read.
    #[error("mesh {mesh} can't be used: {error}")]
    Mesh {
        /// Its entity.
        mesh: Entity,
        error: ClothError,
    },
    /// Inverse bind poses won't come.
    #[error(
        "the inverse bind poses of mesh {mesh} couldn't be loaded ({reason}); check its file and the log of its loader"
    )]
    BindPoses {
        /// Its entity.
        mesh: Entity,
        /// What the asset server says.
        reason: String,
    },
    /// Joints are missing.
    #[error(
        "of {needed} joints that mesh {mesh} follows, {missing} are missing and have no capsule; give it the skeleton that it was \
         made for, and insert ClothBody once that is there"
    )]
    Skeleton {
        /// Its entity.
        mesh: Entity,
        needed: usize,
        missing: usize,
    },
    /// Nothing is large enough.
    #[error(
        "no joint of it has enough skin for a capsule; lower ClothBody::smallest, take names out of ClothBody::except, or make \
         obstacles by ClothCollider"
    )]
    NoCapsules,
}
