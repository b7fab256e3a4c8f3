//! Bending along strands, each strand solved exactly.
//!
//! ```text
//!   x0 --- x1 --- x2 --- x3 --- ...       Dj = pj x(j-1) - (pj + qj) xj + qj x(j+1)
//! ```
//!
//! A strand of a sheet resists bending with the energy B/2 |Dj - rj|² at each of its inner nodes, the weights p and q being
//! such that Dj is the curvature times the root of the area that the node stands for, and rj its rest. It is linear in the
//! positions: Bergou et al., "A Quadratic Bending Model for Inextensible Surfaces" (2006). In XPBD's form (see
//! [`spring`](crate::constraint::unstructured::spring)), with κ = B h² and a vector lambda for each node:
//!
//! (κ D W Dᵀ + 1) lambda = -κ (D x - r)
//!
//! Two bends of a strand have particles in common if they are no more than two nodes apart, so the matrix has five
//! diagonals, and Cholesky's L D Lᵀ solves it in one pass there and one back; L and D are the same in all substeps. Sweeping over the bends instead leaves a
//! cloth too soft whose nodes move by more than they are apart: the more, the finer the mesh.

use fearless_simd::{f32x8, prelude::*};

use crate::{
    constraint::strand::{
        law::Scaled,
        tridiagonal::{EliminationRows, StrandLanes},
    },
    layout::{
        points::Block,
        simd::{Lane, Vec3x8, lane},
    },
};

/// The bends of strands side by side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StrandBends<'a> {
    /// Weights p and q at each node, 1/m times m: zero where nothing bends, as at the ends.
    pub weights: &'a [[Lane; 2]],
    /// What D is at rest, m; empty where the cloth is flat.
    pub rest: &'a [Block],
    /// The matrix.
    pub factors: &'a [Factor],
    /// B h² and its damping, kg m².
    pub rigidity: Scaled,
}

/// One row of L and D: the entries of L one and two places below the diagonal, and -κ/D. None of them changes from substep
/// to substep.
pub(crate) type Factor = [Lane; 3];

