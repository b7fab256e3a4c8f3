//! Hands that hold a cloth, and how they move over one step.

use std::sync::Arc;

use bevy_math::Vec3A;

/// A hand, and how it moves over one step.
#[derive(Clone, Debug, PartialEq)]
pub struct Grab {
    /// The triangle's particles.
    pub particles: [u32; 3],
    /// Barycentric weights of the point on it: 0 or more, 1 in sum.
    pub weights: [f32; 3],
    /// Where the target is when the step starts, m, relative to the cloth's origin.
    pub start: Vec3A,
    /// Where the target is when the step ends.
    pub end: Vec3A,
    /// Stiffness k of the spring, N/m.
    pub stiffness: f32,
    /// Damping c of the spring, N·s/m.
    pub damping: f32,
    /// The spring's largest force, N.
    pub max_force: f32,
    /// Mass of the hand, kg, which the point has in addition to its own.
    pub mass: f32,
    /// Tethers of the other particles to the point.
    pub tethers: Arc<[GrabTether]>,
}

/// The longest distance that a particle may have from a grabbed point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GrabTether {
    /// The particle.
    pub particle: u32,
    /// Distance between the two along the cloth at rest, m.
    pub length: f32,
}
