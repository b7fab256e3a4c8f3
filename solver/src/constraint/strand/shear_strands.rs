//! The diagonals of a sheet's cells as strands along the bias, each solved exactly: eight columns side by side, row after
//! row.
//!
//! ```text
//!   o       o       o            a strand that falls goes on from a column to the next
//!     \       \                  with each row, one that rises comes the other way
//!   o   o   o   o   o
//!         \       \
//!   o       o       o
//! ```
//!
//! It is the system of [`strand`](crate::constraint::strand::tridiagonal), with what a spring takes over from the one before it lying one lane
//! beside it. Solved one by one, diagonals are softer than they are by 1 + k h²/m or so: with the light particles of a fine
//! mesh, several times as soft. Across the strands there is nothing of the kind: diagonals that cross are at right angles.
//!
//! As in strands, taut springs pull along the direction that they have after the move.

use fearless_simd::{f32x8, prelude::*};

use crate::{
    constraint::strand::tridiagonal::EliminationRow,
    layout::{
        points::Block,
        simd::{LANES, Lane, SHORTEST, Vec3x8, lane},
    },
    particles::{gathered::End, lanes::GridView},
};

/// Buffers for strands that are being solved.
#[derive(Clone, Debug, Default)]
pub(crate) struct ShearScratch {
    /// Of each spring: its right side over the pivot, and the entry of the spring before it in its column over the pivot.
    rows: Vec<[Lane; 2]>,
    /// Of each particle: its share of the place of the one before it on its strand.
    shares: Vec<Lane>,
    /// Of the springs of a row, and of the one before.
    springs: [Vec<EliminatedRow>; 2],
    /// Of the springs of a row, and of the one below.
    pulls: [Vec<SpringResponse>; 2],
}

/// What a spring does.
#[derive(Clone, Copy, Debug, Default)]
struct SpringResponse {
    /// What it pushes its end with where it is pressed together, kg m.
    push: Block,
    /// Its tension over its length, times h², kg.
    tension: Lane,
    /// What it leaves to the spring before it.
    left: Lane,
}

/// What the next spring of a strand needs of one.
#[derive(Clone, Copy, Debug, Default)]
struct EliminatedRow {
    along: Block,
    factor: Lane,
    inverse_pivot: Lane,
    right: Lane,
}

/// Diagonals of so many `rows`, those of a kind.
pub(crate) struct ShearStrands<'a> {
    pub rows: usize,
    /// Rest lengths of each cell's diagonal, m, and its part of the springs' stiffness: for each eight columns, one entry for
    /// each row of the lattice, from the first of these rows on.
    pub rest: &'a [Lane],
    pub shares: &'a [Lane],
    /// Rows of the lattice.
    pub stride: usize,
    /// k h² and c h of a whole spring, kg.
    pub spring: [f32; 2],
}

