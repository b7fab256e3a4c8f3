//! The textbook solver: accelerations from the sum of all forces.
//!
//! Exact where its step is small, and therefore also what the other solver is tested against.

use bevy_math::Vec3A;

use crate::{
    constraint::unstructured::{bend::element::BendElement, face::FaceStrain},
    input::StepContext,
    material::{Material, Moduli, SpringConstants},
    particles::{Particles, lanes::Lanes},
    topology::{Spring, SpringKind, Topology},
};

/// What ω² h² + 2 γ h may come to. Symplectic Euler is stable below 4: a tenth of it is left for cloth that
/// is bent out of its rest shape.
const STABLE: f32 = 3.6;

/// By how much more than it is already a sheet may be stretched in a step and still be as stiff as it is, no unit. Beyond
/// that it stiffens no more: however a pin is jerked, the step stays stable.
const MORE_STRETCHED: f32 = 0.2;

/// What keeps a step stable.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stability {
    /// Substeps that it takes.
    pub needed: u32,
    /// Share of stiffness and damping that [`max_substeps`](crate::StepSettings::max_substeps) of them can carry: 1 unless more
    /// would be needed.
    pub scale: f32,
    /// Length over rest length beyond which faces may get no stiffer.
    pub longest: f32,
}

impl Stability {
    /// With so many substeps, whatever the stiffness.
    pub fn unconditional(substeps: u32) -> Self {
        Self { needed: substeps, scale: 1.0, longest: f32::MAX }
    }
}

/// What keeps a step of `dt` seconds stable.
///
/// Symplectic Euler of x'' = -ω² x - γ x' is stable while ω² h² + 2 γ h < 4, kept below [`STABLE`] here. The largest ω²
/// and γ of the whole cloth are bounded by Gershgorin's circles, twice the sum over a particle's springs of k/m and of
/// c/m.
pub(crate) fn stability(
    lanes: &Lanes,
    topology: &Topology,
    ctx: &StepContext,
    dt: f32,
    sums: &mut Vec<(f32, f32)>,
) -> Stability {
    let stretched = MORE_STRETCHED + most_stretched(lanes, topology, &ctx.material);
    sum_spring_constants(topology, &ctx.material, stretched, sums);
    if let Some(moduli) = ctx.material.moduli() {
        sum_sheet_constants(topology, moduli, stretched, sums);
    }
    let (mut omega_squared, mut gamma) = (0.0_f32, 0.0_f32);
    for (particle, &(k, c)) in (0..).zip(&*sums) {
        let w = lanes.inverse_mass(lanes.order.slot(particle));
        omega_squared = omega_squared.max(2.0 * k * w);
        gamma = gamma.max(2.0 * c * w);
    }
    // The positive root of ω² h² + 2 γ h = STABLE, written so that ω = 0 needs no special case.
    let longest = STABLE / (gamma + (gamma * gamma + STABLE * omega_squared).sqrt());
    let needed = (dt / longest).ceil().max(1.0);
    let most = ctx.settings.max_substeps.max(1);
    let h = dt / most as f32;
    let is_enough = needed <= most as f32;
    let scale = if is_enough { 1.0 } else { STABLE / (omega_squared * h * h + 2.0 * gamma * h) };
    Stability { needed: needed as u32, scale, longest: 1.0 + stretched }
}

/// The largest strain of a sheet, no unit: 0 where none is stretched, or where stiffness doesn't change with it.
fn most_stretched(lanes: &Lanes, topology: &Topology, material: &Material) -> f32 {
    if material.moduli().is_none() {
        return 0.0;
    }
    let place = |particle: u32| lanes.position.get(lanes.order.slot(particle));
    let strain = |spring: &Spring| place(spring.a).distance(place(spring.b)) / spring.rest - 1.0;
    let of_strands = topology.springs_of(SpringKind::Structural).map(strain).fold(0.0, f32::max);
    let of_faces = topology.faces.iter().map(|face| FaceStrain::new(face, face.particles.map(place)).longest() - 1.0);
    of_faces.fold(of_strands, f32::max)
}

