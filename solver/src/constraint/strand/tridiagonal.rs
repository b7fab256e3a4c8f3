//! Strands: chains of springs end to end, each solved exactly.
//!
//! ```text
//!   x0 --- x1 --- x2 --- ... --- xn       Cj = |dj| - Lj,  dj = x(j+1) - xj
//! ```
//!
//! Two springs of a strand have a particle in common if they are neighbours, and none else. The system that XPBD solves
//! for all springs of a strand at once (see [`spring`](crate::constraint::unstructured::spring), here for one
//! iteration a substep) is therefore tridiagonal, and Thomas' algorithm solves it in one pass there and one back. A pull at
//! one end is felt at the other within one substep: that is what sweeping over the springs takes hundreds of iterations for.
//!
//! Row j, multiplied by |dj| on both sides so that directions needn't be normalised and by t = k h² + c h so that neither
//! a stiffness of zero nor an infinite one needs a special case, with mu = lambda / |d|, here without damping:
//!
//! -tj wj d(j-1)·dj mu(j-1) + |dj|² (tj (wj + w(j+1)) + 1) mu(j) - tj w(j+1) dj·d(j+1) mu(j+1) = tj |dj| (Lj - |dj|)
//!
//! But for the factors t, the matrix is Gram's of the directions plus a positive diagonal: elimination needs no pivoting,
//! and leaves |dj|² of each diagonal entry at least. Of a stiff strand between two fixed particles it leaves little more,
//! which is less than what rounding does to numbers 1 + 2 t w as large: where that would leave less, it is set right.
//! Particle j moves by wj (d(j-1) mu(j-1) - dj mu(j)).
//!
//! The directions are those before the move. A taut spring also pulls across, as much as it turns; taken from before the
//! move that pull overshoots, and flips light particles from side to side, as soon as w h² T/L is more than 1/3 for a
//! tension T. So taut springs, with t = -mu > 0, pull along the direction that they have afterwards, x being new and p
//! old places:
//!
//! (1 + wj (t(j-1) + tj)) xj - wj t(j-1) x(j-1) - wj tj x(j+1) = pj
//!
//! which is tridiagonal as well, and the same where nothing turns. (The tension takes the place of the geometric
//! stiffness of Tournier et al., "Stable Constrained Dynamics", 2015.)
//!
//! A ring has one spring more, from its last particle to its first. It borders the matrix with a row and a column, which
//! are eliminated along with the others and come first on the way back.

use fearless_simd::prelude::*;

use crate::{
    constraint::{
        strand::law::{Scaled, StrandLaws, WideSpringLaw},
        unstructured::spring::solve_abreast,
    },
    layout::{
        points::Block,
        simd::{Lane, SHORTEST, Vec3Wide, Wide},
    },
    particles::gathered::End,
};

/// Eight strands side by side, node after node; or two times eight, those of the second pack after all of the first.
pub(crate) struct StrandLanes<'a> {
    /// Positions, m.
    pub position: &'a mut [Block],
    /// Positions before the substep, m; read only where springs are damped.
    pub previous: &'a [Block],
    /// Inverse masses, 1/kg.
    pub inverse_mass: &'a [Lane],
    /// From a node of the first pack to that of the second.
    pub stride: usize,
}

/// What elimination leaves of the row of each spring from a node to the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct EliminationRows {
    /// The right side, over the pivot.
    right: Vec<Lane>,
    /// The entry of the row before in the column of this one, over the pivot.
    upper: Vec<Lane>,
    /// The entry in the column of the spring that closes a ring, over the pivot.
    border: Vec<Lane>,
    /// Of bends: the right side.
    pub(crate) bends: Vec<Block>,
}

impl EliminationRows {
    /// Makes room for as many nodes.
    pub fn make_room(&mut self, count: usize) {
        for lanes in [&mut self.right, &mut self.upper, &mut self.border] {
            lanes.resize(lanes.len().max(count), Lane::default());
        }
        self.bends.resize(self.bends.len().max(count), Block::default());
    }
}

/// The springs of strands side by side from each node to the next.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StrandSprings<'a, L> {
    /// Rest lengths, m, one for each node; where it is zero, there is no spring.
    pub rest: &'a [Lane],
    pub laws: L,
}

/// A spring's row of the system: its direction, its factor t on both sides, its diagonal entry, what elimination leaves of
/// that at least, and its right side.
pub(crate) struct EliminationRow<F> {
    pub along: Vec3Wide<F>,
    pub factor: F,
    pub diagonal: F,
    pub least_pivot: F,
    pub right: F,
}