/// Takes the matrix of the bends of strands apart. They have `count` nodes with inverse masses, 1/kg.
#[inline(always)]
pub(crate) fn factorize<S: Simd>(
    simd: S,
    count: usize,
    inverse_mass: &[Lane],
    weights: &[[Lane; 2]],
    rigidity: Scaled,
    factors: &mut [Factor],
) {
    let total = rigidity.k + rigidity.c;
    let (none, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
    // Of the two nodes before.
    let (mut q_2, mut sum_1, mut q_1) = (none, none, none);
    let (mut inverse_2, mut inverse_1, mut lower_1) = (none, none, none);
    for j in 1..count - 1 {
        let w_before = lane(simd, &inverse_mass[j - 1]);
        let w_here = lane(simd, &inverse_mass[j]);
        let w_after = lane(simd, &inverse_mass[j + 1]);
        let [p, q] = [lane(simd, &weights[j][0]), lane(simd, &weights[j][1])];
        let sum = p + q;
        let diagonal = (p * p * w_before + sum * sum * w_here + q * q * w_after) * total + one;
        let next_but_one = (w_before * q_2 * p) * total;
        let next = (w_before * sum_1 * p + w_here * q_1 * sum) * -total - next_but_one * lower_1;
        let (lower_2, lower) = (next_but_one * inverse_2, next * inverse_1);
        // Never below one but by rounding.
        let pivot = diagonal - lower_2 * next_but_one - lower * next;
        let inverse = one / pivot.max(one);
        factors[j] = [lower.into(), lower_2.into(), (inverse * -rigidity.k).into()];
        (q_2, sum_1, q_1) = (q_1, sum, q);
        (inverse_2, inverse_1, lower_1) = (inverse_1, inverse, lower);
    }
}

impl StrandLanes<'_> {
    /// Solves the bends of all inner nodes of one pack of strands with `count` nodes.
    #[inline(always)]
    pub fn solve_curvature<S: Simd, const DAMPED: bool, const CURVED: bool>(
        &mut self,
        simd: S,
        count: usize,
        bends: StrandBends,
        rows: &mut EliminationRows,
    ) {
        if count > 2 {
            self.eliminate_bends::<S, DAMPED, CURVED>(simd, count, bends, rows);
            self.substitute_bends(simd, count, bends, rows);
        }
    }

    #[inline(always)]
    fn eliminate_bends<S: Simd, const DAMPED: bool, const CURVED: bool>(
        &self,
        simd: S,
        count: usize,
        StrandBends { weights, rest, factors, rigidity }: StrandBends,
        rows: &mut EliminationRows,
    ) {
        let damping = f32x8::splat(simd, rigidity.c / rigidity.k);
        let mut here = self.end::<S, f32x8<S>, DAMPED>(simd, 1);
        let first = self.end::<S, f32x8<S>, DAMPED>(simd, 0);
        // From the node before, now and before the substep.
        let (mut way, mut old_way) = (here.position - first.position, here.previous - first.previous);
        let nothing = Vec3x8::splat(simd, [0.0; 3]);
        // Of the two nodes before: the right side over -κ.
        let (mut right_2, mut right_1) = (nothing, nothing);
        for j in 1..count - 1 {
            let after = self.end::<S, f32x8<S>, DAMPED>(simd, j + 1);
            let (next_way, next_old_way) = (after.position - here.position, after.previous - here.previous);
            let [p, q] = [lane(simd, &weights[j][0]), lane(simd, &weights[j][1])];
            let bend = next_way * q - way * p;
            let mut right = bend;
            if CURVED {
                right = right - Vec3x8::load(simd, &rest[j]);
            }
            if DAMPED {
                right = right + (bend - (next_old_way * q - old_way * p)) * damping;
            }
            let lower = lane(simd, &factors[j][0]);
            let lower_2 = lane(simd, &factors[j][1]);
            right = right - right_1 * lower - right_2 * lower_2;
            right.store(&mut rows.bends[j]);
            (here, way, old_way) = (after, next_way, next_old_way);
            (right_2, right_1) = (right_1, right);
        }
    }

    /// From the last bend back to the first. Each node moves when the bends around it are known.
    #[inline(always)]
    fn substitute_bends<S: Simd>(
        &mut self,
        simd: S,
        count: usize,
        StrandBends { weights, factors, .. }: StrandBends,
        rows: &EliminationRows,
    ) {
        let none = f32x8::splat(simd, 0.0);
        let nothing = Vec3x8::splat(simd, [0.0; 3]);
        // Of the two nodes after: lambda, and the entries below the diagonal that still count.
        let (mut lambda_1, mut lambda_2) = (nothing, nothing);
        let (mut lower_1, mut lower_2, mut lower_2_of_1) = (none, none, none);
        // What the bend of the node after does to the way there, and what all do to the way from there on.
        let (mut pull_back, mut pull_after) = (nothing, nothing);
        for j in (1..count - 1).rev() {
            let [p, q] = [lane(simd, &weights[j][0]), lane(simd, &weights[j][1])];
            let inverse = lane(simd, &factors[j][2]);
            let right = Vec3x8::load(simd, &rows.bends[j]);
            let lambda = right * inverse - lambda_1 * lower_1 - lambda_2 * lower_2;
            let pull = lambda * q - pull_back;
            self.shift(simd, j + 1, pull - pull_after);
            (pull_back, pull_after) = (lambda * p, pull);
            (lambda_2, lambda_1) = (lambda_1, lambda);
            (lower_2, lower_2_of_1) = (lower_2_of_1, lane(simd, &factors[j][1]));
            lower_1 = lane(simd, &factors[j][0]);
        }
        self.shift(simd, 1, nothing - pull_back - pull_after);
        self.shift(simd, 0, pull_back);
    }

    /// Moves nodes by an impulse over h, kg m.
    #[inline(always)]
    fn shift<S: Simd>(&mut self, simd: S, j: usize, by: Vec3x8<S>) {
        let w = lane(simd, &self.inverse_mass[j]);
        let place = Vec3x8::load(simd, &self.position[j]) + by * w;
        place.store(&mut self.position[j]);
    }
}

#[cfg(test)]
mod tests {
    use bevy_math::{DVec3, Vec3A};
    use fastrand::Rng;
    use fearless_simd::dispatch;
    use proptest::prelude::*;

    use super::*;
    use crate::{
        constraint::strand::dense,
        layout::simd::{LANES, SimdLevel},
    };

    /// Strands side by side.
    struct Strands {
        position: Vec<Block>,
        previous: Vec<Block>,
        inverse_mass: Vec<Lane>,
        weights: Vec<[Lane; 2]>,
        rest: Vec<Block>,
    }

    impl Strands {
        /// Strands of which some nodes are fixed, and some don't bend.
        fn new(count: usize, curved: bool, rng: &mut Rng) -> Self {
            let mut strands = Self {
                position: vec![Block::default(); count],
                previous: vec![Block::default(); count],
                inverse_mass: vec![Lane::default(); count],
                weights: vec![Default::default(); count],
                rest: vec![Block::default(); if curved { count } else { 0 }],
            };
            for (j, lane) in (0..count).flat_map(|j| (0..LANES).map(move |lane| (j, lane))) {
                for axis in 0..3 {
                    strands.position[j][axis][lane] = rng.f32() + if axis == 0 { j as f32 } else { 0.0 };
                    strands.previous[j][axis][lane] = strands.position[j][axis][lane] + 0.1 * rng.f32();
                    if curved {
                        strands.rest[j][axis][lane] = rng.f32() - 0.5;
                    }
                }
                strands.inverse_mass[j][lane] = if rng.u32(0..5) == 0 { 0.0 } else { 0.2 + 2.0 * rng.f32() };
                if j > 0 && j + 1 < count && rng.u32(0..6) > 0 {
                    strands.weights[j].iter_mut().for_each(|weights| weights[lane] = 0.5 + rng.f32());
                }
            }
            strands
        }

