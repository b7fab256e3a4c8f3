//! Damped springs as compliant distance constraints.
//!
//! ```text
//!   a ----- L0 ----- b        C = |xa - xb| - L0
//! ```
//!
//! The implicit form of Hooke's spring with damping: Macklin, Müller and Chentanez, "XPBD: Position-Based Simulation
//! of Compliant Constrained Dynamics" (2016), equations 18 and 26, for one iteration a substep. Multiplied by
//! k h², so that neither a stiffness of zero nor an infinite compliance needs a special case:
//!
//! lambda = -(k h² C + c h n·(Δxa - Δxb)) / ((k h² + c h) (wa + wb) + 1)
//!
//! with n the direction from b to a and Δx the way of a particle within the substep.

use bevy::math::Vec3A;

use crate::solver::{Material, Particles, Spring, SpringConstants, Topology};

/// Below this length (m) a spring has no direction and rests.
const SHORTEST: f32 = 1e-9;

/// Works out, once a step, how much of each spring's push its two ends take: their inverse mass over the denominator
/// above, which changes neither from substep to substep nor with the positions.
pub(in crate::solver) fn weigh(
    particles: &Particles,
    topology: &Topology,
    material: &Material,
    h: f32,
    shares: &mut [[f32; 2]],
) {
    for batch in &topology.batches {
        let (k, c) = scaled(material.spring(batch.kind), h);
        let range = batch.range.clone();
        for (share, spring) in shares[range.clone()].iter_mut().zip(&topology.springs[range]) {
            let w = [spring.a, spring.b].map(|i| particles.inverse_mass[i as usize]);
            *share = w.map(|wi| wi / ((k + c) * (w[0] + w[1]) + 1.0));
        }
    }
}

/// Solves all springs once, batch after batch, in a substep of `h` seconds with the shares that [`weigh`] gave.
pub(in crate::solver) fn solve(
    particles: &mut Particles,
    topology: &Topology,
    material: &Material,
    h: f32,
    shares: &[[f32; 2]],
) {
    for batch in &topology.batches {
        let (springs, shares) = (&topology.springs[batch.range.clone()], &shares[batch.range.clone()]);
        let (k, c) = scaled(material.spring(batch.kind), h);
        if c > 0.0 {
            solve_batch::<true>(particles, springs, shares, k, c);
        } else if k > 0.0 {
            solve_batch::<false>(particles, springs, shares, k, c);
        }
    }
}

/// k h² and c h.
fn scaled(constants: SpringConstants, h: f32) -> (f32, f32) {
    (constants.stiffness * h * h, constants.damping * h)
}

fn solve_batch<const DAMPED: bool>(particles: &mut Particles, springs: &[Spring], shares: &[[f32; 2]], k: f32, c: f32) {
    let Particles { position, previous, .. } = particles;
    // Slices of one length let one bounds check serve both.
    let previous = &previous[..position.len()];
    for (&Spring { a, b, rest }, &[share_a, share_b]) in springs.iter().zip(shares) {
        let (a, b) = (a as usize, b as usize);
        let (xa, xb) = (position[a], position[b]);
        let along = xa - xb;
        let length = along.length().max(SHORTEST);
        let mut push = k * (rest - length) / length;
        if DAMPED {
            push -= c * along.dot(along - (previous[a] - previous[b])) / (length * length);
        }
        position[a] = xa + along * (push * share_a);
        position[b] = xb - along * (push * share_b);
    }
}

/// Strain of a spring: length over rest length, less one. Positive when stretched.
pub fn strain(position: &[Vec3A], spring: &Spring) -> f32 {
    position[spring.a as usize].distance(position[spring.b as usize]) / spring.rest - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::{SpringBatch, SpringKind};

    fn pair(distance: f32) -> (Particles, Topology) {
        let particles = Particles {
            position: vec![Vec3A::ZERO, Vec3A::X * distance],
            previous: vec![Vec3A::ZERO, Vec3A::X * distance],
            velocity: vec![Vec3A::ZERO; 2],
            inverse_mass: vec![0.0, 2.0],
            force: vec![Vec3A::ZERO; 2],
        };
        let topology = Topology {
            springs: vec![Spring { a: 0, b: 1, rest: 1.0 }],
            batches: vec![SpringBatch { kind: SpringKind::Structural, range: 0..1 }],
            areas: vec![1.0; 2],
            ..Default::default()
        };
        (particles, topology)
    }

    fn material(stiffness: f32, damping: f32) -> Material {
        let mut springs = [SpringConstants::default(); 3];
        springs[0] = SpringConstants { stiffness, damping };
        Material { density: 1.0, springs, damping: 0.0, thickness: 0.0, friction: 0.0, drag: 0.0, lift: 0.0 }
    }

    fn solve_once(particles: &mut Particles, topology: &Topology, material: &Material) {
        let mut shares = [[0.0; 2]];
        weigh(particles, topology, material, 0.1, &mut shares);
        solve(particles, topology, material, 0.1, &shares);
    }

    #[test]
    fn a_spring_moves_by_the_implicit_euler_answer() {
        let (mut particles, topology) = pair(1.5);
        solve_once(&mut particles, &topology, &material(100.0, 3.0));
        // Implicit Euler for m = 0.5 kg: m Δx = h² (-k (s + Δx) - c Δx / h), with the stretch s = 0.5 m.
        let expected = -100.0 * 0.01 * 0.5 / (0.5 + 100.0 * 0.01 + 3.0 * 0.1);
        assert!((particles.position[1].x - 1.5 - expected).abs() < 1e-6);
        assert_eq!(particles.position[0], Vec3A::ZERO);
    }

    #[test]
    fn springs_without_stiffness_or_length_stay_finite() {
        let (mut particles, topology) = pair(0.0);
        solve_once(&mut particles, &topology, &material(0.0, 0.0));
        solve_once(&mut particles, &topology, &material(1e9, 1e9));
        assert!(particles.is_finite());
    }
}
