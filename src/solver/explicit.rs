//! The textbook solver: accelerations from the sum of all forces.
//!
//! Exact where its step is small, and therefore also what the other solver is tested against.

use bevy::math::Vec3A;

use super::{Lanes, Material, Particles, Spring, SpringConstants, StepContext, Topology};

/// What ω² h² + 2 γ h may come to. Symplectic Euler is stable below 4: a tenth of it is left for cloth that
/// is bent out of its rest shape.
const STABLE: f32 = 3.6;

/// The strain up to which springs that stiffen are stable, no unit.
const STRETCHED: f32 = 0.2;

/// Substeps that keep a step of `dt` seconds stable, and the share of stiffness and damping that `ctx.max_substeps` of
/// them can carry: 1 unless more would be needed.
///
/// Symplectic Euler of x'' = -ω² x - γ x' is stable while ω² h² + 2 γ h < 4, kept below [`STABLE`] here. The largest ω²
/// and γ of the whole cloth are bounded by Gershgorin's circles, twice the sum over a particle's springs of k/m and of
/// c/m.
pub(super) fn stable_substeps(
    lanes: &Lanes,
    topology: &Topology,
    ctx: &StepContext,
    dt: f32,
    sums: &mut Vec<(f32, f32)>,
) -> (u32, f32) {
    sum_spring_constants(topology, &ctx.material, sums);
    let (mut omega_squared, mut gamma) = (0.0_f32, 0.0_f32);
    for (particle, &(k, c)) in (0..).zip(&*sums) {
        let w = lanes.inverse_mass(lanes.order.slot(particle));
        omega_squared = omega_squared.max(2.0 * k * w);
        gamma = gamma.max(2.0 * c * w);
    }
    // The positive root of ω² h² + 2 γ h = STABLE, written so that ω = 0 needs no special case.
    let longest = STABLE / (gamma + (gamma * gamma + STABLE * omega_squared).sqrt());
    let needed = (dt / longest).ceil().max(1.0);
    let most = ctx.max_substeps.max(1);
    if needed <= most as f32 {
        return (needed as u32, 1.0);
    }
    let h = dt / most as f32;
    (needed as u32, STABLE / (omega_squared * h * h + 2.0 * gamma * h))
}

/// Adds up stiffness and damping of the springs at each particle.
fn sum_spring_constants(topology: &Topology, material: &Material, sums: &mut Vec<(f32, f32)>) {
    sums.clear();
    sums.resize(topology.particle_count(), (0.0, 0.0));
    for batch in &topology.batches {
        for spring in &topology.springs[batch.range.clone()] {
            let law = material.spring(batch.kind, spring);
            let SpringConstants { stiffness, damping } = law.constants;
            let stiffness = stiffness * (1.0 + law.stiffening * STRETCHED);
            for particle in [spring.a, spring.b] {
                let (k, c) = &mut sums[particle as usize];
                *k += stiffness;
                *c += damping;
            }
        }
    }
}

/// Adds the springs' forces: F = k (L0 - |p - q|) n - c ((vp - vq)·n) n with n = (p - q) / |p - q|.
pub(super) fn add_spring_forces(
    particles: &Particles,
    topology: &Topology,
    material: &Material,
    stiffness_scale: f32,
    force: &mut [Vec3A],
) {
    for batch in &topology.batches {
        for spring in &topology.springs[batch.range.clone()] {
            let law = material.spring(batch.kind, spring);
            let &Spring { a, b, rest, .. } = spring;
            let (p, q) = (a as usize, b as usize);
            let along = particles.position[p] - particles.position[q];
            let length = along.length();
            let k = law.secant(length / rest - 1.0) * stiffness_scale;
            let c = law.constants.damping * stiffness_scale;
            let n = along.normalize_or_zero();
            let approach = n.dot(particles.velocity[p] - particles.velocity[q]);
            let pull = n * (k * (rest - length) - c * approach);
            force[p] += pull;
            force[q] -= pull;
        }
    }
}
