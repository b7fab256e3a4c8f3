//! Obstacles, and how they move over one step.

use bevy_math::{Isometry3d, Vec3A};

use crate::{input::Body, shape::Shape};

/// Something that cloth can't enter, and how it moves over one step.
#[derive(Clone, Debug, PartialEq)]
pub struct Obstacle {
    /// Its shape.
    pub shape: Shape,
    /// Where it is when the step starts, m, relative to the cloth's origin.
    pub start: Isometry3d,
    /// Where it is when the step ends.
    pub end: Isometry3d,
    /// By how much it is larger than its shape all around, m.
    pub rounding: f32,
    /// Factor on the cloth's friction, no unit.
    pub friction: f32,
    /// What it takes to move it. None for what no cloth moves.
    pub body: Option<Body>,
    /// Whether only particles meet it: cloth sinks into what is thin between them, and takes no more substeps for that. For limbs, of
    /// which it is only about the shape. No by default.
    pub is_rough: bool,
}

impl Obstacle {
    /// One that stays where it is, which no cloth moves.
    pub fn still(shape: impl Into<Shape>, pose: Isometry3d) -> Self {
        Self::moving(shape, pose, pose)
    }

    /// One that goes from `start` to `end`, which no cloth moves.
    pub fn moving(shape: impl Into<Shape>, start: Isometry3d, end: Isometry3d) -> Self {
        Self { shape: shape.into(), start, end, rounding: 0.0, friction: 1.0, body: None, is_rough: false }
    }

    /// Moves it, and its way, by `by` (m).
    pub fn shift(&mut self, by: Vec3A) {
        self.start.translation += by;
        self.end.translation += by;
        if let Some(body) = &mut self.body {
            body.centre += by;
        }
    }

    /// Whether it stays where it is, and as it is, over the step.
    pub fn is_still(&self) -> bool {
        self.start == self.end && self.shape.is_still()
    }

    /// Whether it ends the step as another ended an earlier one: the same body of the same shape in the same place.
    pub fn ends_like(&self, earlier: &Self) -> bool {
        let Self { end, rounding, friction, body, .. } = self;
        let is_alike = (*end, *rounding, *friction) == (earlier.end, earlier.rounding, earlier.friction);
        is_alike && body.is_some() == earlier.body.is_some() && self.shape.ends_like(&earlier.shape)
    }

    /// Pose at the fraction `t` (0..=1) of the step.
    pub(crate) fn pose(&self, t: f32) -> Isometry3d {
        if self.start == self.end {
            return self.end;
        }
        Isometry3d::new(
            self.start.translation.lerp(self.end.translation, t),
            // Normalised linear interpolation: no transcendental function, and exact enough within a step.
            self.start.rotation.lerp(self.end.rotation, t),
        )
    }
}