impl StrandLanes<'_> {
    #[inline(always)]
    pub(crate) fn end<S: Simd, F: Wide<S>, const DAMPED: bool>(&self, simd: S, j: usize) -> End<F> {
        let position = Vec3Wide::load_at(simd, self.position, j, self.stride);
        let previous = if DAMPED { Vec3Wide::load_at(simd, self.previous, j, self.stride) } else { position };
        End { position, previous, inverse_mass: F::load(simd, self.inverse_mass, j, self.stride) }
    }

    /// Solves the springs from each of `count` nodes to the next, and of a `CLOSED` ring the one from the last to the
    /// first.
    #[inline(always)]
    pub fn solve<S: Simd, F: Wide<S>, L: StrandLaws<S, F>, const DAMPED: bool, const CLOSED: bool>(
        &mut self,
        simd: S,
        count: usize,
        springs: StrandSprings<L>,
        rows: &mut EliminationRows,
    ) {
        let closing = self.eliminate::<S, F, L, DAMPED, CLOSED>(simd, count, springs, rows);
        self.substitute::<S, F, L, CLOSED>(simd, count, rows, closing);
    }

    /// From the first node to the last.
    #[inline(always)]
    fn eliminate<S: Simd, F: Wide<S>, L: StrandLaws<S, F>, const DAMPED: bool, const CLOSED: bool>(
        &self,
        simd: S,
        count: usize,
        springs: StrandSprings<L>,
        rows: &mut EliminationRows,
    ) -> EliminationRow<F> {
        let stride = self.stride;
        let (none, one) = (F::splat(simd, 0.0), F::splat(simd, 1.0));
        let last = count - 1;
        let first = self.end::<S, F, DAMPED>(simd, 0);
        let mut closing = EliminationRow {
            along: Vec3Wide::splat(simd, [0.0; 3]),
            factor: none,
            diagonal: one,
            least_pivot: one,
            right: none,
        };
        let mut border = none;
        if CLOSED {
            let ends = [self.end::<S, F, DAMPED>(simd, last), first];
            closing = springs.row::<S, F, DAMPED>(simd, ends, last, stride);
        }
        let mut here = first;
        let mut before = Vec3Wide::splat(simd, [0.0; 3]);
        let (mut inverse_pivot, mut right, mut factor_before) = (none, none, none);
        for j in 0..last {
            let next = self.end::<S, F, DAMPED>(simd, j + 1);
            let row = springs.row::<S, F, DAMPED>(simd, [here, next], j, stride);
            let shared = here.inverse_mass * before.dot(row.along);
            let over_pivot = shared * inverse_pivot;
            // Of this row in the column before, and of the row before in this column.
            let (lower, upper) = (over_pivot * row.factor, over_pivot * factor_before);
            inverse_pivot = one / (row.diagonal - lower * (shared * factor_before)).max(row.least_pivot);
            right = row.right + lower * right;
            (right * inverse_pivot).store(&mut rows.right, j, stride);
            upper.store(&mut rows.upper, j, stride);
            if CLOSED {
                border *= upper;
                if j == 0 {
                    border -= first.inverse_mass * closing.along.dot(row.along);
                }
                if j + 1 == last {
                    border -= next.inverse_mass * closing.along.dot(row.along);
                }
                let over_pivot = border * inverse_pivot;
                let in_closing = closing.factor * over_pivot;
                closing.diagonal -= in_closing * (border * row.factor);
                closing.right -= in_closing * right;
                (over_pivot * row.factor).store(&mut rows.border, j, stride);
            }
            (here, before, factor_before) = (next, row.along, row.factor);
        }
        closing
    }

    /// From the last node back to the first, which leaves each place but for its share of the one before, and on to the
    /// last again.
    #[inline(always)]
    fn substitute<S: Simd, F: Wide<S>, L: StrandLaws<S, F>, const CLOSED: bool>(
        &mut self,
        simd: S,
        count: usize,
        rows: &mut EliminationRows,
        closing: EliminationRow<F>,
    ) {
        let stride = self.stride;
        let (none, one) = (F::splat(simd, 0.0), F::splat(simd, 1.0));
        let mut closing_mu = none;
        if CLOSED {
            closing_mu = pulling::<S, F, L>(simd, closing.right / closing.diagonal.max(closing.least_pivot));
        }
        // What closes a ring, and what is pressed together, pushes along the direction that it had.
        let closing_push = closing.along * closing_mu;
        let mut push_after = closing_push;
        let (mut mu, mut upper) = (none, none);
        // Of the node after: tension towards it, its place but for its share of this one's, and that share.
        let (mut tension_after, mut place_after, mut share_after) = (none, closing_push, none);
        let mut here = Vec3Wide::load_at(simd, self.position, count - 1, stride);
        for j in (0..count).rev() {
            let mut before = here;
            // The first node has no spring before it but the one that closes a ring.
            let (tension, push) = if j > 0 {
                before = Vec3Wide::load_at(simd, self.position, j - 1, stride);
                mu = F::load(simd, &rows.right, j - 1, stride) + upper * mu;
                if CLOSED {
                    mu -= F::load(simd, &rows.border, j - 1, stride) * closing_mu;
                }
                mu = pulling::<S, F, L>(simd, mu);
                upper = F::load(simd, &rows.upper, j - 1, stride);
                // Of a spring that doesn't act, mu is zero.
                let along = here - before;
                if L::ONLY_PULLS { (none, along * mu) } else { (-mu.min(none), along * mu.max(none)) }
            } else {
                (none, closing_push)
            };
            let w = F::load(simd, self.inverse_mass, j, stride);
            let towards_after = tension_after;
            let pulled = place_after * towards_after + push - push_after;
            let place = here + pulled * w;
            (tension_after, push_after, here) = (tension, push, before);
            if L::ONLY_PULLS {
                place.store_at(self.position, j, stride);
                continue;
            }
            let inverse = one / (w * (tension + towards_after - towards_after * share_after) + one);
            (place_after, share_after) = (place * inverse, w * tension * inverse);
            place_after.store_at(self.position, j, stride);
            share_after.store(&mut rows.right, j, stride);
        }
        if L::ONLY_PULLS {
            return;
        }
        let mut before = Vec3Wide::load_at(simd, self.position, 0, stride);
        for j in 1..count {
            let share = F::load(simd, &rows.right, j, stride);
            before = Vec3Wide::load_at(simd, self.position, j, stride) + before * share;
            before.store_at(self.position, j, stride);
        }
    }

    /// Solves springs from each of `count` nodes to the one after the next. `rest` has a length for each node, m; where it
    /// is zero, there is no spring.
    ///
    /// The first two of every four nodes are joined to the other two, and then the two after them: so no spring waits for
    /// another.
    #[inline(always)]
    pub fn solve_bends<S: Simd, F: Wide<S>, const DAMPED: bool>(
        &mut self,
        simd: S,
        count: usize,
        rest: &[Lane],
        constants: Scaled,
    ) {
        for first in [0, 2] {
            for four in (first..count).step_by(4) {
                for j in four..four + 2 {
                    if j + 2 < count {
                        let rest = F::load(simd, rest, j, self.stride);
                        let (a, b) = (self.end::<S, F, DAMPED>(simd, j), self.end::<S, F, DAMPED>(simd, j + 2));
                        let [a, b] = solve_abreast::<_, _, DAMPED>(simd, a, b, rest, constants);
                        a.store_at(self.position, j, self.stride);
                        b.store_at(self.position, j + 2, self.stride);
                    }
                }
            }
        }
    }
}

