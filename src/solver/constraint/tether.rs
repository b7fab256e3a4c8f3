//! Tethers: a particle may not be farther from a pin than the cloth between them is long.
//!
//! ```text
//!   pin o~~~~~~~~~~~~~~~~ particle       |x - pin| <= length (1 + slack)
//! ```
//!
//! Kim, Chentanez and Müller-Fischer, "Long Range Attachments" (2012). One-sided: a slack tether does nothing.

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
    let Particles { position, inverse_mass, .. } = particles;
    let inverse_mass = &inverse_mass[..position.len()];
    let longer = 1.0 + slack;
    for &Tether { particle, pin, length } in tethers {
        let particle = particle as usize;
        let pin = position[pin as usize];
        let reach = length * longer;
        let away = position[particle] - pin;
        let distance_squared = away.length_squared();
        if distance_squared > reach * reach && inverse_mass[particle] > 0.0 {
            position[particle] = pin + away * (reach / distance_squared.sqrt());
        }
    }
}
