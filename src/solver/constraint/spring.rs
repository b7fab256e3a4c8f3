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

/// Springs whose roots and divisions are taken side by side. Those of one batch share no particle, so the answer is the
/// same as one after the other. The wait for a root is shared, which makes the whole step a tenth faster.
const ABREAST: usize = 4;

fn solve_batch<const DAMPED: bool>(particles: &mut Particles, springs: &[Spring], shares: &[[f32; 2]], k: f32, c: f32) {
    let (groups, rest) = springs.as_chunks::<ABREAST>();
    let (group_shares, rest_shares) = shares.as_chunks::<ABREAST>();
    for (springs, shares) in groups.iter().zip(group_shares) {
        solve_abreast::<DAMPED, ABREAST>(particles, springs, shares, k, c);
    }
    for (spring, share) in rest.iter().zip(rest_shares) {
        solve_abreast::<DAMPED, 1>(particles, &[*spring], &[*share], k, c);
    }
}

#[inline(always)]
fn solve_abreast<const DAMPED: bool, const N: usize>(
    particles: &mut Particles,
    springs: &[Spring; N],
    shares: &[[f32; 2]; N],
    k: f32,
    c: f32,
) {
    let Particles { position, previous, .. } = particles;
    let along = springs.map(|Spring { a, b, .. }| position[a as usize] - position[b as usize]);
    let squared = along.map(|along| along.length_squared());
    let mut push = [0.0; N];
    for i in 0..N {
        let length = squared[i].sqrt().max(SHORTEST);
        push[i] = k * (springs[i].rest - length) / length;
    }
    if DAMPED {
        for i in 0..N {
            let Spring { a, b, .. } = springs[i];
            let before = previous[a as usize] - previous[b as usize];
            push[i] -= c * along[i].dot(along[i] - before) / squared[i].max(SHORTEST * SHORTEST);
        }
    }
    for i in 0..N {
        let Spring { a, b, .. } = springs[i];
        let [share_a, share_b] = shares[i];
        position[a as usize] += along[i] * (push[i] * share_a);
        position[b as usize] -= along[i] * (push[i] * share_b);
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
