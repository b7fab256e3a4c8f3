//! Strands: threads of springs end to end, each solved exactly.
//!
//! ```text
//!   x0 --- x1 --- x2 --- ... --- xn       Cj = |dj| - Lj,  dj = x(j+1) - xj
//! ```
//!
//! Two springs of a thread have a particle in common if they are neighbours, and none else. The system that XPBD solves
//! for all springs of a thread at once (see [`spring`](super::spring), here for one iteration a substep) is therefore
//! tridiagonal, and Thomas' algorithm solves it in one pass there and one back. A pull at one end is felt at the other
//! within one substep: that is what sweeping over the springs takes hundreds of iterations for.
//!
//! Row j, multiplied by |dj| on both sides so that directions needn't be normalised, with mu = lambda / |d| and
//! a = 1/(k h² + c h):
//!
//! -wj d(j-1)·dj mu(j-1) + |dj|² (wj + w(j+1) + a) mu(j) - w(j+1) dj·d(j+1) mu(j+1) = |dj| (Lj - |dj|)
//!
//! The matrix is Gram's of the directions plus a positive diagonal: elimination needs no pivoting. Particle j moves by
//! wj (d(j-1) mu(j-1) - dj mu(j)).
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

use super::{
    spring::{End, Scaled, solve_abreast},
    weave::Yarn,
};
use crate::solver::{
    lanes::Block,
    simd::{Lane, SHORTEST, Vec3Wide, Wide},
};

/// Eight threads side by side, node after node; or two times eight, those of the second pack after all of the first.
pub(in crate::solver) struct Pack<'a> {
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
pub(in crate::solver) struct Rows {
    /// The right side, over the pivot.
    right: Vec<Lane>,
    /// The factor below the diagonal.
    lower: Vec<Lane>,
    /// The entry in the column of the spring that closes a ring, over the pivot.
    border: Vec<Lane>,
}

impl Rows {
    /// Makes room for as many nodes.
    pub fn make_room(&mut self, count: usize) {
        for lanes in [&mut self.right, &mut self.lower, &mut self.border] {
            lanes.resize(lanes.len().max(count), Lane::default());
        }
    }
}

/// A spring's row of the system: its direction, its diagonal entry and its right side.
struct Spring<F> {
    along: Vec3Wide<F>,
    diagonal: F,
    right: F,
}

/// Which side of its rest length a spring acts on.
pub(in crate::solver) trait Side {
    /// Whether slack springs are without effect.
    const ONLY_PULLS: bool;
    /// Whether taut springs pull along the direction that they have after the move.
    const TURNS: bool = !Self::ONLY_PULLS;
}

/// Springs push and pull.
pub(in crate::solver) struct Both;

/// Springs pull where they are too long, and do nothing else: for levels, whose nodes are heavy and far apart, so that
/// they turn little.
pub(in crate::solver) struct Pull;

impl Side for Both {
    const ONLY_PULLS: bool = false;
}

impl Side for Pull {
    const ONLY_PULLS: bool = true;
}

