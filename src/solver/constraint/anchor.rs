//! Fixed particles follow their pins.

use crate::solver::{Anchor, Particles};

/// Puts every anchored particle where its pin is at the fraction `end` (0..=1) of a step of `dt` seconds.
pub fn advance(particles: &mut Particles, anchors: &[Anchor], end: f32, dt: f32) {
    for anchor in anchors {
        let i = anchor.particle as usize;
        particles.position[i] = anchor.start.lerp(anchor.end, end);
        particles.velocity[i] = (anchor.end - anchor.start) / dt;
    }
}