impl<L> StrandSprings<'_, L> {
    /// The rows of springs side by side, that after node `at` of the first pack. Those that aren't there, have no length
    /// or are slack where they only pull have no direction.
    #[inline(always)]
    fn row<S: Simd, F: Wide<S>, const DAMPED: bool>(
        &self,
        simd: S,
        [here, next]: [End<F>; 2],
        at: usize,
        stride: usize,
    ) -> EliminationRow<F>
    where
        L: StrandLaws<S, F>,
    {
        let mut rest = F::load(simd, self.rest, at, stride);
        if L::ONLY_PULLS {
            rest *= self.laws.rest_scale();
        }
        let longer_than = if L::ONLY_PULLS { rest } else { F::splat(simd, SHORTEST) };
        EliminationRow::new::<S, DAMPED>(simd, [here, next], [rest, longer_than], self.laws.at(simd, at, stride))
    }
}

impl<F> EliminationRow<F> {
    /// The rows of springs side by side with these rest lengths, which act where they are longer than the others, m.
    #[inline(always)]
    pub(crate) fn new<S: Simd, const DAMPED: bool>(
        simd: S,
        [here, next]: [End<F>; 2],
        [rest, longer_than]: [F; 2],
        law: impl WideSpringLaw<S, F>,
    ) -> Self
    where
        F: Wide<S>,
    {
        let (none, one) = (F::splat(simd, 0.0), F::splat(simd, 1.0));
        let along = next.position - here.position;
        let squared = along.dot(along);
        let length = squared.sqrt();
        let [k, c] = law.scaled(simd, rest, length);
        let mut right = length * (rest - length) * k;
        let mut factor = k;
        if DAMPED {
            let way = along - (next.previous - here.previous);
            right -= along.dot(way) * c;
            factor += c;
        }
        let acts = rest.simd_gt(none) & length.simd_gt(longer_than);
        Self {
            along: along.or(acts, Vec3Wide::splat(simd, [0.0; 3])),
            factor,
            diagonal: acts.select(squared * ((here.inverse_mass + next.inverse_mass) * factor + one), one),
            least_pivot: acts.select(squared, one),
            right: acts.select(right, none),
        }
    }
}

/// What a spring that only pulls may do.
#[inline(always)]
fn pulling<S: Simd, F: Wide<S>, L: StrandLaws<S, F>>(simd: S, mu: F) -> F {
    if L::ONLY_PULLS { mu.min(F::splat(simd, 0.0)) } else { mu }
}

#[cfg(test)]
mod tests;
