//! World poses of entities within a step, and whether they have got there by a jump.

use bevy::{ecs::system::SystemParam, math::Affine3A, prelude::*, transform::helper::ComputeGlobalTransformError};

use super::{Pass, StepNumber, Steps, Teleported};

/// World poses of entities, up to date within a frame.
#[derive(SystemParam)]
pub(crate) struct Poses<'w, 's> {
    transforms: TransformHelper<'w, 's>,
    steps: Res<'w, Steps>,
    teleported: Res<'w, Teleported>,
}

impl Poses<'_, '_> {
    /// World transform of an entity.
    ///
    /// # Errors
    ///
    /// Where the entity or one of its parents is gone, disabled or without a `Transform`.
    pub fn compute_global_transform(&self, entity: Entity) -> Result<GlobalTransform, ComputeGlobalTransformError> {
        self.transforms.compute_global_transform(entity)
    }

    /// The present step.
    pub fn step(&self) -> StepNumber {
        self.steps.present()
    }

    /// The pass that it is of.
    pub fn pass(&self) -> Pass {
        self.steps.pass()
    }

    /// Whether an entity has been teleported since the latest step of this pass.
    pub fn is_teleported(&self, entity: Entity) -> bool {
        self.teleported.contains(entity, self.step())
    }
}

/// Changes of scale by less than this share are rounding: a transform that turns comes out a little different in each step.
pub(crate) const SCALE_ROUNDING: f32 = 1e-5;

/// Whether a transform keeps volume: all of its scales are finite and not zero.
pub(crate) fn is_invertible(pose: &Affine3A) -> bool {
    pose.is_finite() && pose.matrix3.determinant().is_normal() && pose.inverse().is_finite()
}
