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
//! While it is held, the point has the mass of the hand as well: particles of a fraction of a gram, between springs
//! that are solved once a substep, couldn't hold the cloth's weight nor lead it. That mass has no inertia of its own:
//! the point starts each substep at the speed of its target, so that it doesn't swing around it. The force is bounded:
//! springs that can't follow hold the hand back. Tethers don't, they move the rest of the cloth as if it had no weight.

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

impl Grab {
    /// The grabbed point, for the values `of` all particles.
    fn point(&self, of: &[Vec3A]) -> Vec3A {
        let [a, b, c] = self.particles.map(|i| of[i as usize]);
        a * self.weights[0] + b * self.weights[1] + c * self.weights[2]
    }

    /// Inverse mass of the grabbed point, 1/kg: the sum of bi² wi.
    fn inverse_mass(&self, particles: &Particles) -> f32 {
        let share = |i: usize| self.weights[i] * self.weights[i] * particles.inverse_mass[self.particles[i] as usize];
        share(0) + share(1) + share(2)
    }

    /// Changes the point's position or velocity by `change`: its particles' by bi wi / w of it.
    fn push(&self, particles: &mut Particles, change: Vec3A, of: impl Fn(&mut Particles) -> &mut [Vec3A]) {
        let w = self.inverse_mass(particles);
        for (&particle, weight) in self.particles.iter().zip(self.weights) {
            let share = weight * particles.inverse_mass[particle as usize];
            // None of it where all are fixed.
            if share > 0.0 {
                of(particles)[particle as usize] += change * (share / w);
            }
        }
    }
}

/// Adds the hands' masses to the particles that they hold, and keeps the `own` inverse masses of those.
pub fn take_up(particles: &mut Particles, grabs: &[Grab], own: &mut Vec<(u32, f32)>) {
    own.clear();
    for grab in grabs {
        for (&particle, weight) in grab.particles.iter().zip(grab.weights) {
            let w = &mut particles.inverse_mass[particle as usize];
            own.push((particle, *w));
            *w /= 1.0 + *w * grab.mass * weight;
        }
    }
}

/// Gives the held particles their `own` inverse masses back.
pub fn put_down(particles: &mut Particles, own: &[(u32, f32)]) {
    // Backwards: the first entry of a particle that two hands hold is the one without either.
    for &(particle, w) in own.iter().rev() {
        particles.inverse_mass[particle as usize] = w;
    }
}

/// Gives every grabbed point the speed of its target in the part `span` (0..=1) of the step, a substep of `h` seconds.
pub fn carry(particles: &mut Particles, grabs: &[Grab], span: Range<f32>, h: f32) {
    for grab in grabs {
        let speed = (grab.end - grab.start) * ((span.end - span.start) / h);
        let lacking = speed - grab.point(&particles.velocity);
        grab.push(particles, lacking, |particles| &mut particles.velocity);
    }
}

/// Pulls every grabbed point towards its target within the part `span` (0..=1) of the step, a substep of `h` seconds.
pub fn solve(particles: &mut Particles, grabs: &[Grab], span: Range<f32>, h: f32) {
    for grab in grabs {
        let (before, target) = (grab.start.lerp(grab.end, span.start), grab.start.lerp(grab.end, span.end));
        let w = grab.inverse_mass(particles);
        let (now, previous) = (grab.point(&particles.position), grab.point(&particles.previous));
        let drift = (now - previous) - (target - before);
        let (k, c) = (grab.stiffness * h * h, grab.damping * h);
        let lambda = ((target - now) * k - drift * c) / ((k + c) * w + 1.0);
        let lambda = lambda.clamp_length_max(grab.max_force * h * h);
        grab.push(particles, lambda * w, |particles| &mut particles.position);
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
            mass: 0.0,
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
    fn the_force_of_a_grab_is_bounded() {
        let mut particles = triangle();
        solve(&mut particles, &[Grab { max_force: 6.0, ..grab() }], 0.0..1.0, 0.1);
        assert!((particles.position[0].z - 6.0 / 1.5 * 0.01).abs() < 1e-6);
    }

    #[test]
    fn a_held_point_has_the_mass_of_its_hands_and_gets_its_own_back() {
        let mut particles = triangle();
        let hands = [Grab { mass: 3.0, ..grab() }, Grab { mass: 6.0, weights: [1.0, 0.0, 0.0], ..grab() }];
        let mut own = Vec::new();
        take_up(&mut particles, &hands, &mut own);
        let masses = [7.5, 1.5, 1.5];
        for (w, mass) in particles.inverse_mass.iter().zip(masses) {
            assert!((w * mass - 1.0).abs() < 1e-6, "{w}");
        }
        put_down(&mut particles, &own);
        assert_eq!(particles, triangle());
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
