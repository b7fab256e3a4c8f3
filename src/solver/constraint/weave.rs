//! The threads of a lattice: rows and columns as strands, and the diagonals of its cells as springs.
//!
//! Eight columns stand side by side in memory already. Eight rows are brought there by transposing their blocks, and
//! back.

use core::ops::Range;

use fearless_simd::{dispatch, f32x8, f32x16, prelude::*};

use super::{
    spring::{End, Scaled, solve_abreast},
    strand::{Pack, Rows, Side},
};
use crate::solver::{
    Anchor, Lattice,
    lanes::{Block, Order},
    lattice::Threads,
    simd::{Instructions, LANES, Lane, Vec3x8, Wide, lane, transpose},
};

/// The particles of a lattice during a substep.
pub(in crate::solver) struct Sheet<'a> {
    pub position: &'a mut [Block],
    /// Positions before the substep; read only where springs are damped.
    pub previous: &'a [Block],
    pub inverse_mass: &'a [Lane],
    /// The same, as [`masses_along_rows`] gives them.
    pub row_masses: &'a [Lane],
}

/// Rows that are solved side by side: two packs.
pub(in crate::solver) const ROWS: usize = 2 * LANES;

/// Buffers for threads that are being solved.
#[derive(Clone, Debug, Default)]
pub(in crate::solver) struct Loom {
    rows: Rows,
    position: Vec<Block>,
    previous: Vec<Block>,
}

impl Loom {
    /// Makes room for as many nodes.
    fn make_room(&mut self, count: usize) {
        self.rows.make_room(count);
        for blocks in [&mut self.position, &mut self.previous] {
            blocks.resize(blocks.len().max(count), Block::default());
        }
    }
}

/// Constants of a thread's springs.
#[derive(Clone, Copy, Debug)]
pub(in crate::solver) struct Yarn {
    pub stretch: Scaled,
    /// None where nothing bends.
    pub bend: Option<Scaled>,
    /// Factor on the rest lengths of what only pulls, 1 or more.
    pub give: f32,
}

impl Yarn {
    pub fn is_damped(&self) -> bool {
        self.stretch.c > 0.0 || self.bend.is_some_and(|bend| bend.c > 0.0)
    }
}

/// Inverse masses for eight rows side by side, column after column.
pub(in crate::solver) fn masses_along_rows(
    lattice: &Lattice,
    inverse_mass: &[Lane],
    along_rows: &mut Vec<Lane>,
    instructions: Instructions,
) {
    let nodes = lattice.along_rows.nodes;
    along_rows.resize(nodes * lattice.rows.div_ceil(LANES), Lane::default());
    dispatch!(instructions.level(), simd => {
        for (pack, first) in along_rows.chunks_exact_mut(nodes).zip((0..).step_by(LANES)) {
            let some = first..lattice.rows.min(first + LANES);
            for (nodes, column) in pack.chunks_exact_mut(LANES).zip(inverse_mass.chunks_exact(lattice.rows)) {
                across(simd, column[some.clone()].iter(), nodes.iter_mut());
            }
        }
    });
}

/// Which threads are solved last: they are held best.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::solver) enum Last {
    Rows,
    Columns,
}

impl Last {
    /// Both, in their order.
    pub fn order(self) -> [Self; 2] {
        match self {
            Self::Rows => [Self::Columns, Self::Rows],
            Self::Columns => [Self::Rows, Self::Columns],
        }
    }

    /// The threads that carry the most: those that go from pin to pin where few pins are far apart, and those that hang
    /// from them where pins stand close.
    pub fn between(anchors: &[Anchor], order: Order) -> Self {
        let place =
            |anchor: &Anchor| (anchor.particle as usize / order.columns, anchor.particle as usize % order.columns);
        let spread = |of: fn((usize, usize)) -> usize| {
            let places = anchors.iter().map(|anchor| of(place(anchor)));
            places.clone().max().unwrap_or(0) - places.min().unwrap_or(0)
        };
        let (across, down) = (spread(|(_, column)| column), spread(|(row, _)| row));
        let are_far_apart = 2 * anchors.len() <= across.max(down);
        if (across > down) == are_far_apart { Self::Rows } else { Self::Columns }
    }
}

/// How the threads of a lattice are solved.
#[derive(Clone, Copy, Debug)]
pub(in crate::solver) struct Weave<'a> {
    pub lattice: &'a Lattice,
    pub yarn: Yarn,
    pub instructions: Instructions,
}

