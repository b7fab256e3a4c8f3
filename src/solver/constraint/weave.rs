//! The threads of a lattice: rows and columns as strands, and the diagonals of its cells as springs.
//!
//! Eight columns stand side by side in memory already. Eight rows are brought there by transposing their blocks, and
//! back.

use fearless_simd::{dispatch, f32x8, prelude::*};

use super::{
    spring::{End, Scaled, solve_eight},
    strand::{Pack, Row, Side},
};
use crate::solver::{
    Anchor, Lattice,
    lanes::{Block, Order},
    lattice::Threads,
    simd::{Instructions, LANES, Lane, lane, transpose},
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
    rows: Vec<Row>,
    position: Vec<Block>,
    previous: Vec<Block>,
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
pub(in crate::solver) fn masses_along_rows(lattice: &Lattice, inverse_mass: &[Lane], along_rows: &mut Vec<Lane>) {
    along_rows.clear();
    for first in (0..lattice.rows).step_by(LANES) {
        let count = LANES.min(lattice.rows - first);
        for column in inverse_mass.chunks_exact(lattice.rows) {
            let rows = &column[first..first + count];
            along_rows.extend(
                (0..LANES)
                    .map(|column| -> Lane { core::array::from_fn(|l| if l < count { rows[l][column] } else { 0.0 }) }),
            );
        }
    }
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
    loom.rows.resize(loom.rows.len().max(nodes).max(lattice.rows), Row::default());
    loom.position.resize(nodes, Block::default());
    loom.previous.resize(nodes, Block::default());
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
    let columns = sheet.position.chunks_exact_mut(rows).zip(sheet.inverse_mass.chunks_exact(rows)).enumerate();
    for (number, (position, inverse_mass)) in columns {
        let previous = if DAMPED { &sheet.previous[number * rows..][..rows] } else { &[] };
        let mut pack = Pack { position, previous, inverse_mass };
        solve_pack::<S, D, DAMPED>(simd, &mut pack, &lattice.along_columns, number, yarn, &mut loom.rows);
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
    for (number, first) in (0..rows).step_by(LANES).enumerate() {
        let some = first..(first + LANES).min(rows);
        for (nodes, column) in loom.position.chunks_exact_mut(LANES).zip(sheet.position.chunks_exact(rows)) {
            across(simd, &column[some.clone()], nodes);
        }
        if DAMPED {
            for (nodes, column) in loom.previous.chunks_exact_mut(LANES).zip(sheet.previous.chunks_exact(rows)) {
                across(simd, &column[some.clone()], nodes);
            }
        }
        let inverse_mass = &sheet.row_masses[number * nodes..][..nodes];
        let mut pack = Pack { position: &mut loom.position, previous: &loom.previous, inverse_mass };
        solve_pack::<S, D, DAMPED>(simd, &mut pack, &lattice.along_rows, number, yarn, &mut loom.rows);
        for (nodes, column) in loom.position.chunks_exact(LANES).zip(sheet.position.chunks_exact_mut(rows)) {
            across(simd, nodes, &mut column[some.clone()]);
        }
    }
}

#[inline(always)]
fn solve_pack<S: Simd, D: Side, const DAMPED: bool>(
    simd: S,
    pack: &mut Pack,
    threads: &Threads,
    number: usize,
    yarn: Yarn,
    rows: &mut [Row],
) {
    if let Some(bend) = yarn.bend {
        pack.solve_bends::<S, DAMPED>(simd, threads.bend(number), bend);
    }
    // What comes last is held best: stretch shows more than bending.
    if yarn.stretch.acts() {
        let rest = threads.stretch(number);
        if threads.closed {
            pack.solve::<S, D, DAMPED, true>(simd, rest, yarn, rows);
        } else {
            pack.solve::<S, D, DAMPED, false>(simd, rest, yarn, rows);
        }
    }
}

/// Turns up to eight blocks into up to eight others: lane i of block j becomes lane j of block i.
#[inline(always)]
fn across<S: Simd>(simd: S, from: &[Block], to: &mut [Block]) {
    for i in 0..3 {
        let mut tile = [f32x8::splat(simd, 0.0); LANES];
        for (values, block) in tile.iter_mut().zip(from) {
            *values = lane(simd, &block[i]);
        }
        for (block, values) in to.iter_mut().zip(transpose(tile)) {
            block[i] = values.into();
        }
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
    let end =
        |sheet: &Sheet, at: usize| End::load::<DAMPED>(simd, sheet.position, sheet.previous, sheet.inverse_mass, at);
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
        let [a, b] = solve_eight::<S, DAMPED>(simd, end(sheet, at + from), ahead, rest, constants);
        a.store(&mut sheet.position[at + from]);
        moved_before.behind(b).store(&mut sheet.position[at + to]);
        (here, moved_before) = (next, b);
    }
}
