//! Bending along threads, each thread solved exactly.
//!
//! ```text
//!   x0 --- x1 --- x2 --- x3 --- ...       Dj = pj x(j-1) - (pj + qj) xj + qj x(j+1)
//! ```
//!
//! A thread of a sheet resists bending with the energy B/2 |Dj - rj|² at each of its inner nodes, the weights p and q being
//! such that Dj is the curvature times the root of the area that the node stands for, and rj its rest. It is linear in the
//! positions: Bergou et al., "A Quadratic Bending Model for Inextensible Surfaces" (2006). In XPBD's form (see
//! [`spring`](super::spring)), with κ = B h² and a vector lambda for each node:
//!
//! (κ D W Dᵀ + 1) lambda = -κ (D x - r)
//!
//! Two bends of a thread have particles in common if they are no more than two nodes apart, so the matrix has five
//! diagonals, and Cholesky's L D Lᵀ solves it in one pass there and one back. Sweeping over the bends instead leaves a
//! cloth too soft whose nodes move by more than they are apart: the more, the finer the mesh.

use fearless_simd::prelude::*;

use super::{
    law::Scaled,
    strand::{Pack, Rows},
};
use crate::solver::{
    lanes::Block,
    simd::{Lane, Vec3Wide, Wide},
};

/// The bends of threads side by side.
#[derive(Clone, Copy, Debug)]
pub(in crate::solver) struct Bends<'a> {
    /// Weights p and q at each node, 1/m times m: zero where nothing bends, as at the ends.
    pub weights: &'a [[Lane; 2]],
    /// What D is at rest, m; empty where the cloth is flat.
    pub rest: &'a [Block],
    /// B h² and its damping, kg m².
    pub rigidity: Scaled,
}

/// One node and its weights, the third being the sum of the others.
#[derive(Clone, Copy)]
struct Node<F> {
    p: F,
    q: F,
    sum: F,
}

impl<F> Node<F> {
    #[inline(always)]
    fn load<S: Simd>(simd: S, weights: &[[Lane; 2]], j: usize, stride: usize) -> Self
    where
        F: Wide<S>,
    {
        let lanes = weights.as_flattened();
        let (p, q) = (F::load(simd, lanes, 2 * j, 2 * stride), F::load(simd, lanes, 2 * j + 1, 2 * stride));
        Self { p, q, sum: p + q }
    }
}