impl Weave<'_> {
    /// Solves all columns and all rows.
    pub fn solve<D: Side>(&self, sheet: &mut Sheet, last: Last, loom: &mut Loom) {
        for threads in last.order() {
            match threads {
                Last::Columns => {
                    self.solve_columns::<D>(sheet.position, sheet.previous, sheet.inverse_mass, 0, loom);
                }
                Last::Rows => {
                    for first in (0..self.lattice.rows).step_by(ROWS) {
                        self.take_rows(sheet.position, sheet.previous, 0, first, loom);
                        self.solve_rows::<D>(sheet.row_masses, first, loom);
                        self.put_rows(loom, sheet.position, 0, first);
                    }
                }
            }
        }
    }

    /// Solves the columns of the packs from that with the number `first_pack` on, which are all that is given.
    pub fn solve_columns<D: Side>(
        &self,
        position: &mut [Block],
        previous: &[Block],
        inverse_mass: &[Lane],
        first_pack: usize,
        loom: &mut Loom,
    ) {
        let stride = self.lattice.rows;
        loom.make_room(2 * stride);
        let masses = inverse_mass.chunks(2 * stride);
        let pairs = position.chunks_mut(2 * stride).zip(previous.chunks(2 * stride)).zip(masses);
        for (number, ((position, previous), inverse_mass)) in (first_pack..).step_by(2).zip(pairs) {
            let mut pack = Pack { position, previous, inverse_mass, stride };
            self.solve_packs::<D>(&mut pack, &self.lattice.along_columns, number, &mut loom.rows);
        }
    }

    /// Takes up to sixteen rows from the `first` on to the loom, as far as they are in the packs from that with the number
    /// `first_pack` on, which are given.
    pub fn take_rows(&self, position: &[Block], previous: &[Block], first_pack: usize, first: usize, loom: &mut Loom) {
        loom.make_room(2 * self.lattice.along_rows.nodes);
        let (level, lattice) = (self.instructions.level(), self.lattice);
        dispatch!(level, simd => take_rows(simd, position, first_pack, lattice, first, &mut loom.position));
        if self.yarn.is_damped() {
            dispatch!(level, simd => take_rows(simd, previous, first_pack, lattice, first, &mut loom.previous));
        }
    }

    /// Solves the rows that were taken. `row_masses` are those of all rows.
    pub fn solve_rows<D: Side>(&self, row_masses: &[Lane], first: usize, loom: &mut Loom) {
        let (nodes, number) = (self.lattice.along_rows.nodes, first / LANES);
        let count = row_packs(self.lattice, first).len() * nodes;
        let Loom { rows, position, previous } = loom;
        let inverse_mass = &row_masses[number * nodes..][..count];
        let mut pack = Pack { position: &mut position[..count], previous, inverse_mass, stride: nodes };
        self.solve_packs::<D>(&mut pack, &self.lattice.along_rows, number, rows);
    }

    /// Puts rows back to where they were taken from.
    pub fn put_rows(&self, loom: &Loom, position: &mut [Block], first_pack: usize, first: usize) {
        let (level, lattice) = (self.instructions.level(), self.lattice);
        dispatch!(level, simd => put_rows(simd, &loom.position, position, first_pack, lattice, first));
    }

    /// Solves one or two packs of threads, from that with a `number` on.
    fn solve_packs<D: Side>(&self, pack: &mut Pack, threads: &Threads, number: usize, rows: &mut Rows) {
        let (level, yarn) = (self.instructions.level(), self.yarn);
        match (pack.position.len() > pack.stride, yarn.is_damped()) {
            (true, false) => {
                dispatch!(level, simd => solve_threads::<_, f32x16<_>, D, false>(simd, pack, threads, number, yarn, rows));
            }
            (true, true) => {
                dispatch!(level, simd => solve_threads::<_, f32x16<_>, D, true>(simd, pack, threads, number, yarn, rows));
            }
            (false, false) => {
                dispatch!(level, simd => solve_threads::<_, f32x8<_>, D, false>(simd, pack, threads, number, yarn, rows));
            }
            (false, true) => {
                dispatch!(level, simd => solve_threads::<_, f32x8<_>, D, true>(simd, pack, threads, number, yarn, rows));
            }
        }
    }
}

/// The rows of up to two packs of rows.
fn row_packs(lattice: &Lattice, first: usize) -> impl ExactSizeIterator<Item = Range<usize>> {
    let rows = lattice.rows;
    (first..rows.min(first + ROWS)).step_by(LANES).map(move |row| row..rows.min(row + LANES))
}

#[inline(always)]
fn take_rows<S: Simd>(
    simd: S,
    columns: &[Block],
    first_pack: usize,
    lattice: &Lattice,
    first: usize,
    taken: &mut [Block],
) {
    for (some, taken) in row_packs(lattice, first).zip(taken.chunks_exact_mut(lattice.along_rows.nodes)) {
        let nodes = taken.chunks_exact_mut(LANES).skip(first_pack);
        for (nodes, column) in nodes.zip(columns.chunks_exact(lattice.rows)) {
            blocks_across(simd, &column[some.clone()], nodes);
        }
    }
}

#[inline(always)]
fn put_rows<S: Simd>(
    simd: S,
    taken: &[Block],
    columns: &mut [Block],
    first_pack: usize,
    lattice: &Lattice,
    first: usize,
) {
    for (some, taken) in row_packs(lattice, first).zip(taken.chunks_exact(lattice.along_rows.nodes)) {
        let nodes = taken.chunks_exact(LANES).skip(first_pack);
        for (nodes, column) in nodes.zip(columns.chunks_exact_mut(lattice.rows)) {
            blocks_across(simd, nodes, &mut column[some.clone()]);
        }
    }
}

