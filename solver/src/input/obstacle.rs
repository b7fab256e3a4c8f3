//! Obstacles, and how they move over one step.

use bevy_math::Isometry3d;

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
}

impl Obstacle {
    /// One that stays where it is, which no cloth moves.
    pub fn still(shape: impl Into<Shape>, pose: Isometry3d) -> Self {
        Self::moving(shape, pose, pose)
    }

    /// One that goes from `start` to `end`, which no cloth moves.
    pub fn moving(shape: impl Into<Shape>, start: Isometry3d, end: Isometry3d) -> Self {
        Self { shape: shape.into(), start, end, rounding: 0.0, friction: 1.0, body: None }
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
