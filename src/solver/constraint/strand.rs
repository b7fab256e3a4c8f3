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

use fearless_simd::{f32x8, prelude::*};

use super::{
    spring::{End, Scaled, solve_eight},
    weave::Yarn,
};
use crate::solver::{
    lanes::Block,
    simd::{Lane, SHORTEST, Vec3x8, lane},
};

/// Eight threads side by side, node after node.
pub(in crate::solver) struct Pack<'a> {
    /// Positions, m.
    pub position: &'a mut [Block],
    /// Positions before the substep, m; read only where springs are damped.
    pub previous: &'a [Block],
    /// Inverse masses, 1/kg.
    pub inverse_mass: &'a [Lane],
}

/// What elimination leaves of the row of the spring from a node to the next.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::solver) struct Row {
    /// d, from the node to the next.
    along: Block,
    /// The right side, over the pivot.
    right: Lane,
    /// The factor below the diagonal.
    lower: Lane,
    /// The entry in the column of the spring that closes a ring, over the pivot.
    border: Lane,
}

/// A spring's row of the system: its direction, its diagonal entry and its right side.
struct Spring<S: Simd> {
    along: Vec3x8<S>,
    diagonal: f32x8<S>,
    right: f32x8<S>,
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
    fn end<S: Simd, const DAMPED: bool>(&self, simd: S, j: usize) -> End<S> {
        End::load::<DAMPED>(simd, self.position, self.previous, self.inverse_mass, j)
    }

    /// Solves the springs from each node to the next, and of a `CLOSED` ring the one from the last to the first. `rest`
    /// has the springs' rest lengths in m, one for each node; where it is zero, there is no spring.
    #[inline(always)]
    pub fn solve<S: Simd, D: Side, const DAMPED: bool, const CLOSED: bool>(
        &mut self,
        simd: S,
        rest: &[Lane],
        yarn: Yarn,
        rows: &mut [Row],
    ) {
        // Of one length, as the compiler can see.
        let count = rest.len();
        let mut pack = Pack {
            position: &mut self.position[..count],
            previous: if DAMPED { &self.previous[..count] } else { &[] },
            inverse_mass: &self.inverse_mass[..count],
        };
        let rows = &mut rows[..count];
        let closing = pack.eliminate::<S, D, DAMPED, CLOSED>(simd, rest, yarn, rows);
        pack.substitute::<S, D, CLOSED>(simd, rows, closing);
    }

    /// From the first node to the last.
    #[inline(always)]
    fn eliminate<S: Simd, D: Side, const DAMPED: bool, const CLOSED: bool>(
        &self,
        simd: S,
        rest: &[Lane],
        yarn: Yarn,
        rows: &mut [Row],
    ) -> Spring<S> {
        let (none, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
        let last = rows.len() - 1;
        let first = self.end::<S, DAMPED>(simd, 0);
        let mut closing = Spring { along: Vec3x8::splat(simd, [0.0; 3]), diagonal: one, right: none };
        let mut border = none;
        if CLOSED {
            let ends = [self.end::<S, DAMPED>(simd, last), first];
            closing = spring::<S, D, DAMPED>(simd, ends, &rest[last], yarn);
        }
        let mut here = first;
        let mut before = Vec3x8::splat(simd, [0.0; 3]);
        let (mut inverse_pivot, mut right) = (none, none);
        for j in 0..last {
            let next = self.end::<S, DAMPED>(simd, j + 1);
            let spring = spring::<S, D, DAMPED>(simd, [here, next], &rest[j], yarn);
            let below = here.inverse_mass * before.dot(spring.along);
            let lower = below * inverse_pivot;
            inverse_pivot = one / (spring.diagonal - below * lower);
            right = spring.right + lower * right;
            let row = &mut rows[j];
            spring.along.store(&mut row.along);
            (row.right, row.lower) = ((right * inverse_pivot).into(), lower.into());
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
                row.border = over_pivot.into();
            }
            (here, before) = (next, spring.along);
        }
        closing
    }

