//! The springs of a large lattice in one substep, shared between threads.
//!
//! Columns are shared in parts of two packs each, rows and diagonals in bands of rows. What a thread does in a phase
//! depends on nothing that others do in it, so the bits are those of one thread. For the diagonals, in which each row of
//! particles hangs together with the next, a band takes two more rows on either side: it solves the diagonals there as
//! well, and its own rows get what they would get from the whole.

use core::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError};

use bevy::tasks::TaskPool;

use super::{
    Lanes,
    constraint::{
        spring::Scaled,
        strand::Both,
        tether::{self, PinPlaces, TetherBlock},
        weave::{self, Last, Loom, ROWS, Sheet, Weave},
    },
    crew::{self, Phase},
    integrate::{self, Finish},
    lanes::{Block, Run},
    lattice::Lattice,
    simd::Lane,
};

/// Particles from which on it pays: below, waking another thread takes as long as the work.
pub(super) const LARGE: usize = 10_000;

/// Rows of a band, a multiple of four: the order of its diagonals goes by four rows.
const BAND: usize = 32;

/// Rows on either side of a band that its diagonals depend on.
const HALO: usize = 2;

/// What the threads need to know of a substep.
#[derive(Clone, Copy, Debug)]
pub(super) struct Work<'a> {
    pub weave: Weave<'a>,
    pub shear: Scaled,
    pub last: Last,
    pub row_masses: &'a [Lane],
    pub tethers: &'a [TetherBlock],
    pub pins: &'a PinPlaces,
    pub slack: f32,
    /// What follows once the springs are solved.
    pub finish: Option<Finish<'a>>,
}

/// Buffers of all threads.
#[derive(Clone, Debug, Default)]
pub(super) struct Shares {
    bands: Vec<Band>,
    looms: Vec<Loom>,
}

/// Some rows of the cloth, and those around them.
#[derive(Clone, Debug, Default)]
struct Band {
    /// All of them.
    rows: Range<usize>,
    /// Those that are the band's own.
    own: Range<usize>,
    position: Vec<Block>,
    previous: Vec<Block>,
    inverse_mass: Vec<Lane>,
}

impl Shares {
    /// Makes room, and gives the bands their masses, once a step.
    pub fn fit(&mut self, lattice: &Lattice, inverse_mass: &[Lane]) {
        self.bands.resize_with(lattice.rows.div_ceil(BAND), Band::default);
        for (band, first) in self.bands.iter_mut().zip((0..).step_by(BAND)) {
            band.own = first..lattice.rows.min(first + BAND);
            band.rows = first.saturating_sub(HALO)..lattice.rows.min(first + BAND + HALO);
            let count = band.rows.len() * lattice.order().pack_count();
            band.position.resize(count, Block::default());
            band.previous.resize(count, Block::default());
            band.inverse_mass.clear();
            for column in inverse_mass.chunks_exact(lattice.rows) {
                band.inverse_mass.extend_from_slice(&column[band.rows.clone()]);
            }
        }
    }

    /// Solves tethers, diagonals, columns and rows, and finishes the substep.
    pub fn solve(&mut self, pool: &TaskPool, lanes: &mut Lanes, work: &Work) {
        self.looms.resize_with(self.looms.len().max(crew::size(pool)), Loom::default);
        let Work { weave, last, finish, .. } = work;
        let rows = weave.lattice.rows;
        let cloth = Cloth {
            work,
            parts: lanes.parts(2 * rows).map(Mutex::new).collect(),
            bands: self.bands.iter_mut().map(Mutex::new).collect(),
            looms: self.looms.iter_mut().map(Mutex::new).collect(),
        };
        let tether = |part, _| cloth.tether(part);
        let cross = |band, _| cloth.solve_diagonals(band);
        let columns = |part, worker| cloth.solve_columns(part, worker);
        let rows = |band, worker| cloth.solve_rows(band, worker);
        let end = |part, _| cloth.finish(part);
        let (parts, packs) = (cloth.parts.len(), weave.lattice.rows.div_ceil(ROWS));
        let [first, second] = last.order().map(|threads| match threads {
            Last::Columns => Phase { units: parts, work: &columns },
            Last::Rows => Phase { units: packs, work: &rows },
        });
        let [tether, cross] = [Phase { units: parts, work: &tether }, Phase { units: cloth.bands.len(), work: &cross }];
        let end = Phase { units: if finish.is_some() { parts } else { 0 }, work: &end };
        crew::run(pool, &[tether, cross, first, second, end]);
    }
}

