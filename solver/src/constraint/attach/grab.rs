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
//! The spring is the implicit one of [`spring`](crate::constraint::unstructured::spring), between a point of mass 1/w with w = sum of bi² wi and
//! one that can't be moved:
//!
//! lambda = -(k h² (p - target) + c h (Δp - Δtarget)) / ((k h² + c h) w + 1)
//!
//! While it is held, the point has the mass of the hand as well: particles of a fraction of a gram, between springs
//! that are solved once a substep, couldn't hold the cloth's weight nor lead it. That mass has no inertia of its own:
//! the point starts each substep at the speed of its target, so that it doesn't swing around it. The force is bounded:
//! springs that can't follow hold the hand back. Tethers don't, they move the rest of the cloth as if it had no weight.

use core::ops::Range;

use bevy_math::Vec3A;

use crate::{
    constraint::attach::tether,
    input::{Grab, GrabTether},
    layout::{order::Order, points::Points, simd::LANES},
    particles::lanes::Lanes,
};

impl Grab {
    /// The grabbed point, for the values `of` all particles.
    fn point(&self, order: Order, of: &Points) -> Vec3A {
        let [a, b, c] = self.particles.map(|i| of.get(order.slot(i)));
        a * self.weights[0] + b * self.weights[1] + c * self.weights[2]
    }

    /// Inverse mass of the grabbed point, 1/kg: the sum of bi² wi.
    fn inverse_mass(&self, lanes: &Lanes) -> f32 {
        let share =
            |i: usize| self.weights[i] * self.weights[i] * lanes.inverse_mass(lanes.order.slot(self.particles[i]));
        share(0) + share(1) + share(2)
    }

    /// Share of the point that isn't fixed, 0..=1: as much as it can follow. Beside a pin, what is free would have to go any
    /// distance to bring it all the way.
    fn free_share(&self, lanes: &Lanes) -> f32 {
        let is_fixed = |&(&particle, _): &(&u32, f32)| lanes.inverse_mass(lanes.order.slot(particle)) == 0.0;
        let fixed: f32 = self.particles.iter().zip(self.weights).filter(is_fixed).map(|(_, weight)| weight).sum();
        (1.0 - fixed).clamp(0.0, 1.0)
    }

    /// Changes the point's position or velocity by `change`: its particles' by bi wi / w of it.
    fn push(&self, lanes: &mut Lanes, change: Vec3A, of: impl Fn(&mut Lanes) -> &mut Points) {
        let w = self.inverse_mass(lanes);
        for (&particle, weight) in self.particles.iter().zip(self.weights) {
            let slot = lanes.order.slot(particle);
            let share = weight * lanes.inverse_mass(slot);
            // None of it where all are fixed.
            if share > 0.0 {
                let values = of(lanes);
                values.set(slot, values.get(slot) + change * (share / w));
            }
        }
    }
}

/// Adds the hands' masses to the particles that they hold, for the rest of the step.
pub(crate) fn take_up(lanes: &mut Lanes, grabs: &[Grab]) {
    for grab in grabs {
        for (&particle, weight) in grab.particles.iter().zip(grab.weights) {
            let slot = lanes.order.slot(particle);
            let w = &mut lanes.inverse_mass[slot / LANES][slot % LANES];
            *w /= 1.0 + *w * grab.mass * weight;
        }
    }
}

/// Gives every grabbed point the speed of its target in the part `span` (0..=1) of the step, a substep of `h` seconds.
pub(crate) fn carry(lanes: &mut Lanes, grabs: &[Grab], span: Range<f32>, h: f32) {
    for grab in grabs {
        let speed = (grab.end - grab.start) * ((span.end - span.start) / h);
        let lacking = speed - grab.point(lanes.order, &lanes.velocity);
        let lacking = lacking * grab.free_share(lanes);
        grab.push(lanes, lacking, |lanes| &mut lanes.velocity);
    }
}

