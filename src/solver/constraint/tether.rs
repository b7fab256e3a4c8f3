//! Tethers: a particle may not be farther from a pin than the cloth between them is long.
//!
//! ```text
//!   pin o~~~~~~~~~~~~~~~~ particle       |x - pin| <= length (1 + slack)
//! ```
//!
//! Kim, Chentanez and Müller-Fischer, "Long Range Attachments" (2012). One-sided: a slack tether does nothing.

use bevy::math::Vec3A;

use crate::solver::Particles;

/// The longest distance that a particle may have from a fixed one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tether {
    /// The free particle.
    pub particle: u32,
    /// The fixed particle that holds it.
    pub pin: u32,
    /// Distance between the two along the cloth at rest, m.
    pub length: f32,
}

/// Pulls every particle that is too far out back to the end of its tether.
pub fn solve(particles: &mut Particles, tethers: &[Tether], slack: f32) {
    for &Tether { particle, pin, length } in tethers {
        let pin = particles.position[pin as usize];
        pull_back(particles, particle as usize, pin, length * (1.0 + slack));
    }
}

/// Moves a free particle that is farther than `reach` from `hold` straight back to that distance.
#[inline]
pub(super) fn pull_back(particles: &mut Particles, particle: usize, hold: Vec3A, reach: f32) {
    let away = particles.position[particle] - hold;
    let distance_squared = away.length_squared();
    if distance_squared > reach * reach && particles.inverse_mass[particle] > 0.0 {
        particles.position[particle] = hold + away * (reach / distance_squared.sqrt());
    }
}