/// A cloth while threads work on it. Nobody holds more than one part and one band at a time.
struct Cloth<'a> {
    work: &'a Work<'a>,
    /// Two packs of columns each.
    parts: Vec<Mutex<Run<'a>>>,
    bands: Vec<Mutex<&'a mut Band>>,
    /// One for each worker.
    looms: Vec<Mutex<&'a mut Loom>>,
}

impl Cloth<'_> {
    /// Pulls particles back to their tethers, and hands the rows to the bands.
    fn tether(&self, part: usize) {
        let Work { weave, tethers, pins, slack, .. } = *self.work;
        let mut run = lock(&self.parts[part]);
        let Run { first, position, inverse_mass, .. } = &mut *run;
        tether::solve(position, inverse_mass, *first, tethers, pins, slack, weave.instructions);
        let rows = weave.lattice.rows;
        for band in &self.bands {
            let mut band = lock(band);
            band.take(2 * part, rows, run.position, |band| &mut band.position);
            if self.work.shear.c > 0.0 {
                band.take(2 * part, rows, run.previous, |band| &mut band.previous);
            }
        }
    }

    /// Solves the diagonals of a band, and hands its rows back.
    fn solve_diagonals(&self, band: usize) {
        let Work { weave: Weave { lattice, instructions, .. }, shear, .. } = *self.work;
        let mut band = lock(&self.bands[band]);
        let Band { rows, own, position, previous, inverse_mass } = &mut **band;
        let mut sheet = Sheet { position, previous, inverse_mass, row_masses: &[] };
        weave::solve_diagonals(&mut sheet, rows.start, lattice, shear, instructions);
        let local = own.start - rows.start..own.end - rows.start;
        let mut solved = position.chunks_exact(rows.len());
        for part in &self.parts {
            let mut run = lock(part);
            for (column, solved) in run.position.chunks_exact_mut(lattice.rows).zip(&mut solved) {
                column[own.clone()].copy_from_slice(&solved[local.clone()]);
            }
        }
    }

    fn solve_columns(&self, part: usize, worker: usize) {
        let mut run = lock(&self.parts[part]);
        let Run { position, previous, inverse_mass, .. } = &mut *run;
        self.work.weave.solve_columns::<Both>(
            position,
            previous,
            inverse_mass,
            2 * part,
            &mut lock(&self.looms[worker]),
        );
    }

    /// Solves as many rows as fit on a loom.
    fn solve_rows(&self, number: usize, worker: usize) {
        let Work { weave, row_masses, .. } = self.work;
        let mut loom = lock(&self.looms[worker]);
        let first = number * ROWS;
        for (part, run) in self.parts.iter().enumerate() {
            let run = lock(run);
            weave.take_rows(run.position, run.previous, 2 * part, first, &mut loom);
        }
        weave.solve_rows::<Both>(row_masses, first, &mut loom);
        for (part, run) in self.parts.iter().enumerate() {
            weave.put_rows(&loom, lock(run).position, 2 * part, first);
        }
    }

    fn finish(&self, part: usize) {
        if let Some(finish) = self.work.finish {
            integrate::finish(&mut lock(&self.parts[part]), finish, self.work.weave.instructions);
        }
    }
}

impl Band {
    /// Takes over the band's rows of the packs from that with the number `first_pack` on.
    fn take(&mut self, first_pack: usize, rows: usize, from: &[Block], to: impl Fn(&mut Self) -> &mut Vec<Block>) {
        let some = self.rows.clone();
        let taken = to(self).chunks_exact_mut(some.len()).skip(first_pack);
        for (taken, column) in taken.zip(from.chunks_exact(rows)) {
            taken.copy_from_slice(&column[some.clone()]);
        }
    }
}

/// Each holds only what nobody else needs now: no panic leaves it half done for others.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
