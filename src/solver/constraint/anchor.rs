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

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::math::Vec3A;

    #[test]
    fn a_pin_goes_straight_and_steadily_over_the_step() {
        let mut particles =
            Particles { position: vec![Vec3A::ZERO], velocity: vec![Vec3A::ZERO], ..Particles::default() };
        let anchors = [Anchor { particle: 0, start: Vec3A::X, end: Vec3A::X * 3.0 }];
        for quarter in 1..=4 {
            let end = quarter as f32 / 4.0;
            advance(&mut particles, &anchors, end, 0.5);
            assert_eq!(particles.position[0], Vec3A::X * (1.0 + 2.0 * end));
            assert_eq!(particles.velocity[0], Vec3A::X * 4.0);
        }
    }
}
