//! Damped springs as compliant distance constraints.
//!
//! ```text
//!   a ----- L0 ----- b        C = |xb - xa| - L0
//! ```
//!
//! The implicit form of Hooke's spring with damping: Macklin, Müller and Chentanez, "XPBD: Position-Based Simulation
//! of Compliant Constrained Dynamics" (2016), equations 18 and 26, for one iteration a substep. Multiplied by
//! k h², so that neither a stiffness of zero nor an infinite compliance needs a special case:
//!
//! lambda = -(k h² C + c h n·(Δxb - Δxa)) / ((k h² + c h) (wa + wb) + 1)
//!
//! with n the direction from a to b and Δx the way of a particle within the substep.

use bevy::math::Vec3A;
use fearless_simd::{dispatch, f32x8, prelude::*};

use super::{
    braid::Strung,
    law::{Law, Scaled},
};
use crate::solver::{
    Lanes, Material, Spring, SpringBatch, SpringConstants, SpringKind, Topology,
    lanes::{Block, apart, together},
    simd::{Instructions, LANES, Lane, SHORTEST, Vec3Wide, Vec3x8, Wide, lane},
};

/// Springs are few where there are so many particles for each: going to the beads and back would take longer.
const FEW: usize = 4;

/// One end of springs side by side.
#[derive(Clone, Copy, Debug)]
pub(in crate::solver) struct End<F> {
    pub position: Vec3Wide<F>,
    /// Position before the substep; read only where springs are damped.
    pub previous: Vec3Wide<F>,
    pub inverse_mass: F,
}

/// Solves springs side by side that share no particle, and returns where their ends are moved to. A spring with a rest
/// length of zero isn't there.
#[inline(always)]
pub(in crate::solver) fn solve_abreast<S: Simd, F: Wide<S>, const DAMPED: bool>(
    simd: S,
    a: End<F>,
    b: End<F>,
    rest: F,
    law: impl Law<S, F>,
) -> [Vec3Wide<F>; 2] {
    let along = b.position - a.position;
    let squared = along.dot(along);
    let length = squared.sqrt().max(F::splat(simd, SHORTEST));
    let [k, c] = law.scaled(simd, rest, length);
    let mut push = (rest - length) * k;
    let mut total = k;
    if DAMPED {
        // Along the spring: n·Δ = along·Δ / length.
        push -= along.dot(along - (b.previous - a.previous)) * c / length;
        total += c;
    }
    let per_length = push / (length * ((a.inverse_mass + b.inverse_mass) * total + 1.0));
    let none = F::splat(simd, 0.0);
    let per_length = rest.simd_gt(none).select(per_length, none);
    [a.position - along * (per_length * a.inverse_mass), b.position + along * (per_length * b.inverse_mass)]
}

/// The particles one by one: what springs between any two of them read and write.
#[derive(Clone, Debug, Default)]
pub(in crate::solver) struct Beads {
    /// Position, m, and inverse mass, 1/kg.
    now: Vec<[f32; 4]>,
    /// Position before the substep, m; only where springs are damped.
    before: Vec<[f32; 4]>,
}

impl Beads {
    #[inline(always)]
    fn read<S: Simd, const DAMPED: bool>(&mut self, simd: S, lanes: &Lanes) {
        // One more: missing ends of springs are there.
        let count = lanes.order.particle_count() + 1;
        self.now.resize(count, [0.0; 4]);
        let blocks = lanes.order.blocks().zip(&lanes.position.0).zip(&lanes.inverse_mass);
        for (((first, count), [x, y, z]), masses) in blocks {
            let beads = together([lane(simd, x), lane(simd, y), lane(simd, z), lane(simd, masses)]);
            self.now[first..first + count].copy_from_slice(&beads[..count]);
        }
        if DAMPED {
            self.before.resize(count, [0.0; 4]);
            for ((first, count), [x, y, z]) in lanes.order.blocks().zip(&lanes.previous.0) {
                let z = lane(simd, z);
                let beads = together([lane(simd, x), lane(simd, y), z, z]);
                self.before[first..first + count].copy_from_slice(&beads[..count]);
            }
        }
    }

    #[inline(always)]
    fn write<S: Simd>(&self, simd: S, lanes: &mut Lanes) {
        for ((first, count), block) in lanes.order.blocks().zip(&mut lanes.position.0) {
            let mut beads = [[0.0; 4]; LANES];
            beads[..count].copy_from_slice(&self.now[first..first + count]);
            let [a, b, c, d, e, f, g, h] = &beads;
            let [x, y, z, _] = apart(simd, [a, b, c, d, e, f, g, h]);
            *block = [x.into(), y.into(), z.into()];
        }
    }
}

