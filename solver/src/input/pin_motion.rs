//! How pins move over one step.

use bevy_math::Vec3A;

/// How a fixed particle moves over one step, m, relative to the cloth's origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PinMotion {
    /// The particle that is held.
    pub particle: u32,
    /// Where it is when the step starts.
    pub start: Vec3A,
    /// Where it is when the step ends.
    pub end: Vec3A,
}