impl ShearStrands<'_> {
    /// Solves all strands that fall, or all that are `RISING`.
    #[inline(always)]
    pub fn solve<S: Simd, const RISING: bool, const DAMPED: bool>(
        &self,
        simd: S,
        grid: &mut GridView,
        shear_scratch: &mut ShearScratch,
    ) {
        let packs = grid.position.len() / self.rows;
        shear_scratch.rows.resize(shear_scratch.rows.len().max(grid.position.len()), Default::default());
        for springs in &mut shear_scratch.springs {
            springs.clear();
            springs.resize(packs, EliminatedRow::default());
        }
        for pulls in &mut shear_scratch.pulls {
            pulls.clear();
            pulls.resize(packs, SpringResponse::default());
        }
        shear_scratch.shares.resize(shear_scratch.shares.len().max(grid.position.len()), Lane::default());
        for row in 0..self.rows - 1 {
            self.eliminate::<S, RISING, DAMPED>(simd, grid, row, shear_scratch);
        }
        for row in (0..self.rows).rev() {
            self.substitute::<S, RISING>(simd, grid, row, shear_scratch);
        }
        for row in 1..self.rows {
            for pack in 0..packs {
                let at = pack * self.rows + row;
                let before = self.beside::<S, RISING>(simd, grid, at - 1, pack);
                let place = Vec3x8::load(simd, &grid.position[at]) + before * lane(simd, &shear_scratch.shares[at]);
                place.store(&mut grid.position[at]);
            }
        }
    }

    /// Particles of a row that strands come from, for those of the row below: one column before, or of those that rise, one
    /// after.
    #[inline(always)]
    fn beside<S: Simd, const RISING: bool>(&self, simd: S, grid: &GridView, at: usize, pack: usize) -> Vec3x8<S> {
        let here = Vec3x8::load(simd, &grid.position[at]);
        if RISING {
            here.ahead(Vec3x8::load(simd, &grid.position[self.next_pack(grid, at)]))
        } else {
            self.last_pack(simd, grid, at, pack).behind(here)
        }
    }

    /// After the last pack comes nobody: there are no springs to it.
    #[inline(always)]
    fn next_pack(&self, grid: &GridView, at: usize) -> usize {
        if at + self.rows < grid.position.len() { at + self.rows } else { at }
    }

    #[inline(always)]
    fn last_pack<S: Simd>(&self, simd: S, grid: &GridView, at: usize, pack: usize) -> Vec3x8<S> {
        if pack > 0 { Vec3x8::load(simd, &grid.position[at - self.rows]) } else { Vec3x8::splat(simd, [0.0; 3]) }
    }

    /// Both ends of the springs below a row.
    #[inline(always)]
    fn ends<S: Simd, const RISING: bool, const DAMPED: bool>(
        &self,
        simd: S,
        grid: &GridView,
        row: usize,
        pack: usize,
    ) -> [End<f32x8<S>>; 2] {
        let at = pack * self.rows + row;
        let next = self.next_pack(grid, at);
        if RISING {
            [ahead::<S, DAMPED>(simd, grid, at, next), end::<S, DAMPED>(simd, grid, at + 1)]
        } else {
            [end::<S, DAMPED>(simd, grid, at), ahead::<S, DAMPED>(simd, grid, at + 1, next + 1)]
        }
    }

    #[inline(always)]
    fn eliminate<S: Simd, const RISING: bool, const DAMPED: bool>(
        &self,
        simd: S,
        grid: &GridView,
        row: usize,
        shear_scratch: &mut ShearScratch,
    ) {
        let one = f32x8::splat(simd, 1.0);
        let [before, after] = &mut shear_scratch.springs;
        for (pack, after) in after.iter_mut().enumerate() {
            let of_cell = pack * self.stride + row;
            let rest = lane(simd, &self.rest[of_cell]);
            let share = lane(simd, &self.shares[of_cell]);
            let [top, bottom] = self.ends::<S, RISING, DAMPED>(simd, grid, row, pack);
            let law = [share * self.spring[0], share * self.spring[1]];
            let lengths = [rest, f32x8::splat(simd, SHORTEST)];
            let spring = EliminationRow::new::<S, DAMPED>(simd, [top, bottom], lengths, law);
            let last = before_it::<S, RISING>(simd, before, pack);
            let shared = top.inverse_mass * last.along.dot(spring.along);
            let over_pivot = shared * last.inverse_pivot;
            let (lower, upper) = (over_pivot * spring.factor, over_pivot * last.factor);
            let inverse_pivot = one / (spring.diagonal - lower * (shared * last.factor)).max(spring.least_pivot);
            let right = spring.right + lower * last.right;
            shear_scratch.rows[pack * self.rows + row] = [(right * inverse_pivot).into(), upper.into()];
            let EliminatedRow { along, factor, inverse_pivot: pivot, right: side } = after;
            spring.along.store(along);
            (*factor, *pivot, *side) = (spring.factor.into(), inverse_pivot.into(), right.into());
        }
        shear_scratch.springs.swap(0, 1);
    }

    /// Finds what the springs above a row pull with. Then it is known what pulls at the row's particles: leaves their places
    /// but for their shares of those before them.
    #[inline(always)]
    fn substitute<S: Simd, const RISING: bool>(
        &self,
        simd: S,
        grid: &mut GridView,
        row: usize,
        shear_scratch: &mut ShearScratch,
    ) {
        let (none, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
        let ShearScratch { rows, shares, pulls: [above, below], .. } = shear_scratch;
        for pack in 0..above.len() {
            let Some(row) = row.checked_sub(1) else {
                above[pack] = SpringResponse::default();
                continue;
            };
            let [top, bottom] = self.ends::<S, RISING, false>(simd, grid, row, pack);
            let [right, upper] = &rows[pack * self.rows + row];
            let mu = lane(simd, right) + after_it::<S, RISING>(simd, below, pack);
            let SpringResponse { push, tension, left } = &mut above[pack];
            ((bottom.position - top.position) * mu.max(none)).store(push);
            *tension = (-mu.min(none)).into();
            *left = (lane(simd, upper) * mu).into();
        }
        for pack in 0..above.len() {
            let at = pack * self.rows + row;
            let (from, to) = around::<S, RISING>(simd, above, below, pack);
            // The particles that the springs below lead to, and their shares of these.
            let (mut place_after, mut share_after) = (Vec3x8::splat(simd, [0.0; 3]), none);
            if row + 1 < self.rows {
                let here = (Vec3x8::load(simd, &grid.position[at + 1]), lane(simd, &shares[at + 1]));
                if RISING {
                    let last = if pack > 0 { lane(simd, &shares[at + 1 - self.rows]) } else { none };
                    place_after = self.last_pack(simd, grid, at + 1, pack).behind(here.0);
                    share_after = last.slide::<7>(here.1);
                } else {
                    let next = self.next_pack(grid, at) + 1;
                    place_after = here.0.ahead(Vec3x8::load(simd, &grid.position[next]));
                    share_after = here.1.slide::<1>(lane(simd, &shares[next]));
                }
            }
            let w = lane(simd, &grid.inverse_mass[at]);
            let pulled = place_after * to.tension + from.push - to.push;
            let place = Vec3x8::load(simd, &grid.position[at]) + pulled * w;
            let inverse = one / (w * (from.tension + to.tension - to.tension * share_after) + one);
            (place * inverse).store(&mut grid.position[at]);
            shares[at] = (w * from.tension * inverse).into();
        }
        shear_scratch.pulls.swap(0, 1);
    }
}

