//! The rest shape of a running cloth follows the scale of its entity: squash and stretch, and whatever grows.

use std::sync::Arc;

use bevy::math::Mat3A;

use crate::{
    pose::is_invertible,
    solver::{Tethers, Topology, build::stretch::stretch},
    state::ClothState,
};

/// A change of scale by less than this share is rounding: a transform that turns comes out a little different in each step.
const ROUNDING: f32 = 1e-5;

/// The scale that a cloth was built at, and the one that it has.
#[derive(Clone, Debug, Default)]
pub(crate) struct RestScale {
    /// Rotation and scale that its topology was built for.
    built_for: Mat3A,
    /// What squares lengths of the topology in force, of ways along those as built. None before it has been looked at.
    metric: Option<Mat3A>,
    /// The cloth as it was built, once it has been scaled since.
    built: Option<Box<(Arc<Topology>, Tethers)>>,
}

impl RestScale {
    /// That of a cloth whose topology was built for a rotation and scale.
    pub fn new(built_for: Mat3A) -> Self {
        Self { built_for, metric: Some(Mat3A::IDENTITY), built: None }
    }
}

impl ClothState {
    /// The springs as they were built, whatever the scale by now.
    pub(crate) fn built_topology(&self) -> &Arc<Topology> {
        self.rest_scale.built.as_ref().map_or(&self.topology, |built| &built.0)
    }

    /// Takes tethers of the cloth as it was built.
    pub(crate) fn set_tethers(&mut self, tethers: Tethers) {
        if let Some(built) = &mut self.rest_scale.built {
            built.1.clone_from(&tethers);
            // They are as long as they are to be once the scale has been looked at.
            self.rest_scale.metric = None;
        }
        self.tethers = tethers;
    }

    /// Drops the tethers to all pins but some.
    pub(crate) fn keep_tethers(&mut self, is_kept: impl Fn(u32) -> bool) {
        if let Some(built) = &mut self.rest_scale.built {
            built.1.keep(&is_kept);
        }
        self.tethers.keep(is_kept);
    }

    /// Gives springs and tethers the lengths that they have at the scale of the entity's present pose.
    pub(crate) fn follow_scale(&mut self) {
        if !is_invertible(&self.pose) {
            return;
        }
        let change = self.pose.matrix3 * self.rest_scale.built_for.inverse();
        let metric = change.transpose() * change;
        let tolerance = ROUNDING * metric.to_cols_array().into_iter().fold(0.0, f32::max);
        let is_known = |known: Mat3A| known.abs_diff_eq(metric, tolerance);
        if self.rest_scale.metric.is_some_and(is_known) || !metric.is_finite() {
            return;
        }
        self.rest_scale.metric = Some(metric);
        if Mat3A::IDENTITY.abs_diff_eq(metric, ROUNDING) {
            if let Some(built) = self.rest_scale.built.take() {
                (self.topology, self.tethers) = *built;
            }
            return;
        }
        let as_built = || Box::new((self.topology.clone(), self.tethers.clone()));
        let (topology, tethers) = &**self.rest_scale.built.get_or_insert_with(as_built);
        stretch((Arc::make_mut(&mut self.topology), &mut self.tethers), (topology, tethers), change);
    }
}
