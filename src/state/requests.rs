//! What a cloth has been asked for, and what has been said of it.

use bevy::{math::Affine3A, prelude::*};

/// What a game has asked of a cloth, which is done at the next occasion.
#[derive(Component, Clone, Copy, Debug, Default)]
#[component(clone_behavior = Ignore)]
pub(crate) struct Requests {
    /// Back to the rest shape.
    pub reset: bool,
    /// Carry the cloth along with its entity, as one rigid piece.
    pub teleport: bool,
    /// It has been reset, and was on an entity at this pose before: what has come along has jumped.
    pub reset_from: Option<Affine3A>,
}

/// Which warnings have been given, and needn't be given again.
#[derive(Component, Clone, Copy, Debug, Default)]
#[component(clone_behavior = Ignore)]
pub(crate) struct Warned {
    /// The explicit solver has too few substeps.
    pub softened: bool,
    /// The state became non-finite.
    pub not_finite: bool,
    /// A setting is out of its range.
    pub refused: bool,
    /// The margin is too large for the cloth.
    pub margin: bool,
    /// The mesh is too coarse for its fabric: by how many times its edges were too long when that was told, or 0.
    pub coarseness: f32,
    /// The mesh has a skin, and no skeleton.
    pub skin: bool,
    /// What is painted is no distance.
    pub paint: bool,
    /// Nothing holds it on its skeleton.
    pub falls_off: bool,
    /// A joint of its skeleton is gone.
    pub lost_joint: bool,
    /// The mesh has morph targets.
    pub morph_targets: bool,
}
