//! The threads of a lattice: rows and columns as strands, and the diagonals of its cells as springs.
//!
//! Eight columns stand side by side in memory already. Eight rows are brought there by transposing their blocks, and
//! back.

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
    fn is_damped(&self) -> bool {
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

/// Solves all columns and all rows.
pub(in crate::solver) fn solve<D: Side>(
    sheet: &mut Sheet,
    lattice: &Lattice,
    yarn: Yarn,
    last: Last,
    loom: &mut Loom,
    instructions: Instructions,
) {
    let nodes = lattice.along_rows.nodes;
    loom.make_room(2 * nodes.max(lattice.rows));
    let level = instructions.level();
    let order = match last {
        Last::Rows => [Last::Columns, Last::Rows],
        Last::Columns => [Last::Rows, Last::Columns],
    };
    for threads in order {
        match (threads, yarn.is_damped()) {
            (Last::Columns, false) => {
                dispatch!(level, simd => solve_columns::<_, D, false>(simd, sheet, lattice, yarn, loom));
            }
            (Last::Columns, true) => {
                dispatch!(level, simd => solve_columns::<_, D, true>(simd, sheet, lattice, yarn, loom));
            }
            (Last::Rows, false) => {
                dispatch!(level, simd => solve_rows::<_, D, false>(simd, sheet, lattice, yarn, loom));
            }
            (Last::Rows, true) => {
                dispatch!(level, simd => solve_rows::<_, D, true>(simd, sheet, lattice, yarn, loom));
            }
        }
    }
}

#[inline(always)]
fn solve_columns<S: Simd, D: Side, const DAMPED: bool>(
    simd: S,
    sheet: &mut Sheet,
    lattice: &Lattice,
    yarn: Yarn,
    loom: &mut Loom,
) {
    let rows = lattice.rows;
    let pairs = sheet.position.chunks_mut(2 * rows).zip(sheet.inverse_mass.chunks(2 * rows)).enumerate();
    for (pair, (position, inverse_mass)) in pairs {
        let previous = if DAMPED { &sheet.previous[pair * 2 * rows..][..position.len()] } else { &[] };
        let mut pack = Pack { position, previous, inverse_mass, stride: rows };
        solve_packs::<S, D, DAMPED>(simd, &mut pack, &lattice.along_columns, 2 * pair, yarn, &mut loom.rows);
    }
}

#[inline(always)]
fn solve_rows<S: Simd, D: Side, const DAMPED: bool>(
    simd: S,
    sheet: &mut Sheet,
    lattice: &Lattice,
    yarn: Yarn,
    loom: &mut Loom,
) {
    let rows = lattice.rows;
    let nodes = lattice.along_rows.nodes;
    for first in (0..rows).step_by(2 * LANES) {
        let packs = (first..rows.min(first + 2 * LANES)).step_by(LANES).map(|row| row..rows.min(row + LANES));
        for (some, position) in packs.clone().zip(loom.position.chunks_exact_mut(nodes)) {
            for (nodes, column) in position.chunks_exact_mut(LANES).zip(sheet.position.chunks_exact(rows)) {
                blocks_across(simd, &column[some.clone()], nodes);
            }
        }
        if DAMPED {
            for (some, previous) in packs.clone().zip(loom.previous.chunks_exact_mut(nodes)) {
                for (nodes, column) in previous.chunks_exact_mut(LANES).zip(sheet.previous.chunks_exact(rows)) {
                    blocks_across(simd, &column[some.clone()], nodes);
                }
            }
        }
        let number = first / LANES;
        let all = packs.len() * nodes;
        let inverse_mass = &sheet.row_masses[number * nodes..][..all];
        let mut pack =
            Pack { position: &mut loom.position[..all], previous: &loom.previous, inverse_mass, stride: nodes };
        solve_packs::<S, D, DAMPED>(simd, &mut pack, &lattice.along_rows, number, yarn, &mut loom.rows);
        for (some, position) in packs.zip(loom.position.chunks_exact(nodes)) {
            for (nodes, column) in position.chunks_exact(LANES).zip(sheet.position.chunks_exact_mut(rows)) {
                blocks_across(simd, nodes, &mut column[some.clone()]);
            }
        }
    }
}

/// Solves one or two packs of threads, from that with a `number` on.
#[inline(always)]
fn solve_packs<S: Simd, D: Side, const DAMPED: bool>(
    simd: S,
    pack: &mut Pack,
    threads: &Threads,
    number: usize,
    yarn: Yarn,
    rows: &mut Rows,
) {
    if pack.position.len() > pack.stride {
        solve_threads::<S, f32x16<S>, D, DAMPED>(simd, pack, threads, number, yarn, rows);
    } else {
        solve_threads::<S, f32x8<S>, D, DAMPED>(simd, pack, threads, number, yarn, rows);
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

/// Solves the diagonals of all cells: those between an even row and the next, then those below.
pub(in crate::solver) fn solve_diagonals(
    sheet: &mut Sheet,
    lattice: &Lattice,
    constants: Scaled,
    instructions: Instructions,
) {
    let level = instructions.level();
    if constants.c > 0.0 {
        dispatch!(level, simd => solve_all_diagonals::<_, true>(simd, sheet, lattice, constants));
    } else if constants.k > 0.0 {
        dispatch!(level, simd => solve_all_diagonals::<_, false>(simd, sheet, lattice, constants));
    }
}

#[inline(always)]
fn solve_all_diagonals<S: Simd, const DAMPED: bool>(simd: S, sheet: &mut Sheet, lattice: &Lattice, constants: Scaled) {
    for parity in [0, 1] {
        for row in (parity..lattice.rows - 1).step_by(2) {
            let falling = (&lattice.falling, [row, row + 1]);
            let rising = (&lattice.rising, [row + 1, row]);
            // By turns, so that what comes first doesn't set the cloth spinning.
            let pairs = if row % 4 < 2 { [falling, rising] } else { [rising, falling] };
            for (rest, rows) in pairs {
                solve_row_pair::<S, DAMPED>(simd, sheet, rest, row, rows, lattice.rows, constants);
            }
        }
    }
}

/// Solves the springs from each particle of one row to the next column of another. `rest` has their lengths (m) at the
/// blocks of row `upper`.
#[inline(always)]
fn solve_row_pair<S: Simd, const DAMPED: bool>(
    simd: S,
    sheet: &mut Sheet,
    rest: &[Lane],
    upper: usize,
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
    for at in (0..count).step_by(rows) {
        // After the last block comes nobody: there are no springs to it.
        let next = end(sheet, (at + rows + to).min(count - rows + to));
        let ahead = End {
            position: here.position.ahead(next.position),
            previous: if DAMPED { here.previous.ahead(next.previous) } else { here.position },
            inverse_mass: here.inverse_mass.slide::<1>(next.inverse_mass),
        };
        let rest = lane(simd, &rest[at + upper]);
        let [a, b] = solve_abreast::<_, _, DAMPED>(simd, end(sheet, at + from), ahead, rest, constants);
        a.store(&mut sheet.position[at + from]);
        moved_before.behind(b).store(&mut sheet.position[at + to]);
        (here, moved_before) = (next, b);
    }
}
