//! The rest shape of a running cloth follows the scale of its entity: squash and stretch, and whatever grows.

use std::sync::Arc;

use bevy::math::Mat3A;

use super::{ClothAttachments, ClothState};
use crate::{
    frame::{SCALE_ROUNDING, is_invertible},
    solver::{Topology, build::stretch::stretch},
};

/// The scale that a cloth was built at, and the one that it has.
#[derive(Clone, Debug, Default)]
pub(crate) struct RestScale {
    /// Rotation and scale that its topology was built for.
    built_for: Mat3A,
    /// What squares lengths of the topology in force, of ways along those as built. None before it has been looked at.
    metric: Option<Mat3A>,
    /// The topology as it was built, once the cloth has been scaled since.
    built: Option<Arc<Topology>>,
}

impl RestScale {
    /// Begins with a cloth whose topology was built for a rotation and scale.
    pub fn new(built_for: Mat3A) -> Self {
        Self { built_for, metric: Some(Mat3A::IDENTITY), built: None }
    }

    /// Has the scale looked at again.
    pub fn forget_metric(&mut self) {
        self.metric = None;
    }
}

impl ClothState {
    /// The springs as they were built, whatever the scale by now.
    pub(crate) fn built_topology(&self) -> &Arc<Topology> {
        self.rest_scale.built.as_ref().unwrap_or(&self.topology)
    }

    /// Gives springs and tethers the lengths that they have at the scale of the entity's present pose.
    pub(crate) fn follow_scale(&mut self, attachments: &mut ClothAttachments) {
        if !is_invertible(&self.pose) {
            return;
        }
        let change = self.pose.matrix3 * self.rest_scale.built_for.inverse();
        let metric = change.transpose() * change;
        let tolerance = SCALE_ROUNDING * metric.to_cols_array().into_iter().fold(0.0, f32::max);
        let is_known = |known: Mat3A| known.abs_diff_eq(metric, tolerance);
        if self.rest_scale.metric.is_some_and(is_known) || !metric.is_finite() {
            return;
        }
        self.rest_scale.metric = Some(metric);
        self.is_disturbed = true;
        let ClothAttachments { tethers, built_tethers, .. } = attachments;
        if Mat3A::IDENTITY.abs_diff_eq(metric, SCALE_ROUNDING) {
            if let Some(built) = self.rest_scale.built.take() {
                self.topology = built;
            }
            if let Some(built) = built_tethers.take() {
                *tethers = *built;
            }
            return;
        }
        let topology = &*self.rest_scale.built.get_or_insert_with(|| self.topology.clone());
        let built = &**built_tethers.get_or_insert_with(|| Box::new(tethers.clone()));
        stretch((Arc::make_mut(&mut self.topology), tethers), (topology, built), change);
    }
}