#[inline(always)]
fn end<S: Simd, const DAMPED: bool>(simd: S, grid: &GridView, at: usize) -> End<f32x8<S>> {
    let position = Vec3x8::load(simd, &grid.position[at]);
    let previous = if DAMPED { Vec3x8::load(simd, &grid.previous[at]) } else { position };
    End { position, previous, inverse_mass: lane(simd, &grid.inverse_mass[at]) }
}

/// Those one column further.
#[inline(always)]
fn ahead<S: Simd, const DAMPED: bool>(simd: S, grid: &GridView, at: usize, next: usize) -> End<f32x8<S>> {
    let (here, next) = (end::<S, DAMPED>(simd, grid, at), end::<S, DAMPED>(simd, grid, next));
    let position = here.position.ahead(next.position);
    let previous = if DAMPED { here.previous.ahead(next.previous) } else { position };
    End { position, previous, inverse_mass: here.inverse_mass.slide::<1>(next.inverse_mass) }
}

/// The springs that end where those of a pack begin.
struct PrecedingRow<S: Simd> {
    along: Vec3x8<S>,
    factor: f32x8<S>,
    inverse_pivot: f32x8<S>,
    right: f32x8<S>,
}

#[inline(always)]
fn before_it<S: Simd, const RISING: bool>(simd: S, row: &[EliminatedRow], pack: usize) -> PrecedingRow<S> {
    let none = EliminatedRow::default();
    let here = &row[pack];
    if RISING {
        let next = row.get(pack + 1).unwrap_or(&none);
        PrecedingRow {
            along: Vec3x8::load(simd, &here.along).ahead(Vec3x8::load(simd, &next.along)),
            factor: lane(simd, &here.factor).slide::<1>(lane(simd, &next.factor)),
            inverse_pivot: lane(simd, &here.inverse_pivot).slide::<1>(lane(simd, &next.inverse_pivot)),
            right: lane(simd, &here.right).slide::<1>(lane(simd, &next.right)),
        }
    } else {
        let last = if pack > 0 { &row[pack - 1] } else { &none };
        PrecedingRow {
            along: Vec3x8::load(simd, &last.along).behind(Vec3x8::load(simd, &here.along)),
            factor: lane(simd, &last.factor).slide::<7>(lane(simd, &here.factor)),
            inverse_pivot: lane(simd, &last.inverse_pivot).slide::<7>(lane(simd, &here.inverse_pivot)),
            right: lane(simd, &last.right).slide::<7>(lane(simd, &here.right)),
        }
    }
}

/// What the springs that begin where those of a pack end leave to these.
#[inline(always)]
fn after_it<S: Simd, const RISING: bool>(simd: S, row: &[SpringResponse], pack: usize) -> f32x8<S> {
    let here = lane(simd, &row[pack].left);
    let none = f32x8::splat(simd, 0.0);
    if RISING {
        (if pack > 0 { lane(simd, &row[pack - 1].left) } else { none }).slide::<7>(here)
    } else {
        here.slide::<1>(if pack + 1 < row.len() { lane(simd, &row[pack + 1].left) } else { none })
    }
}

/// Springs that pull at particles.
struct ParticleForces<S: Simd> {
    push: Vec3x8<S>,
    tension: f32x8<S>,
}

/// Those above the particles of a pack and those below.
#[inline(always)]
fn around<S: Simd, const RISING: bool>(
    simd: S,
    above: &[SpringResponse],
    below: &[SpringResponse],
    pack: usize,
) -> (ParticleForces<S>, ParticleForces<S>) {
    if RISING {
        (pulls_at(simd, &above[pack]), pulls_before(simd, below, pack))
    } else {
        (pulls_before(simd, above, pack), pulls_at(simd, &below[pack]))
    }
}

#[inline(always)]
fn pulls_at<S: Simd>(simd: S, pulling: &SpringResponse) -> ParticleForces<S> {
    ParticleForces { push: Vec3x8::load(simd, &pulling.push), tension: lane(simd, &pulling.tension) }
}

/// Those one column before.
#[inline(always)]
fn pulls_before<S: Simd>(simd: S, row: &[SpringResponse], pack: usize) -> ParticleForces<S> {
    let here = pulls_at(simd, &row[pack]);
    let last = pulls_at(simd, if pack > 0 { &row[pack - 1] } else { &NOTHING });
    ParticleForces { push: last.push.behind(here.push), tension: last.tension.slide::<7>(here.tension) }
}

const NOTHING: SpringResponse = SpringResponse { push: [[0.0; LANES]; 3], tension: [0.0; LANES], left: [0.0; LANES] };

#[cfg(test)]
mod tests;
