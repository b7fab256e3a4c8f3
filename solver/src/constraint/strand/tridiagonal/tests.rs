//! Strands against their whole matrix.

use bevy_math::{DVec3, Vec3A};
use fastrand::Rng;
use fearless_simd::{dispatch, f32x8, f32x16};
use proptest::prelude::*;

use super::*;
use crate::{
    constraint::strand::{dense::Strand, law::TensionOnly},
    layout::simd::{LANES, SimdLevel},
};

/// Strands side by side, in two packs.
struct Strands {
    count: usize,
    position: Vec<Block>,
    previous: Vec<Block>,
    inverse_mass: Vec<Lane>,
    rest: Vec<Lane>,
}

impl Strands {
    /// Strands with steps of about a metre, of which some nodes are fixed and some springs missing, unless they are to be
    /// `taut`.
    fn new(count: usize, taut: bool, rng: &mut Rng) -> Self {
        let all = 2 * count;
        let mut strands = Self {
            count,
            position: vec![Block::default(); all],
            previous: vec![Block::default(); all],
            inverse_mass: vec![Lane::default(); all],
            rest: vec![Lane::default(); all],
        };
        for (at, lane) in (0..all).flat_map(|at| (0..LANES).map(move |lane| (at, lane))) {
            // Around an arc, so that rings close.
            let mut noise = || rng.f32() - 0.5;
            let along = (at % count) as f32 / count as f32;
            let place = [count as f32 * along * (1.0 - along), along * count as f32 * (0.5 - along), 0.0];
            for (axis, place) in place.into_iter().enumerate() {
                strands.position[at][axis][lane] = place + noise();
                strands.previous[at][axis][lane] = strands.position[at][axis][lane] + 0.1 * noise();
            }
            strands.inverse_mass[at][lane] = if rng.u32(0..5) == 0 { 0.0 } else { 0.2 + 2.0 * rng.f32() };
            let is_there = taut || rng.u32(0..8) > 0;
            strands.rest[at][lane] = match (is_there, taut) {
                (false, _) => 0.0,
                (true, false) => 0.5 + rng.f32(),
                (true, true) => 0.01,
            };
        }
        strands
    }

    /// One of them, with all springs alike.
    fn strand(&self, number: usize, closed: bool, spring: Scaled) -> Strand {
        let (nodes, lane) = (number / LANES * self.count..(number / LANES + 1) * self.count, number % LANES);
        let places = |blocks: &[Block]| -> Vec<DVec3> {
            blocks[nodes.clone()].iter().map(|[x, y, z]| Vec3A::new(x[lane], y[lane], z[lane]).as_dvec3()).collect()
        };
        let numbers = |lanes: &[Lane], count: usize| -> Vec<f64> {
            lanes[nodes.clone()][..count].iter().map(|lanes| f64::from(lanes[lane])).collect()
        };
        let springs = if closed { self.count } else { self.count - 1 };
        Strand {
            position: places(&self.position),
            previous: places(&self.previous),
            inverse_mass: numbers(&self.inverse_mass, self.count),
            rest: numbers(&self.rest, springs),
            constants: vec![[spring.k.into(), spring.c.into()]; springs],
        }
    }

