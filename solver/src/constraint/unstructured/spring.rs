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

use bevy_math::Vec3A;
use fearless_simd::{dispatch, f32x8, prelude::*};

use crate::{
    constraint::strand::law::{DirectionModuli, GatherLaws, Scaled, WideSpringLaw},
    layout::{
        points::Block,
        simd::{LANES, Lane, SHORTEST, SimdLevel, Vec3Wide, Vec3x8, Wide, lane},
    },
    material::{Elasticity, Material},
    particles::{
        gathered::{End, GatheredParticles},
        lanes::Lanes,
    },
    topology::{Spring, SpringBatch, SpringKind},
};

/// Solves springs side by side that share no particle, and returns where their ends are moved to. A spring with a rest
/// length of zero isn't there.
#[inline(always)]
pub(crate) fn solve_abreast<S: Simd, F: Wide<S>, const DAMPED: bool>(
    simd: S,
    a: End<F>,
    b: End<F>,
    rest: F,
    law: impl WideSpringLaw<S, F>,
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

/// What the springs of one batch follow.
#[derive(Clone, Copy, Debug)]
pub(crate) enum BatchLaw {
    /// All are alike.
    Alike(Scaled),
    /// Each has its share of a sheet.
    Sheet([DirectionModuli; 2]),
}

impl BatchLaw {
    /// None where they do nothing.
    pub fn new(material: &Material, batch: &SpringBatch, h: f32) -> Option<Self> {
        match &material.elasticity {
            Elasticity::Springs(constants) => {
                Some(Scaled::new(constants[batch.kind.index()], h)).filter(Scaled::acts).map(Self::Alike)
            }
            Elasticity::Moduli(moduli) => batch.carries.then(|| {
                let gradings = DirectionModuli::both(moduli, h);
                let is_structural = batch.kind == SpringKind::Structural;
                Self::Sheet(if is_structural { gradings } else { gradings.map(DirectionModuli::linear) })
            }),
        }
    }

    /// Whether it needs to know where the particles were before the substep.
    pub fn is_damped(&self) -> bool {
        match self {
            Self::Alike(constants) => constants.c > 0.0,
            Self::Sheet([warp, _]) => warp.damping > 0.0,
        }
    }
}

/// Solves the springs of one batch once.
pub(crate) fn solve(gathered: &mut GatheredParticles, springs: &[Spring], law: BatchLaw, simd_level: SimdLevel) {
    let level = simd_level.level();
    match (law, law.is_damped()) {
        (BatchLaw::Alike(law), false) => {
            dispatch!(level, simd => solve_batch::<_, _, false>(simd, gathered, springs, law))
        }
        (BatchLaw::Alike(law), true) => {
            dispatch!(level, simd => solve_batch::<_, _, true>(simd, gathered, springs, law))
        }
        (BatchLaw::Sheet(law), false) => {
            dispatch!(level, simd => solve_batch::<_, _, false>(simd, gathered, springs, law))
        }
        (BatchLaw::Sheet(law), true) => {
            dispatch!(level, simd => solve_batch::<_, _, true>(simd, gathered, springs, law))
        }
    }
}

/// The same for springs that are few among many particles, as along the seam of a tube: the particles stay where they
/// are.
pub(crate) fn solve_few(lanes: &mut Lanes, springs: &[Spring], law: BatchLaw, simd_level: SimdLevel) {
    let level = simd_level.level();
    match law {
        BatchLaw::Alike(law) => dispatch!(level, simd => solve_scattered(simd, lanes, springs, law)),
        BatchLaw::Sheet(law) => dispatch!(level, simd => solve_scattered(simd, lanes, springs, law)),
    }
}

#[inline(always)]
fn solve_scattered<S: Simd>(simd: S, lanes: &mut Lanes, springs: &[Spring], laws: impl GatherLaws) {
    for springs in springs.chunks(LANES) {
        let mut ends = [(Block::default(), Block::default(), Lane::default()); 2];
        let (mut rest, mut eight) = (Lane::default(), [Spring::default(); LANES]);
        eight[..springs.len()].copy_from_slice(springs);
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
        let law = laws.law(simd, &eight);
        let moved = solve_abreast::<_, _, true>(simd, end(simd, a), end(simd, b), lane(simd, &rest), law);
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
fn solve_batch<S: Simd, L: GatherLaws, const DAMPED: bool>(
    simd: S,
    gathered: &mut GatheredParticles,
    springs: &[Spring],
    laws: L,
) {
    let (groups, rest) = springs.as_chunks::<LANES>();
    for springs in groups {
        solve_gathered::<S, L, DAMPED>(simd, gathered, springs, laws);
    }
    if !rest.is_empty() {
        let dummy = gathered.dummy();
        let mut springs = [Spring { a: dummy, b: dummy, ..Spring::default() }; LANES];
        springs[..rest.len()].copy_from_slice(rest);
        solve_gathered::<S, L, DAMPED>(simd, gathered, &springs, laws);
    }
}

#[inline(always)]
fn solve_gathered<S: Simd, L: GatherLaws, const DAMPED: bool>(
    simd: S,
    gathered: &mut GatheredParticles,
    springs: &[Spring; LANES],
    laws: L,
) {
    let [s0, s1, s2, s3, s4, s5, s6, s7] = springs;
    let a = [s0.a, s1.a, s2.a, s3.a, s4.a, s5.a, s6.a, s7.a];
    let b = [s0.b, s1.b, s2.b, s3.b, s4.b, s5.b, s6.b, s7.b];
    let rest = [s0.rest, s1.rest, s2.rest, s3.rest, s4.rest, s5.rest, s6.rest, s7.rest];
    let (end_a, end_b) = (gathered.end::<S, DAMPED>(simd, &a), gathered.end::<S, DAMPED>(simd, &b));
    let law = laws.law(simd, springs);
    let [at_a, at_b] = solve_abreast::<_, _, DAMPED>(simd, end_a, end_b, lane(simd, &rest), law);
    gathered.put(&a, at_a, end_a.inverse_mass);
    gathered.put(&b, at_b, end_b.inverse_mass);
}

/// Strain of a spring: length over rest length, less one. Positive when stretched.
pub fn strain(position: &[Vec3A], spring: &Spring) -> f32 {
    position[spring.a as usize].distance(position[spring.b as usize]) / spring.rest - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{layout::order::Order, material::SpringConstants, particles::Particles};

    fn pair(distance: f32) -> Lanes {
        let mut lanes = Lanes::default();
        let particles = Particles {
            position: vec![Vec3A::ZERO, Vec3A::X * distance],
            velocity: vec![Vec3A::ZERO; 2],
            inverse_mass: vec![0.0, 2.0],
            force: vec![Vec3A::ZERO; 2],
            contact_load: Default::default(),
        };
        lanes.load(&particles, Order::plain(2), SimdLevel::Best);
        lanes.previous = lanes.position.clone();
        lanes
    }

    fn solve_once(lanes: &mut Lanes, stiffness: f32, damping: f32) {
        let springs = [Spring { a: 0, b: 1, rest: 1.0, ..Spring::default() }];
        let constants = BatchLaw::Alike(Scaled::new(SpringConstants { stiffness, damping }, 0.1));
        let few = &mut lanes.clone();
        solve_few(few, &springs, constants, SimdLevel::Best);
        let mut gathered = GatheredParticles::default();
        gathered.read(lanes, damping > 0.0, SimdLevel::Best);
        solve(&mut gathered, &springs, constants, SimdLevel::Best);
        gathered.write(lanes, SimdLevel::Best);
        assert_eq!(
            few.position.get(1).to_array().map(f32::to_bits),
            lanes.position.get(1).to_array().map(f32::to_bits)
        );
    }

    #[test]
    fn a_spring_moves_by_the_implicit_euler_answer() {
        let mut lanes = pair(1.5);
        solve_once(&mut lanes, 100.0, 3.0);
        // Implicit Euler for m = 0.5 kg: m Δx = h² (-k (s + Δx) - c Δx / h), with the stretch s = 0.5 m.
        let expected = -100.0 * 0.01 * 0.5 / (0.5 + 100.0 * 0.01 + 3.0 * 0.1);
        assert!((lanes.position.get(1).x - 1.5 - expected).abs() < 1e-6);
        assert_eq!(lanes.position.get(0), Vec3A::ZERO);
    }

    #[test]
    fn springs_without_stiffness_or_length_stay_finite() {
        let mut lanes = pair(0.0);
        solve_once(&mut lanes, 0.0, 0.0);
        solve_once(&mut lanes, 1e9, 1e9);
        assert!(lanes.position.get(1).is_finite());
    }
}