    /// From the last node back to the first, which leaves each place but for its share of the one before, and on to the
    /// last again.
    #[inline(always)]
    fn substitute<S: Simd, D: Side, const CLOSED: bool>(&mut self, simd: S, rows: &mut [Row], closing: Spring<S>) {
        let (none, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
        let mut closing_mu = none;
        if CLOSED {
            closing_mu = pulling::<S, D>(simd, closing.right / closing.diagonal);
        }
        // What closes a ring, and what is pressed together, pushes along the direction that it had.
        let closing_push = closing.along * closing_mu;
        let mut push_after = closing_push;
        let (mut mu, mut lower) = (none, none);
        // Of the node after: tension towards it, its place but for its share of this one's, and that share.
        let (mut tension_after, mut place_after, mut share_after) = (none, closing_push, none);
        for j in (0..rows.len()).rev() {
            // The first node has no spring before it but the one that closes a ring.
            let (tension, push) = if j > 0 {
                let row = &rows[j - 1];
                mu = lane(simd, &row.right) + lower * mu;
                if CLOSED {
                    mu -= lane(simd, &row.border) * closing_mu;
                }
                mu = pulling::<S, D>(simd, mu);
                lower = lane(simd, &row.lower);
                let along = Vec3x8::load(simd, &row.along);
                if D::TURNS { (-mu.min(none), along * mu.max(none)) } else { (none, along * mu) }
            } else {
                (none, closing_push)
            };
            let w = lane(simd, &self.inverse_mass[j]);
            let towards_after = tension_after;
            let pulled = place_after * towards_after + push - push_after;
            let place = Vec3x8::load(simd, &self.position[j]) + pulled * w;
            (tension_after, push_after) = (tension, push);
            if !D::TURNS {
                place.store(&mut self.position[j]);
                continue;
            }
            let inverse = one / (w * (tension + towards_after - towards_after * share_after) + one);
            (place_after, share_after) = (place * inverse, w * tension * inverse);
            place_after.store(&mut self.position[j]);
            rows[j].right = share_after.into();
        }
        if !D::TURNS {
            return;
        }
        for (j, row) in rows.iter().enumerate().skip(1) {
            let before = Vec3x8::load(simd, &self.position[j - 1]);
            let place = Vec3x8::load(simd, &self.position[j]) + before * lane(simd, &row.right);
            place.store(&mut self.position[j]);
        }
    }

    /// Solves springs from each node to the one after the next. `rest` has a length for each node, m; where it is zero,
    /// there is no spring.
    ///
    /// The first two of every four nodes are joined to the other two, and then the two after them: so no spring waits for
    /// another.
    #[inline(always)]
    pub fn solve_bends<S: Simd, const DAMPED: bool>(&mut self, simd: S, rest: &[Lane], constants: Scaled) {
        for first in [0, 2] {
            for four in (first..rest.len()).step_by(4) {
                for j in four..four + 2 {
                    if j + 2 < rest.len() {
                        self.solve_pair::<S, DAMPED>(simd, j, j + 2, &rest[j], constants);
                    }
                }
            }
        }
    }

    #[inline(always)]
    fn solve_pair<S: Simd, const DAMPED: bool>(&mut self, simd: S, i: usize, j: usize, rest: &Lane, constants: Scaled) {
        let (a, b) = (self.end::<S, DAMPED>(simd, i), self.end::<S, DAMPED>(simd, j));
        let [a, b] = solve_eight::<S, DAMPED>(simd, a, b, lane(simd, rest), constants);
        a.store(&mut self.position[i]);
        b.store(&mut self.position[j]);
    }
}

/// The row of eight springs. Those that aren't there, have no length or are slack where they only pull have no direction.
#[inline(always)]
fn spring<S: Simd, D: Side, const DAMPED: bool>(
    simd: S,
    [here, next]: [End<S>; 2],
    rest: &Lane,
    Yarn { stretch: Scaled { k, c }, give, .. }: Yarn,
) -> Spring<S> {
    let (none, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
    let softness = 1.0 / (k + c);
    let along = next.position - here.position;
    let squared = along.dot(along);
    let length = squared.sqrt();
    let rest = if D::ONLY_PULLS { lane(simd, rest) * give } else { lane(simd, rest) };
    let longer_than = if D::ONLY_PULLS { rest } else { f32x8::splat(simd, SHORTEST) };
    let acts = rest.simd_gt(none) & length.simd_gt(longer_than);
    let mut right = length * (rest - length);
    if DAMPED {
        let way = along - (next.previous - here.previous);
        right = right * (k * softness) - along.dot(way) * (c * softness);
    }
    Spring {
        along: along.or(acts, Vec3x8::splat(simd, [0.0; 3])),
        diagonal: acts.select(squared * (here.inverse_mass + next.inverse_mass + softness), one),
        right: acts.select(right, none),
    }
}

/// What a spring that only pulls may do.
#[inline(always)]
fn pulling<S: Simd, D: Side>(simd: S, mu: f32x8<S>) -> f32x8<S> {
    if D::ONLY_PULLS { mu.min(f32x8::splat(simd, 0.0)) } else { mu }
}