impl Beads {
    /// One end of eight springs, at eight particles.
    #[inline(always)]
    pub fn end<S: Simd, const DAMPED: bool>(&self, simd: S, particles: &[u32; LANES]) -> End<f32x8<S>> {
        let [x, y, z, inverse_mass] = gather(simd, &self.now, particles);
        let position = Vec3x8 { x, y, z };
        let previous = if DAMPED {
            let [x, y, z, _] = gather(simd, &self.before, particles);
            Vec3x8 { x, y, z }
        } else {
            position
        };
        End { position, previous, inverse_mass }
    }

    /// Moves eight particles.
    #[inline(always)]
    pub fn put<S: Simd>(&mut self, particles: &[u32; LANES], Vec3x8 { x, y, z }: Vec3x8<S>, inverse_mass: f32x8<S>) {
        for (&i, bead) in particles.iter().zip(together([x, y, z, inverse_mass])) {
            self.now[i as usize] = bead;
        }
    }
}

#[inline(always)]
fn gather<S: Simd>(simd: S, beads: &[[f32; 4]], [a, b, c, d, e, f, g, h]: &[u32; LANES]) -> [f32x8<S>; 4] {
    apart(
        simd,
        [
            bead(beads, a),
            bead(beads, b),
            bead(beads, c),
            bead(beads, d),
            bead(beads, e),
            bead(beads, f),
            bead(beads, g),
            bead(beads, h),
        ],
    )
}

#[inline(always)]
fn bead<'a>(beads: &'a [[f32; 4]], i: &u32) -> &'a [f32; 4] {
    &beads[*i as usize]
}

/// Solves all springs of `batches` once, batch after batch, in a substep of `h` seconds, and then the braids.
#[expect(clippy::too_many_arguments, reason = "springs and braids share one way to the beads and back")]
pub(in crate::solver) fn solve<'a>(
    lanes: &mut Lanes,
    topology: &Topology,
    batches: impl Iterator<Item = &'a SpringBatch> + Clone,
    material: &Material,
    h: f32,
    beads: &mut Beads,
    braids: Option<Strung>,
    instructions: Instructions,
) {
    let level = instructions.level();
    let batches = batches.map(|batch| (batch, Scaled::new(material.alike(batch.kind), h)));
    let batches = batches.filter(|(_, constants)| constants.acts());
    let count: usize = batches.clone().map(|(batch, _)| batch.range.len()).sum();
    if braids.is_none() && count * FEW <= lanes.order.particle_count() {
        for (batch, constants) in batches {
            let springs = &topology.springs[batch.range.clone()];
            if constants.c > 0.0 {
                dispatch!(level, simd => solve_scattered::<_, true>(simd, lanes, springs, constants));
            } else {
                dispatch!(level, simd => solve_scattered::<_, false>(simd, lanes, springs, constants));
            }
        }
        return;
    }
    if SpringKind::ALL.iter().any(|&kind| material.alike(kind).damping > 0.0) {
        dispatch!(level, simd => beads.read::<_, true>(simd, lanes));
    } else {
        dispatch!(level, simd => beads.read::<_, false>(simd, lanes));
    }
    for (batch, constants) in batches {
        let springs = &topology.springs[batch.range.clone()];
        if constants.c > 0.0 {
            dispatch!(level, simd => solve_batch::<_, true>(simd, beads, springs, constants));
        } else {
            dispatch!(level, simd => solve_batch::<_, false>(simd, beads, springs, constants));
        }
    }
    if let Some(strung) = braids {
        strung.solve(beads, instructions);
    }
    dispatch!(level, simd => beads.write(simd, lanes));
}

/// Springs of one batch that are few among many particles, as along the seam of a tube: the particles stay where they
/// are.
#[inline(always)]
fn solve_scattered<S: Simd, const DAMPED: bool>(simd: S, lanes: &mut Lanes, springs: &[Spring], constants: Scaled) {
    for springs in springs.chunks(LANES) {
        let mut ends = [(Block::default(), Block::default(), Lane::default()); 2];
        let mut rest = Lane::default();
        for (i, spring) in springs.iter().enumerate() {
            rest[i] = spring.rest;
            for ((position, previous, inverse_mass), particle) in ends.iter_mut().zip([spring.a, spring.b]) {
                let slot = lanes.order.slot(particle);
                (position[0][i], position[1][i], position[2][i]) = lanes.position.get(slot).into();
                (previous[0][i], previous[1][i], previous[2][i]) = lanes.previous.get(slot).into();
                inverse_mass[i] = lanes.inverse_mass(slot);
            }
        }
        let [a, b] = &ends;
        let moved = solve_abreast::<_, _, DAMPED>(simd, end(simd, a), end(simd, b), lane(simd, &rest), constants);
        for (at, end) in moved.into_iter().zip(&mut ends) {
            at.store(&mut end.0);
        }
        for (i, spring) in springs.iter().enumerate() {
            for (([x, y, z], ..), particle) in ends.iter().zip([spring.a, spring.b]) {
                lanes.position.set(lanes.order.slot(particle), Vec3A::new(x[i], y[i], z[i]));
            }
        }
    }
}

