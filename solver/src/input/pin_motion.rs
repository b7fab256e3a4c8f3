//! Pins on their way over one step.

use bevy_math::Vec3A;

/// The way of a fixed particle over one step, m, relative to the cloth's origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PinMotion {
    /// The particle that is held.
    pub particle: u32,
    /// Where it is when the step starts.
    pub start: Vec3A,
    /// Where it is when the step ends.
    pub end: Vec3A,
}
