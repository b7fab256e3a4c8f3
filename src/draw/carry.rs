//! Cloth is drawn with what carries it.
//!
//! A step ends up to a step before the moment that is drawn, and drawing interpolates up to one more behind it, while
//! entities are drawn where they are: a cape would trail behind its wearer. So a cloth is drawn as it hung on what its pins
//! follow, wherever that is by now. Where pins follow several entities, each particle goes with them by its distances along
//! the cloth: those that are pinned are drawn at their pins.

use bevy::{
    math::{Affine3A, Vec3A},
    prelude::*,
};

use crate::{
    frame::is_invertible,
    solver::build::blend::BlendWeights,
    state::{ClothAttachments, PinAnchor},
};

/// What takes the particles of a cloth from a moment of its latest step to where they are drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Carry {
    /// For what none of the anchors carries.
    alone: Affine3A,
    /// For what is carried by each of them.
    anchors: Vec<Affine3A>,
}

impl Carry {
    /// Finds where particles that are relative to the cloth's origin, at the fraction `now` (0..=1) of the latest step, are
    /// relative to `place`. What carries the cloth is at `poses` by now; without `anchors`, nothing does.
    pub fn update(
        &mut self,
        origin: Vec3A,
        anchors: &[PinAnchor],
        now: f32,
        place: Vec3A,
        poses: &Query<&GlobalTransform>,
    ) {
        self.alone = Affine3A::from_translation((origin - place).into());
        self.anchors.clear();
        self.anchors.extend(anchors.iter().map(|anchor| {
            let pose = anchor.entity.and_then(|entity| poses.get(entity).ok()).map(GlobalTransform::affine);
            let pose = pose.filter(|_| anchor.pose().is_some());
            pose.and_then(|pose| anchor.carry(origin, now, pose, place)).unwrap_or(self.alone)
        }));
    }

    /// The weights of several anchors, where any of them has moved on.
    pub fn weights<'a>(&self, attachments: &'a ClothAttachments) -> Option<&'a BlendWeights> {
        attachments.blend_weights.as_ref().filter(|_| self.anchors.iter().any(|carry| *carry != self.alone))
    }

    /// What carries all particles, where there are no weights.
    pub fn whole(&self) -> Affine3A {
        match *self.anchors {
            [carry] => carry,
            _ => self.alone,
        }
    }

    /// Where a particle is drawn that follows the anchors by such weights.
    pub fn blend(&self, place: Vec3A, mut weights: impl Iterator<Item = (usize, f32)>) -> Vec3A {
        let carried = |(anchor, weight): (usize, f32)| self.anchors[anchor].transform_point3a(place) * weight;
        let Some(first) = weights.next() else { return self.alone.transform_point3a(place) };
        weights.map(carried).fold(carried(first), |sum, part| sum + part)
    }
}

impl PinAnchor {
    /// What takes points that are relative to `origin`, at the fraction `now` (0..=1) of the latest step, to the world
    /// relative to `place`, with the anchor at `pose`. None where it hasn't moved, or was flat.
    fn carry(&self, origin: Vec3A, now: f32, pose: Affine3A, place: Vec3A) -> Option<Affine3A> {
        let then = lerp(self.start, self.end, now);
        if pose == then || !is_invertible(&then) || !pose.is_finite() {
            return None;
        }
        let matrix3 = pose.matrix3 * then.matrix3.inverse();
        // Differences first: far from the world's origin, only they have precision left.
        let translation = matrix3 * (origin - then.translation) + (pose.translation - place);
        Some(Affine3A { matrix3, translation })
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