impl Pack<'_> {
    #[inline(always)]
    fn end<S: Simd, F: Wide<S>, const DAMPED: bool>(&self, simd: S, j: usize) -> End<F> {
        let position = Vec3Wide::load_at(simd, self.position, j, self.stride);
        let previous = if DAMPED { Vec3Wide::load_at(simd, self.previous, j, self.stride) } else { position };
        End { position, previous, inverse_mass: F::load(simd, self.inverse_mass, j, self.stride) }
    }

    /// Solves the springs from each of `count` nodes to the next, and of a `CLOSED` ring the one from the last to the
    /// first. `rest` has the springs' rest lengths in m, one for each node; where it is zero, there is no spring.
    #[inline(always)]
    pub fn solve<S: Simd, F: Wide<S>, D: Side, const DAMPED: bool, const CLOSED: bool>(
        &mut self,
        simd: S,
        count: usize,
        rest: &[Lane],
        yarn: Yarn,
        rows: &mut Rows,
    ) {
        let closing = self.eliminate::<S, F, D, DAMPED, CLOSED>(simd, count, rest, yarn, rows);
        self.substitute::<S, F, D, CLOSED>(simd, count, rows, closing);
    }

    /// From the first node to the last.
    #[inline(always)]
    fn eliminate<S: Simd, F: Wide<S>, D: Side, const DAMPED: bool, const CLOSED: bool>(
        &self,
        simd: S,
        count: usize,
        rest: &[Lane],
        yarn: Yarn,
        rows: &mut Rows,
    ) -> Spring<F> {
        let stride = self.stride;
        let (none, one) = (F::splat(simd, 0.0), F::splat(simd, 1.0));
        let last = count - 1;
        let first = self.end::<S, F, DAMPED>(simd, 0);
        let mut closing = Spring { along: Vec3Wide::splat(simd, [0.0; 3]), diagonal: one, right: none };
        let mut border = none;
        if CLOSED {
            let ends = [self.end::<S, F, DAMPED>(simd, last), first];
            closing = spring::<S, F, D, DAMPED>(simd, ends, F::load(simd, rest, last, stride), yarn);
        }
        let mut here = first;
        let mut before = Vec3Wide::splat(simd, [0.0; 3]);
        let (mut inverse_pivot, mut right) = (none, none);
        for j in 0..last {
            let next = self.end::<S, F, DAMPED>(simd, j + 1);
            let spring = spring::<S, F, D, DAMPED>(simd, [here, next], F::load(simd, rest, j, stride), yarn);
            let below = here.inverse_mass * before.dot(spring.along);
            let lower = below * inverse_pivot;
            inverse_pivot = one / (spring.diagonal - below * lower);
            right = spring.right + lower * right;
            (right * inverse_pivot).store(&mut rows.right, j, stride);
            lower.store(&mut rows.lower, j, stride);
            if CLOSED {
                border *= lower;
                if j == 0 {
                    border -= first.inverse_mass * closing.along.dot(spring.along);
                }
                if j + 1 == last {
                    border -= next.inverse_mass * closing.along.dot(spring.along);
                }
                let over_pivot = border * inverse_pivot;
                closing.diagonal -= border * over_pivot;
                closing.right -= over_pivot * right;
                over_pivot.store(&mut rows.border, j, stride);
            }
            (here, before) = (next, spring.along);
        }
        closing
    }

    /// From the last node back to the first, which leaves each place but for its share of the one before, and on to the
    /// last again.
    #[inline(always)]
    fn substitute<S: Simd, F: Wide<S>, D: Side, const CLOSED: bool>(
        &mut self,
        simd: S,
        count: usize,
        rows: &mut Rows,
        closing: Spring<F>,
    ) {
        let stride = self.stride;
        let (none, one) = (F::splat(simd, 0.0), F::splat(simd, 1.0));
        let mut closing_mu = none;
        if CLOSED {
            closing_mu = pulling::<S, F, D>(simd, closing.right / closing.diagonal);
        }
        // What closes a ring, and what is pressed together, pushes along the direction that it had.
        let closing_push = closing.along * closing_mu;
        let mut push_after = closing_push;
        let (mut mu, mut lower) = (none, none);
        // Of the node after: tension towards it, its place but for its share of this one's, and that share.
        let (mut tension_after, mut place_after, mut share_after) = (none, closing_push, none);
        let mut here = Vec3Wide::load_at(simd, self.position, count - 1, stride);
        for j in (0..count).rev() {
            let mut before = here;
            // The first node has no spring before it but the one that closes a ring.
            let (tension, push) = if j > 0 {
                before = Vec3Wide::load_at(simd, self.position, j - 1, stride);
                mu = F::load(simd, &rows.right, j - 1, stride) + lower * mu;
                if CLOSED {
                    mu -= F::load(simd, &rows.border, j - 1, stride) * closing_mu;
                }
                mu = pulling::<S, F, D>(simd, mu);
                lower = F::load(simd, &rows.lower, j - 1, stride);
                // Of a spring that doesn't act, mu is zero.
                let along = here - before;
                if D::TURNS { (-mu.min(none), along * mu.max(none)) } else { (none, along * mu) }
            } else {
                (none, closing_push)
            };
            let w = F::load(simd, self.inverse_mass, j, stride);
            let towards_after = tension_after;
            let pulled = place_after * towards_after + push - push_after;
            let place = here + pulled * w;
            (tension_after, push_after, here) = (tension, push, before);
            if !D::TURNS {
                place.store_at(self.position, j, stride);
                continue;
            }
            let inverse = one / (w * (tension + towards_after - towards_after * share_after) + one);
            (place_after, share_after) = (place * inverse, w * tension * inverse);
            place_after.store_at(self.position, j, stride);
            share_after.store(&mut rows.right, j, stride);
        }
        if !D::TURNS {
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

/// The row of springs side by side. Those that aren't there, have no length or are slack where they only pull have no
/// direction.
#[inline(always)]
fn spring<S: Simd, F: Wide<S>, D: Side, const DAMPED: bool>(
    simd: S,
    [here, next]: [End<F>; 2],
    rest: F,
    Yarn { stretch: Scaled { k, c }, give, .. }: Yarn,
) -> Spring<F> {
    let (none, one) = (F::splat(simd, 0.0), F::splat(simd, 1.0));
    let softness = 1.0 / (k + c);
    let along = next.position - here.position;
    let squared = along.dot(along);
    let length = squared.sqrt();
    let rest = if D::ONLY_PULLS { rest * give } else { rest };
    let longer_than = if D::ONLY_PULLS { rest } else { F::splat(simd, SHORTEST) };
    let acts = rest.simd_gt(none) & length.simd_gt(longer_than);
    let mut right = length * (rest - length);
    if DAMPED {
        let way = along - (next.previous - here.previous);
        right = right * (k * softness) - along.dot(way) * (c * softness);
    }
    Spring {
        along: along.or(acts, Vec3Wide::splat(simd, [0.0; 3])),
        diagonal: acts.select(squared * (here.inverse_mass + next.inverse_mass + softness), one),
        right: acts.select(right, none),
    }
}

/// What a spring that only pulls may do.
#[inline(always)]
fn pulling<S: Simd, F: Wide<S>, D: Side>(simd: S, mu: F) -> F {
    if D::ONLY_PULLS { mu.min(F::splat(simd, 0.0)) } else { mu }
}