#[inline(always)]
fn end<S: Simd>(simd: S, (position, previous, inverse_mass): &(Block, Block, Lane)) -> End<f32x8<S>> {
    End {
        position: Vec3x8::load(simd, position),
        previous: Vec3x8::load(simd, previous),
        inverse_mass: lane(simd, inverse_mass),
    }
}

/// Springs of one batch share no particle, so any eight of them may be solved side by side.
#[inline(always)]
fn solve_batch<S: Simd, const DAMPED: bool>(simd: S, beads: &mut Beads, springs: &[Spring], constants: Scaled) {
    let (groups, rest) = springs.as_chunks::<LANES>();
    for springs in groups {
        solve_gathered::<S, DAMPED>(simd, beads, springs, constants);
    }
    if !rest.is_empty() {
        let nobody = beads.now.len() as u32 - 1;
        let mut springs = [Spring { a: nobody, b: nobody, ..Spring::default() }; LANES];
        springs[..rest.len()].copy_from_slice(rest);
        solve_gathered::<S, DAMPED>(simd, beads, &springs, constants);
    }
}

#[inline(always)]
fn solve_gathered<S: Simd, const DAMPED: bool>(
    simd: S,
    beads: &mut Beads,
    springs: &[Spring; LANES],
    constants: Scaled,
) {
    let [s0, s1, s2, s3, s4, s5, s6, s7] = springs;
    let a = [s0.a, s1.a, s2.a, s3.a, s4.a, s5.a, s6.a, s7.a];
    let b = [s0.b, s1.b, s2.b, s3.b, s4.b, s5.b, s6.b, s7.b];
    let rest = [s0.rest, s1.rest, s2.rest, s3.rest, s4.rest, s5.rest, s6.rest, s7.rest];
    let (end_a, end_b) = (beads.end::<S, DAMPED>(simd, &a), beads.end::<S, DAMPED>(simd, &b));
    let [at_a, at_b] = solve_abreast::<_, _, DAMPED>(simd, end_a, end_b, lane(simd, &rest), constants);
    beads.put(&a, at_a, end_a.inverse_mass);
    beads.put(&b, at_b, end_b.inverse_mass);
}

/// Strain of a spring: length over rest length, less one. Positive when stretched.
pub fn strain(position: &[Vec3A], spring: &Spring) -> f32 {
    position[spring.a as usize].distance(position[spring.b as usize]) / spring.rest - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::{Elasticity, Particles, order::Order};

    fn pair(distance: f32) -> (Lanes, Topology) {
        let mut lanes = Lanes::default();
        let particles = Particles {
            position: vec![Vec3A::ZERO, Vec3A::X * distance],
            velocity: vec![Vec3A::ZERO; 2],
            inverse_mass: vec![0.0, 2.0],
            force: vec![Vec3A::ZERO; 2],
        };
        lanes.load(&particles, Order::plain(2), Instructions::Best);
        lanes.previous = lanes.position.clone();
        let topology = Topology {
            springs: vec![Spring { a: 0, b: 1, rest: 1.0, ..Spring::default() }],
            batches: vec![SpringBatch { kind: SpringKind::Structural, range: 0..1, woven: false, carries: false }],
            areas: vec![1.0; 2],
            ..Default::default()
        };
        (lanes, topology)
    }

    fn solve_once(lanes: &mut Lanes, topology: &Topology, stiffness: f32, damping: f32) {
        let mut springs = [SpringConstants::default(); 3];
        springs[0] = SpringConstants { stiffness, damping };
        let material = Material::bare(1.0, Elasticity::Springs(springs));
        solve(
            lanes,
            topology,
            topology.batches.iter(),
            &material,
            0.1,
            &mut Beads::default(),
            None,
            Instructions::Best,
        );
    }

    #[test]
    fn a_spring_moves_by_the_implicit_euler_answer() {
        let (mut lanes, topology) = pair(1.5);
        solve_once(&mut lanes, &topology, 100.0, 3.0);
        // Implicit Euler for m = 0.5 kg: m Δx = h² (-k (s + Δx) - c Δx / h), with the stretch s = 0.5 m.
        let expected = -100.0 * 0.01 * 0.5 / (0.5 + 100.0 * 0.01 + 3.0 * 0.1);
        assert!((lanes.position.get(1).x - 1.5 - expected).abs() < 1e-6);
        assert_eq!(lanes.position.get(0), Vec3A::ZERO);
    }

    #[test]
    fn springs_without_stiffness_or_length_stay_finite() {
        let (mut lanes, topology) = pair(0.0);
        solve_once(&mut lanes, &topology, 0.0, 0.0);
        solve_once(&mut lanes, &topology, 1e9, 1e9);
        assert!(lanes.position.get(1).is_finite());
    }
}