        fn places(blocks: &[Block], lane: usize) -> Vec<DVec3> {
            blocks.iter().map(|[x, y, z]| Vec3A::new(x[lane], y[lane], z[lane]).as_dvec3()).collect()
        }

        /// Where the nodes of one of them are to be, from (κ D W Dᵀ + 1) lambda = -κ (D x - r).
        fn expected(&self, lane: usize, rigidity: Scaled) -> Vec<DVec3> {
            let count = self.position.len();
            let [position, previous, rest] =
                [&self.position, &self.previous, &self.rest].map(|b| Self::places(b, lane));
            let mass = |j: usize| f64::from(self.inverse_mass[j][lane]);
            let [k, c] = [rigidity.k, rigidity.c].map(f64::from);
            // The row of D of each node: with nothing where nothing bends.
            let bend = |j: usize, node: usize| {
                let [p, q] = self.weights[j].map(|weights| f64::from(weights[lane]));
                match node + 1 {
                    at if at == j => p,
                    at if at == j + 1 => -(p + q),
                    at if at == j + 2 => q,
                    _ => 0.0,
                }
            };
            let inner = 1..count - 1;
            let row = |i: usize| {
                let entry = |j: usize| {
                    let sum: f64 = (0..count).map(|node| bend(i, node) * mass(node) * bend(j, node)).sum();
                    (k + c) * sum + f64::from(u8::from(i == j))
                };
                inner.clone().map(entry).collect()
            };
            let right = |j: usize| {
                let sum = |at: &[DVec3]| (0..count).map(|node| at[node] * bend(j, node)).sum::<DVec3>();
                let at_rest = rest.get(j).copied().unwrap_or(DVec3::ZERO);
                (sum(&position) - at_rest) * -k - (sum(&position) - sum(&previous)) * c
            };
            let lambda = dense::solve(inner.clone().map(row).collect(), inner.clone().map(right).collect());
            let pull =
                |node: usize| inner.clone().zip(&lambda).map(|(j, &lambda)| lambda * bend(j, node)).sum::<DVec3>();
            (0..count).map(|node| position[node] + pull(node) * mass(node)).collect()
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn bends_of_a_strand_are_solved_as_by_their_whole_matrix(
            seed in any::<u64>(),
            count in 3_usize..24,
            stiffness in prop_oneof![Just(0.001_f32), 0.01_f32..10.0],
            damping in prop_oneof![Just(0.0_f32), 0.01_f32..1.0],
            curved in any::<bool>(),
            simd_level in prop_oneof![Just(SimdLevel::Best), Just(SimdLevel::Baseline)],
        ) {
            let mut strands = Strands::new(count, curved, &mut Rng::with_seed(seed));
            let rigidity = Scaled { k: stiffness, c: damping };
            let expected: Vec<_> = (0..LANES).map(|lane| strands.expected(lane, rigidity)).collect();
            let mut rows = EliminationRows::default();
            rows.make_room(count);
            let mut factors = vec![Factor::default(); count];
            let Strands { position, previous, inverse_mass, weights, rest } = &mut strands;
            dispatch!(simd_level.level(), simd => {
                factorize(simd, count, inverse_mass, weights, rigidity, &mut factors);
            });
            let bends = StrandBends { weights, rest, factors: &factors, rigidity };
            let mut pack = StrandLanes { position, previous, inverse_mass, stride: count };
            match (damping > 0.0, curved) {
                (false, false) => dispatch!(simd_level.level(), simd =>
                    pack.solve_curvature::<_, false, false>(simd, count, bends, &mut rows)),
                (false, true) => dispatch!(simd_level.level(), simd =>
                    pack.solve_curvature::<_, false, true>(simd, count, bends, &mut rows)),
                (true, false) => dispatch!(simd_level.level(), simd =>
                    pack.solve_curvature::<_, true, false>(simd, count, bends, &mut rows)),
                (true, true) => dispatch!(simd_level.level(), simd =>
                    pack.solve_curvature::<_, true, true>(simd, count, bends, &mut rows)),
            }
            for (lane, expected) in expected.iter().enumerate() {
                for (found, expected) in Strands::places(&strands.position, lane).iter().zip(expected) {
                    prop_assert!(found.distance(*expected) < 5e-3, "strand {lane}: {found} for {expected}");
                }
            }
        }
    }
}