/// Pulls every grabbed point towards its target within the part `span` (0..=1) of the step, a substep of `h` seconds.
pub(crate) fn solve(lanes: &mut Lanes, grabs: &[Grab], span: Range<f32>, h: f32) {
    for grab in grabs {
        let (before, target) = (grab.start.lerp(grab.end, span.start), grab.start.lerp(grab.end, span.end));
        let w = grab.inverse_mass(lanes);
        let (now, previous) = (grab.point(lanes.order, &lanes.position), grab.point(lanes.order, &lanes.previous));
        let drift = (now - previous) - (target - before);
        let (k, c) = (grab.stiffness * h * h, grab.damping * h);
        let lambda = ((target - now) * k - drift * c) / ((k + c) * w + 1.0);
        let lambda = lambda.clamp_length_max(grab.max_force * h * h);
        grab.push(lanes, lambda * w, |lanes| &mut lanes.position);
    }
}

/// Pulls the particles that are too far from a grabbed point back to the end of their tethers.
pub(crate) fn solve_tethers(lanes: &mut Lanes, grabs: &[Grab], slack: f32) {
    for grab in grabs {
        let point = grab.point(lanes.order, &lanes.position);
        for &GrabTether { particle, length } in &*grab.tethers {
            tether::pull_back(lanes, particle, point, length * (1.0 + slack));
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::{layout::simd::SimdLevel, particles::Particles};

    fn triangle() -> Lanes {
        let particles = Particles {
            position: vec![Vec3A::ZERO, Vec3A::X, Vec3A::Y],
            velocity: vec![Vec3A::ZERO; 3],
            inverse_mass: vec![2.0; 3],
            force: vec![Vec3A::ZERO; 3],
            contact_load: Default::default(),
        };
        let mut lanes = Lanes::default();
        lanes.load(&particles, Order::plain(3), SimdLevel::Best);
        lanes.previous = lanes.position.clone();
        lanes
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
        let mut lanes = triangle();
        solve(&mut lanes, &[grab()], 0.0..1.0, 0.1);
        // Three particles of 0.5 kg as one: m Δz = h² (k (s - Δz) - c Δz / h), with s = 0.5 m.
        let expected = 100.0 * 0.01 * 0.5 / (1.5 + 100.0 * 0.01 + 3.0 * 0.1);
        for z in &lanes.position.0[0][2][..3] {
            assert!((z - expected).abs() < 1e-6, "{z}");
        }
    }

    #[test]
    fn the_force_of_a_grab_is_bounded() {
        let mut lanes = triangle();
        solve(&mut lanes, &[Grab { max_force: 6.0, ..grab() }], 0.0..1.0, 0.1);
        assert!((lanes.position.get(0).z - 6.0 / 1.5 * 0.01).abs() < 1e-6);
    }

    #[test]
    fn a_held_point_has_the_mass_of_its_hands() {
        let mut lanes = triangle();
        let hands = [Grab { mass: 3.0, ..grab() }, Grab { mass: 6.0, weights: [1.0, 0.0, 0.0], ..grab() }];
        take_up(&mut lanes, &hands);
        let masses = [7.5, 1.5, 1.5];
        for (w, mass) in lanes.inverse_mass[0].iter().zip(masses) {
            assert!((w * mass - 1.0).abs() < 1e-6, "{w}");
        }
    }

    #[test]
    fn a_fixed_particle_is_not_pulled() {
        let mut lanes = triangle();
        lanes.inverse_mass[0][0] = 0.0;
        solve(&mut lanes, &[grab()], 0.0..1.0, 0.1);
        assert_eq!(lanes.position.get(0), Vec3A::ZERO);
        assert!(lanes.position.get(1).z > 0.0);
        lanes.inverse_mass[0].fill(0.0);
        let before = lanes.position.clone();
        solve(&mut lanes, &[grab()], 0.0..1.0, 0.1);
        assert_eq!(lanes.position, before);
    }
}
