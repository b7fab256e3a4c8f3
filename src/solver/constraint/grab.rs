//! Hands: each pulls a point of a triangle after a target, like a stiff, damped spring of bounded force.
//!
//! ```text
//!        x2
//!        /\
//!       /  \            p = b0 x0 + b1 x1 + b2 x2
//!      / p~~~~~~~o target            C = |p - target|
//!    x0------x1
//! ```
//!
//! The spring is the implicit one of [`spring`](super::spring), between a point of mass 1/w with w = sum of bi² wi and
//! one that can't be moved:
//!
//! lambda = -(k h² (p - target) + c h (Δp - Δtarget)) / ((k h² + c h) w + 1)
//!
//! The bounds keep a jerk from tearing the point out of the cloth around it: what the springs and tethers haven't
//! carried along yet holds it back.

use core::ops::Range;
use std::sync::Arc;

use bevy::math::Vec3A;

use super::tether;
use crate::solver::Particles;

/// A hand on its way over one step.
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
    /// The farthest that the spring moves the point within a substep, m.
    pub max_move: f32,
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

impl Grab {
    /// The grabbed point, for the values `of` all particles.
    fn point(&self, of: &[Vec3A]) -> Vec3A {
        let [a, b, c] = self.particles.map(|i| of[i as usize]);
        a * self.weights[0] + b * self.weights[1] + c * self.weights[2]
    }
}

/// Pulls every grabbed point towards its target within the part `span` (0..=1) of the step, a substep of `h` seconds.
pub fn solve(particles: &mut Particles, grabs: &[Grab], span: Range<f32>, h: f32) {
    for grab in grabs {
        let (before, target) = (grab.start.lerp(grab.end, span.start), grab.start.lerp(grab.end, span.end));
        let inverse_mass = grab.particles.map(|i| particles.inverse_mass[i as usize]);
        let w: f32 = (0..3).map(|i| grab.weights[i] * grab.weights[i] * inverse_mass[i]).sum();
        if w == 0.0 {
            continue;
        }
        let (now, previous) = (grab.point(&particles.position), grab.point(&particles.previous));
        let drift = (now - previous) - (target - before);
        let (k, c) = (grab.stiffness * h * h, grab.damping * h);
        let lambda = ((target - now) * k - drift * c) / ((k + c) * w + 1.0);
        let lambda = lambda.clamp_length_max((grab.max_force * h * h).min(grab.max_move / w));
        for i in 0..3 {
            particles.position[grab.particles[i] as usize] += lambda * (grab.weights[i] * inverse_mass[i]);
        }
    }
}

/// Pulls the particles that are too far from a grabbed point back to the end of their tethers.
pub fn solve_tethers(particles: &mut Particles, grabs: &[Grab], slack: f32) {
    for grab in grabs {
        let point = grab.point(&particles.position);
        for &GrabTether { particle, length } in &*grab.tethers {
            tether::pull_back(particles, particle as usize, point, length * (1.0 + slack));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle() -> Particles {
        let position = vec![Vec3A::ZERO, Vec3A::X, Vec3A::Y];
        Particles {
            previous: position.clone(),
            velocity: vec![Vec3A::ZERO; 3],
            inverse_mass: vec![2.0; 3],
            force: vec![Vec3A::ZERO; 3],
            position,
        }
    }

    /// Pulls the middle of the triangle 0.5 m along Z.
    fn grab() -> Grab {
        let middle = Vec3A::new(1.0, 1.0, 0.0) / 3.0;
        Grab {
            particles: [0, 1, 2],
            weights: [1.0 / 3.0; 3],
            start: middle + Vec3A::Z * 0.5,
            end: middle + Vec3A::Z * 0.5,
            stiffness: 100.0,
            damping: 3.0,
            max_force: f32::INFINITY,
            max_move: f32::INFINITY,
            tethers: Arc::default(),
        }
    }

    #[test]
    fn a_grabbed_point_moves_by_the_implicit_euler_answer() {
        let mut particles = triangle();
        solve(&mut particles, &[grab()], 0.0..1.0, 0.1);
        // Three particles of 0.5 kg as one: m Δz = h² (k (s - Δz) - c Δz / h), with s = 0.5 m.
        let expected = 100.0 * 0.01 * 0.5 / (1.5 + 100.0 * 0.01 + 3.0 * 0.1);
        for position in &particles.position {
            assert!((position.z - expected).abs() < 1e-6, "{position}");
        }
    }

    #[test]
    fn the_force_and_the_way_of_a_grab_are_bounded() {
        let mut particles = triangle();
        solve(&mut particles, &[Grab { max_force: 6.0, ..grab() }], 0.0..1.0, 0.1);
        assert!((particles.position[0].z - 6.0 / 1.5 * 0.01).abs() < 1e-6);
        let mut particles = triangle();
        solve(&mut particles, &[Grab { max_move: 0.01, ..grab() }], 0.0..1.0, 0.1);
        assert!((particles.position[0].z - 0.01).abs() < 1e-6);
    }

    #[test]
    fn a_fixed_particle_is_not_pulled() {
        let mut particles = triangle();
        particles.inverse_mass = vec![0.0, 2.0, 2.0];
        solve(&mut particles, &[grab()], 0.0..1.0, 0.1);
        assert_eq!(particles.position[0], Vec3A::ZERO);
        assert!(particles.position[1].z > 0.0);
        particles.inverse_mass = vec![0.0; 3];
        let before = particles.clone();
        solve(&mut particles, &[grab()], 0.0..1.0, 0.1);
        assert_eq!(particles, before);
    }
}
