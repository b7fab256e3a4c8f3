//! Where a skeleton has put the points of a collider, from step to step.

use std::sync::Arc;

use bevy::math::{Affine3A, Vec3A};

use crate::{mesh_input::Skin, solver::DeformedPoints, surroundings::collider::error::ColliderError};

/// The points of the latest steps, the latest first.
///
/// The coming step is from the first to new ones, and cloths still hold the first two from the latest step: so there is a
/// third to write the new ones to.
#[derive(Clone, Debug, Default)]
pub(super) struct Posed([Option<Arc<[Vec3A]>>; 3]);

impl Posed {
    /// Whether there has been a step.
    pub fn is_any(&self) -> bool {
        self.0[0].is_some()
    }

    /// The points at the start and the end of the coming step, with what the joints do at its end. A collider that
    /// `is_new` has been there all the time.
    pub fn follow(&mut self, skin: &Skin, joints: &[Affine3A], is_new: bool) -> Result<DeformedPoints, ColliderError> {
        let fits = |points: &Arc<[Vec3A]>| points.len() == skin.len();
        let [latest, before, oldest] = core::mem::take(&mut self.0);
        let mut end = oldest.filter(fits).unwrap_or_default();
        match Arc::get_mut(&mut end) {
            Some(points) if points.len() == skin.len() => skin.pose(joints, points),
            _ => {
                let mut points = vec![Vec3A::ZERO; skin.len()];
                skin.pose(joints, &mut points);
                end = points.into();
            }
        }
        if !end.iter().all(|point| point.is_finite()) {
            return Err(ColliderError::NoSize);
        }
        let start = latest.as_ref().filter(|points| fits(points) && !is_new).unwrap_or(&end).clone();
        self.0 = [Some(end.clone()), latest, before];
        Ok(DeformedPoints::new([start, end]))
    }
}