#[inline(always)]
fn solve_threads<S: Simd, F: Wide<S>, D: Side, const DAMPED: bool>(
    simd: S,
    pack: &mut Pack,
    threads: &Threads,
    number: usize,
    yarn: Yarn,
    rows: &mut Rows,
) {
    let of_packs = number * threads.nodes..(number + F::PACKS) * threads.nodes;
    let count = threads.count;
    if let Some(bend) = yarn.bend {
        pack.solve_bends::<S, F, DAMPED>(simd, count, &threads.bend[of_packs.clone()], bend);
    }
    // What comes last is held best: stretch shows more than bending.
    if yarn.stretch.acts() {
        let rest = &threads.stretch[of_packs];
        if threads.closed {
            pack.solve::<S, F, D, DAMPED, true>(simd, count, rest, yarn, rows);
        } else {
            pack.solve::<S, F, D, DAMPED, false>(simd, count, rest, yarn, rows);
        }
    }
}

/// Turns up to eight blocks into up to eight others: lane i of block j becomes lane j of block i.
#[inline(always)]
fn blocks_across<S: Simd>(simd: S, from: &[Block], to: &mut [Block]) {
    for i in 0..3 {
        across(simd, from.iter().map(|block| &block[i]), to.iter_mut().map(|block| &mut block[i]));
    }
}

#[inline(always)]
fn across<'a, S: Simd>(simd: S, from: impl Iterator<Item = &'a Lane>, to: impl Iterator<Item = &'a mut Lane>) {
    let mut tile = [f32x8::splat(simd, 0.0); LANES];
    for (values, from) in tile.iter_mut().zip(from) {
        *values = lane(simd, from);
    }
    for (to, values) in to.zip(transpose(tile)) {
        *to = values.into();
    }
}

/// Solves the diagonals of all cells: those between an even row and the next, then those below. The sheet may be a part of
/// the lattice: all of the columns in its rows from the `first` on, which is even.
pub(in crate::solver) fn solve_diagonals(
    sheet: &mut Sheet,
    first: usize,
    lattice: &Lattice,
    constants: Scaled,
    instructions: Instructions,
) {
    let level = instructions.level();
    if constants.c > 0.0 {
        dispatch!(level, simd => solve_all_diagonals::<_, true>(simd, sheet, first, lattice, constants));
    } else if constants.k > 0.0 {
        dispatch!(level, simd => solve_all_diagonals::<_, false>(simd, sheet, first, lattice, constants));
    }
}

#[inline(always)]
fn solve_all_diagonals<S: Simd, const DAMPED: bool>(
    simd: S,
    sheet: &mut Sheet,
    first: usize,
    lattice: &Lattice,
    constants: Scaled,
) {
    let rows = sheet.position.len() / lattice.order().pack_count();
    for parity in [0, 1] {
        for row in (parity..rows - 1).step_by(2) {
            let falling = (&lattice.falling, [row, row + 1]);
            let rising = (&lattice.rising, [row + 1, row]);
            // By turns, so that what comes first doesn't set the cloth spinning.
            let pairs = if (first + row) % 4 < 2 { [falling, rising] } else { [rising, falling] };
            for (rest, ends) in pairs {
                let rest = rest[first + row..].iter().step_by(lattice.rows);
                solve_row_pair::<S, DAMPED>(simd, sheet, rest, ends, rows, constants);
            }
        }
    }
}

/// Solves the springs from each particle of one row to the next column of another. `rest` has their lengths (m) for each
/// block of the row, and `rows` is the number of all.
#[inline(always)]
fn solve_row_pair<'a, S: Simd, const DAMPED: bool>(
    simd: S,
    sheet: &mut Sheet,
    rest: impl Iterator<Item = &'a Lane>,
    [from, to]: [usize; 2],
    rows: usize,
    constants: Scaled,
) {
    let end = |sheet: &Sheet, at: usize| {
        let position = Vec3x8::load(simd, &sheet.position[at]);
        let previous = if DAMPED { Vec3x8::load(simd, &sheet.previous[at]) } else { position };
        End { position, previous, inverse_mass: lane(simd, &sheet.inverse_mass[at]) }
    };
    let count = sheet.position.len();
    let mut here = end(sheet, to);
    // The first particle of the row is nobody's next one.
    let mut moved_before = here.position.ahead(here.position);
    for (at, rest) in (0..count).step_by(rows).zip(rest) {
        // After the last block comes nobody: there are no springs to it.
        let next = end(sheet, (at + rows + to).min(count - rows + to));
        let ahead = End {
            position: here.position.ahead(next.position),
            previous: if DAMPED { here.previous.ahead(next.previous) } else { here.position },
            inverse_mass: here.inverse_mass.slide::<1>(next.inverse_mass),
        };
        let rest = lane(simd, rest);
        let [a, b] = solve_abreast::<_, _, DAMPED>(simd, end(sheet, at + from), ahead, rest, constants);
        a.store(&mut sheet.position[at + from]);
        moved_before.behind(b).store(&mut sheet.position[at + to]);
        (here, moved_before) = (next, b);
    }
}