/// Adds up stiffness and damping of the springs at each particle, where strands are `stretched` by so much.
fn sum_spring_constants(topology: &Topology, material: &Material, stretched: f32, sums: &mut Vec<(f32, f32)>) {
    sums.clear();
    sums.resize(topology.particle_count(), (0.0, 0.0));
    for batch in &topology.batches {
        for spring in &topology.springs[batch.range.clone()] {
            let law = material.spring(batch.kind, spring);
            let SpringConstants { stiffness, damping } = law.constants;
            let stiffness = stiffness * (1.0 + law.stiffening * stretched);
            for particle in [spring.a, spring.b] {
                let (k, c) = &mut sums[particle as usize];
                *k += stiffness;
                *c += damping;
            }
        }
    }
}

/// Adds stiffness and damping of faces and bends to the sums, half of what Gershgorin's circle around a particle takes of
/// them: a spring has its stiffness twice in it.
fn sum_sheet_constants(topology: &Topology, moduli: &Moduli, stretched: f32, sums: &mut [(f32, f32)]) {
    let mut add = |particle: u32, stiffness: f32, delay: f32| {
        let (k, c) = &mut sums[particle as usize];
        *k += 0.5 * stiffness;
        *c += 0.5 * stiffness * delay;
    };
    let [along_u, along_v] =
        [0, 1].map(|i| moduli.stretch[i] + (moduli.stretch[i] - moduli.shear) * moduli.stiffening[i] * stretched);
    for face in &topology.faces {
        let whole = |[b, c]: [f32; 2]| [(b + c).abs(), b.abs(), c.abs()];
        let (u, v) = (whole(face.warp), whole(face.weft));
        let (all_u, all_v) = (u.iter().sum::<f32>(), v.iter().sum::<f32>());
        for ((&particle, u), v) in face.particles.iter().zip(u).zip(v) {
            let threads = along_u * u * all_u + along_v * v * all_v;
            let across = u * all_v + v * all_u + (u + v) * (all_u + all_v) * (1.0 + stretched) * (1.0 + stretched);
            add(particle, face.area * (threads + moduli.shear * across), moduli.stretch_damping);
        }
    }
    for bend in &topology.bends {
        let all: f32 = bend.weights.iter().map(|weight| weight.abs()).sum();
        for (&particle, weight) in bend.particles.iter().zip(bend.weights) {
            add(particle, moduli.bending * weight.abs() * all, moduli.bend_damping);
        }
    }
}

/// Adds the springs' forces: F = k (L0 - |p - q|) n - c ((vp - vq)·n) n with n = (p - q) / |p - q|.
pub(crate) fn add_spring_forces(
    particles: &Particles,
    topology: &Topology,
    material: &Material,
    Stability { scale: stiffness_scale, longest, .. }: Stability,
    force: &mut [Vec3A],
) {
    for batch in &topology.batches {
        for spring in &topology.springs[batch.range.clone()] {
            let law = material.spring(batch.kind, spring);
            let &Spring { a, b, rest, .. } = spring;
            let (p, q) = (a as usize, b as usize);
            let along = particles.position[p] - particles.position[q];
            let length = along.length();
            let k = law.secant((length / rest).min(longest) - 1.0) * stiffness_scale;
            let c = law.constants.damping * stiffness_scale;
            let n = along.normalize_or_zero();
            let approach = n.dot(particles.velocity[p] - particles.velocity[q]);
            let pull = n * (k * (rest - length) - c * approach);
            force[p] += pull;
            force[q] -= pull;
        }
    }
}

/// Adds the forces of faces and bends, as they are the negative gradient of their energies.
pub(crate) fn add_sheet_forces(
    particles: &Particles,
    topology: &Topology,
    moduli: &Moduli,
    Stability { scale: stiffness_scale, longest, .. }: Stability,
    force: &mut [Vec3A],
) {
    let at = |particle: u32| particles.position[particle as usize];
    let rate = |particle: u32| particles.velocity[particle as usize];
    for face in &topology.faces {
        let rates = FaceStrain::new(face, face.particles.map(rate));
        let [on_b, on_c] = FaceStrain::new(face, face.particles.map(at)).forces(face, moduli, &rates, longest);
        for (&particle, pull) in face.particles.iter().zip([-(on_b + on_c), on_b, on_c]) {
            force[particle as usize] += pull * stiffness_scale;
        }
    }
    for bend in &topology.bends {
        let rates = BendElement::new(bend, bend.particles.map(rate));
        let forces = BendElement::new(bend, bend.particles.map(at)).forces(bend, moduli, &rates);
        for (&particle, pull) in bend.particles.iter().zip(forces) {
            force[particle as usize] += pull * stiffness_scale;
        }
    }
}
