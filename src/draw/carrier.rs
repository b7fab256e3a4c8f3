//! Cloth is drawn with the entity that carries it.
//!
//! A step ends up to a step before the moment that is drawn, and drawing interpolates up to one more behind it, while
//! entities are drawn where they are: a cape would trail behind its wearer. So a cloth whose pins all follow one entity
//! is drawn as it hung on that entity, wherever the entity is by now.

use bevy::{
    math::{Affine3A, Vec3A},
    prelude::*,
};

use crate::anchor::is_invertible;

/// The entity that all pins of a cloth follow, and its way over the latest step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Carrier {
    /// The entity.
    pub entity: Entity,
    /// Its pose when the step began.
    pub start: Affine3A,
    /// Its pose when the step ended.
    pub end: Affine3A,
}

impl Carrier {
    /// What takes points that are relative to `origin`, at the fraction `now` (0..=1) of the latest step, to the world
    /// relative to `place`, with the carrier at `pose`.
    pub fn carry(&self, origin: Vec3A, now: f32, pose: Affine3A, place: Vec3A) -> Affine3A {
        let then = lerp(self.start, self.end, now);
        if pose == then || !is_invertible(&then) || !pose.is_finite() {
            return Affine3A::from_translation((origin - place).into());
        }
        let matrix3 = pose.matrix3 * then.matrix3.inverse();
        // Differences first: far from the world's origin, only they have precision left.
        let translation = matrix3 * (origin - then.translation) + (pose.translation - place);
        Affine3A { matrix3, translation }
    }
}

/// As pins interpolate: each of their places goes straight from start to end.
fn lerp(start: Affine3A, end: Affine3A, t: f32) -> Affine3A {
    if start == end {
        return end;
    }
    Affine3A {
        matrix3: start.matrix3 * (1.0 - t) + end.matrix3 * t,
        translation: start.translation.lerp(end.translation, t),
    }
}
