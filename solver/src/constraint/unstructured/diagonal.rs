//! The springs along the diagonals of a lattice's cells, each solved for itself, eight at a time: plain ones, which aren't strands.

use fearless_simd::prelude::*;

use crate::{
    constraint::{strand::cells::RowPairs, unstructured::spring::solve_abreast},
    layout::simd::{Lane, lane},
    particles::{gathered::End, lanes::GridView},
};

/// Solves the diagonals below `some` rows one by one.
#[inline(always)]
pub(crate) fn solve<S: Simd, const DAMPED: bool>(
    simd: S,
    pairs: &RowPairs,
    grid: &mut GridView,
    some: impl Iterator<Item = usize>,
) {
    for row in some {
        let falling = (&*pairs.lattice.falling, [row, row + 1]);
        let rising = (&*pairs.lattice.rising, [row + 1, row]);
        // By turns, so that what comes first doesn't set the cloth spinning.
        let both = if (pairs.first + row) % 4 < 2 { [falling, rising] } else { [rising, falling] };
        for (rest, ends) in both {
            solve_row_pair::<S, DAMPED>(simd, pairs, grid, row, rest, ends);
        }
    }
}

/// Solves the springs from each particle of one row to the next column of another. `rest` has their lengths, m.
#[inline(always)]
fn solve_row_pair<S: Simd, const DAMPED: bool>(
    simd: S,
    pairs: &RowPairs,
    grid: &mut GridView,
    row: usize,
    rest: &[Lane],
    [from, to]: [usize; 2],
) {
    let (count, spring) = (grid.position.len(), pairs.cell_material.spring);
    let mut here = pairs.end::<S, DAMPED>(simd, grid, to);
    // The first particle of the row is nobody's next one.
    let mut moved_before = here.position.ahead(here.position);
    for (at, rest) in (0..count).step_by(pairs.rows).zip(pairs.of_row(rest, row)) {
        // After the last block comes nobody: there are no springs to it.
        let next = pairs.end::<S, DAMPED>(simd, grid, (at + pairs.rows + to).min(count - pairs.rows + to));
        let ahead = End {
            position: here.position.ahead(next.position),
            previous: if DAMPED { here.previous.ahead(next.previous) } else { here.position },
            inverse_mass: here.inverse_mass.slide::<1>(next.inverse_mass),
        };
        let (end, rest) = (pairs.end::<S, DAMPED>(simd, grid, at + from), lane(simd, rest));
        let [a, b] = solve_abreast::<_, _, DAMPED>(simd, end, ahead, rest, spring);
        a.store(&mut grid.position[at + from]);
        moved_before.behind(b).store(&mut grid.position[at + to]);
        (here, moved_before) = (next, b);
    }
}