    /// Solves them, those of both packs at once or of the first one alone.
    fn solve(&mut self, laws: Given, both: bool, closed: bool, simd_level: SimdLevel) {
        let mut rows = EliminationRows::default();
        rows.make_room(2 * self.count);
        let Self { count, position, previous, inverse_mass, rest } = self;
        let mut pack = StrandLanes { position, previous, inverse_mass, stride: *count };
        macro_rules! solve {
            ($laws:expr, $damped:literal) => {{
                let springs = StrandSprings { rest, laws: $laws };
                match (both, closed) {
                    (true, true) => dispatch!(simd_level.level(), simd =>
                        pack.solve::<_, f32x16<_>, _, $damped, true>(simd, *count, springs, &mut rows)),
                    (true, false) => dispatch!(simd_level.level(), simd =>
                        pack.solve::<_, f32x16<_>, _, $damped, false>(simd, *count, springs, &mut rows)),
                    (false, true) => dispatch!(simd_level.level(), simd =>
                        pack.solve::<_, f32x8<_>, _, $damped, true>(simd, *count, springs, &mut rows)),
                    (false, false) => dispatch!(simd_level.level(), simd =>
                        pack.solve::<_, f32x8<_>, _, $damped, false>(simd, *count, springs, &mut rows)),
                }
            }};
        }
        match laws {
            Given::Damped(spring) => solve!(spring, true),
            Given::Bare(spring) => solve!(spring, false),
            Given::TensionOnly(pull) => solve!(pull, false),
        }
    }
}

#[derive(Clone, Copy)]
enum Given {
    Damped(Scaled),
    Bare(Scaled),
    TensionOnly(TensionOnly),
}

/// How far off places are, as a share of the longest way to where they are expected, or m where that is shorter than one.
fn error(found: &[DVec3], expected: &[DVec3], before: &Strand) -> f64 {
    let farthest = |places: &[DVec3]| places.iter().zip(expected).map(|(p, q)| p.distance(*q)).fold(0.0, f64::max);
    farthest(found) / farthest(&before.position).max(1.0)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_strand_is_solved_as_by_its_whole_matrix(
        seed in any::<u64>(),
        count in 3_usize..24,
        stiffness in prop_oneof![Just(0.01_f32), 0.1_f32..10.0, Just(100.0)],
        damping in prop_oneof![Just(0.0_f32), 0.1_f32..1.0],
        both in any::<bool>(),
        closed in any::<bool>(),
        simd_level in prop_oneof![Just(SimdLevel::Best), Just(SimdLevel::Baseline)],
    ) {
        let mut strands = Strands::new(count, false, &mut Rng::with_seed(seed));
        let spring = Scaled { k: stiffness, c: damping };
        let law = if damping > 0.0 { Given::Damped(spring) } else { Given::Bare(spring) };
        let all = if both { 2 * LANES } else { LANES };
        let before: Vec<Strand> = (0..all).map(|i| strands.strand(i, closed, spring)).collect();
        strands.solve(law, both, closed, simd_level);
        for (i, before) in before.into_iter().enumerate() {
            let off = error(&strands.strand(i, closed, spring).position, &before.solved(), &before);
            prop_assert!(off < 5e-3, "strand {i}: {off}");
        }
    }

    #[test]
    fn a_strand_that_only_pulls_is_solved_as_by_its_whole_matrix(
        seed in any::<u64>(),
        count in 3_usize..24,
        stiffness in 0.1_f32..100.0,
        rest_scale in 1.0_f32..1.5,
        closed in any::<bool>(),
    ) {
        let mut strands = Strands::new(count, true, &mut Rng::with_seed(seed));
        let spring = Scaled { k: stiffness, c: 0.0 };
        let before: Vec<Strand> = (0..2 * LANES)
            .map(|i| {
                let mut strand = strands.strand(i, closed, spring);
                strand.rest.iter_mut().for_each(|rest| *rest *= f64::from(rest_scale));
                strand
            })
            .collect();
        strands.solve(Given::TensionOnly(TensionOnly { spring, rest_scale }), true, closed, SimdLevel::Best);
        for (i, before) in before.into_iter().enumerate() {
            let pushes = before.pushes();
            // What would push is left out, and what isn't too long to begin with: that is another system.
            let all_pull = pushes.iter().all(|&push| push < 0.0);
            if all_pull && (0..pushes.len()).all(|j| before.is_too_long(j)) {
                let off = error(&strands.strand(i, closed, spring).position, &before.pushed(&pushes), &before);
                prop_assert!(off < 5e-3, "strand {i}: {off}");
            }
        }
    }
}