impl Pack<'_> {
    /// Solves the bends of all inner nodes of threads with `count` nodes.
    #[inline(always)]
    pub fn solve_curvature<S: Simd, F: Wide<S>, const DAMPED: bool, const CURVED: bool>(
        &mut self,
        simd: S,
        count: usize,
        bends: Bends,
        rows: &mut Rows,
    ) {
        if count > 2 {
            self.eliminate_bends::<S, F, DAMPED, CURVED>(simd, count, bends, rows);
            self.substitute_bends::<S, F>(simd, count, bends, rows);
        }
    }

    #[inline(always)]
    fn eliminate_bends<S: Simd, F: Wide<S>, const DAMPED: bool, const CURVED: bool>(
        &self,
        simd: S,
        count: usize,
        Bends { weights, rest, rigidity }: Bends,
        rows: &mut Rows,
    ) {
        let stride = self.stride;
        let (none, one) = (F::splat(simd, 0.0), F::splat(simd, 1.0));
        let nothing = Vec3Wide::splat(simd, [0.0; 3]);
        let total = rigidity.k + rigidity.c;
        let place = |j: usize| Vec3Wide::load_at(simd, self.position, j, stride);
        let mass = |j: usize| F::load(simd, self.inverse_mass, j, stride);
        let (mut before, mut here) = (place(0), place(1));
        let (mut w_before, mut w_here) = (mass(0), mass(1));
        // Of the two nodes before.
        let (mut node_2, mut node_1) = (Node { p: none, q: none, sum: none }, Node { p: none, q: none, sum: none });
        let (mut inverse_2, mut inverse_1, mut lower_1) = (none, none, none);
        let (mut right_2, mut right_1) = (nothing, nothing);
        for j in 1..count - 1 {
            let (after, w_after) = (place(j + 1), mass(j + 1));
            let node = Node::<F>::load(simd, weights, j, stride);
            let Node { p, q, sum } = node;
            let mut bend = before * p - here * sum + after * q;
            if CURVED {
                bend = bend - Vec3Wide::load_at(simd, rest, j, stride);
            }
            let mut right = bend * F::splat(simd, -rigidity.k);
            if DAMPED {
                let was = |j: usize| Vec3Wide::load_at(simd, self.previous, j, stride);
                let way = (before - was(j - 1)) * p - (here - was(j)) * sum + (after - was(j + 1)) * q;
                right = right - way * F::splat(simd, rigidity.c);
            }
            let diagonal = (p * p * w_before + sum * sum * w_here + q * q * w_after) * total + one;
            let next_but_one = (w_before * node_2.q * p) * total;
            let next = (w_before * node_1.sum * p + w_here * node_1.q * sum) * -total - next_but_one * lower_1;
            let (lower_2, lower) = (next_but_one * inverse_2, next * inverse_1);
            // Never below one but by rounding.
            let pivot = (diagonal - lower_2 * next_but_one - lower * next).max(one);
            let inverse = one / pivot;
            right = right - right_1 * lower - right_2 * lower_2;
            lower.store(&mut rows.right, j, stride);
            lower_2.store(&mut rows.upper, j, stride);
            (right * inverse).store_at(&mut rows.bends, j, stride);
            (before, here, w_before, w_here) = (here, after, w_here, w_after);
            (node_2, node_1) = (node_1, node);
            (inverse_2, inverse_1, lower_1) = (inverse_1, inverse, lower);
            (right_2, right_1) = (right_1, right);
        }
    }

    /// From the last bend back to the first. Each node moves when the bends around it are known.
    #[inline(always)]
    fn substitute_bends<S: Simd, F: Wide<S>>(
        &mut self,
        simd: S,
        count: usize,
        Bends { weights, .. }: Bends,
        rows: &Rows,
    ) {
        let stride = self.stride;
        let none = F::splat(simd, 0.0);
        let nothing = Vec3Wide::splat(simd, [0.0; 3]);
        let nobody = Node { p: none, q: none, sum: none };
        // Of the two nodes after: lambda and weights, and the entries below the diagonal that still count.
        let (mut lambda_1, mut lambda_2) = (nothing, nothing);
        let (mut node_1, mut node_2) = (nobody, nobody);
        let (mut lower_1, mut lower_2, mut lower_2_of_1) = (none, none, none);
        for j in (0..count - 1).rev() {
            let (mut node, mut lambda) = (nobody, nothing);
            let (mut lower, mut lower_2_of_this) = (none, none);
            // The first node has no bend.
            if j > 0 {
                node = Node::load(simd, weights, j, stride);
                let right = Vec3Wide::load_at(simd, &rows.bends, j, stride);
                lambda = right - lambda_1 * lower_1 - lambda_2 * lower_2;
                lower = F::load(simd, &rows.right, j, stride);
                lower_2_of_this = F::load(simd, &rows.upper, j, stride);
            }
            self.shift(simd, j + 1, lambda * node.q - lambda_1 * node_1.sum + lambda_2 * node_2.p);
            (lambda_2, lambda_1) = (lambda_1, lambda);
            (node_2, node_1) = (node_1, node);
            (lower_2, lower_2_of_1, lower_1) = (lower_2_of_1, lower_2_of_this, lower);
        }
        self.shift(simd, 0, lambda_2 * node_2.p);
    }

    /// Moves nodes by an impulse over h, kg m.
    #[inline(always)]
    fn shift<S: Simd, F: Wide<S>>(&mut self, simd: S, j: usize, by: Vec3Wide<F>) {
        let w = F::load(simd, self.inverse_mass, j, self.stride);
        let place = Vec3Wide::load_at(simd, self.position, j, self.stride) + by * w;
        place.store_at(self.position, j, self.stride);
    }
}
