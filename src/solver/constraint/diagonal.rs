//! The diagonals of a lattice's cells, eight at a time: the springs against shear.
//!
//! ```text
//!   o       o       o       row           \ falling      / rising
//!     \   /   \   /
//!     /   \   /   \
//!   o       o       o       next row
//! ```
//!
//! Those between two rows have no particle in common with those between the next two but one. They aren't threads: each
//! is solved for itself.

use fearless_simd::{dispatch, prelude::*};

use super::{
    spring::{End, Scaled, solve_abreast},
    weave::Sheet,
};
use crate::solver::{
    Lattice,
    lanes::Block,
    order::Band,
    simd::{Instructions, Lane, Vec3x8, lane},
};

/// Solves the diagonals of all cells: those between an even row and the next, then those below.
pub(in crate::solver) fn solve(
    sheet: &mut Sheet,
    lattice: &Lattice,
    constants: Scaled,
    seam: &mut Seam,
    instructions: Instructions,
) {
    let bands = lattice.order().bands();
    for parity in [0, 1] {
        for band in bands.clone() {
            solve_band(&mut sheet.band(band), band, parity, lattice, constants, instructions);
        }
    }
    for (upper, lower) in bands.clone().zip(bands.skip(1)) {
        for (band, row) in [(upper, 0), (lower, 1)] {
            seam.take(&sheet.band(band), band, row);
        }
        seam.solve(lower, lattice, constants, instructions);
        for (band, row) in [(upper, 0), (lower, 1)] {
            seam.put(sheet.band(band).position, band, row);
        }
    }
}

/// Solves the diagonals between rows of a band: those below its even rows, or those below the odd ones.
pub(in crate::solver) fn solve_band(
    sheet: &mut Sheet,
    band: Band,
    parity: usize,
    lattice: &Lattice,
    constants: Scaled,
    instructions: Instructions,
) {
    solve_pairs(sheet, band.rows, band.first, parity, lattice, constants, instructions);
}

/// The same in a sheet of so many `rows`, whose `first` is its number in the lattice.
fn solve_pairs(
    sheet: &mut Sheet,
    rows: usize,
    first: usize,
    parity: usize,
    lattice: &Lattice,
    constants: Scaled,
    instructions: Instructions,
) {
    let level = instructions.level();
    let some = (parity..rows - 1).step_by(2);
    if constants.c > 0.0 {
        dispatch!(level, simd => solve_eights::<_, true>(simd, sheet, rows, first, some, lattice, constants));
    } else if constants.k > 0.0 {
        dispatch!(level, simd => solve_eights::<_, false>(simd, sheet, rows, first, some, lattice, constants));
    }
}

/// The last row of a band and the first of the next, which have diagonals in common.
#[derive(Clone, Debug, Default)]
pub(in crate::solver) struct Seam {
    position: Vec<Block>,
    previous: Vec<Block>,
    inverse_mass: Vec<Lane>,
}

impl Seam {
    /// Takes the last row of the band above, which is the seam's row 0, or the first row of the band below, its row 1.
    pub fn take(&mut self, part: &Sheet, band: Band, row: usize) {
        let packs = part.position.len() / band.rows;
        for blocks in [&mut self.position, &mut self.previous] {
            blocks.resize(2 * packs, Block::default());
        }
        self.inverse_mass.resize(2 * packs, Lane::default());
        for pack in 0..packs {
            let (from, to) = (Self::block(band, row, pack), 2 * pack + row);
            self.position[to] = part.position[from];
            self.previous[to] = part.previous[from];
            self.inverse_mass[to] = part.inverse_mass[from];
        }
    }

    /// Solves the diagonals above the band `below`.
    pub fn solve(&mut self, below: Band, lattice: &Lattice, constants: Scaled, instructions: Instructions) {
        let Self { position, previous, inverse_mass } = self;
        let mut sheet = Sheet { position, previous, inverse_mass, row_masses: &[] };
        solve_pairs(&mut sheet, 2, below.first - 1, 0, lattice, constants, instructions);
    }

    /// Puts a row back.
    pub fn put(&self, position: &mut [Block], band: Band, row: usize) {
        for pack in 0..position.len() / band.rows {
            position[Self::block(band, row, pack)] = self.position[2 * pack + row];
        }
    }

    fn block(band: Band, row: usize, pack: usize) -> usize {
        pack * band.rows + if row == 0 { band.rows - 1 } else { 0 }
    }
}

#[inline(always)]
fn solve_eights<S: Simd, const DAMPED: bool>(
    simd: S,
    sheet: &mut Sheet,
    rows: usize,
    first: usize,
    some: impl Iterator<Item = usize>,
    lattice: &Lattice,
    constants: Scaled,
) {
    for row in some {
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
