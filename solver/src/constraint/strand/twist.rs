//! What resists that the cells of a sheet are twisted: with the energy B/2 |T|² of T = t (x00 + x11 - x01 - x10), as
//! [`Bend`](crate::topology::Bend) has it. It is linear in the positions, and so is its answer.

use fearless_simd::{f32x8, prelude::*};

use crate::{
    constraint::strand::{cells::RowPairs, law::Scaled},
    layout::simd::{Vec3x8, lane},
    particles::lanes::GridView,
};

/// Solves the twists of the cells below `some` rows, all cells of a row at once.
#[inline(always)]
pub(crate) fn solve<S: Simd, const DAMPED: bool>(
    simd: S,
    pairs: &RowPairs,
    grid: &mut GridView,
    some: impl Iterator<Item = usize>,
    rigidity: Scaled,
) {
    let count = grid.position.len();
    let (nothing, one) = (Vec3x8::splat(simd, [0.0; 3]), f32x8::splat(simd, 1.0));
    // Each corner is in two of the cells that are solved at once: they share its mass.
    let total = 2.0 * (rigidity.k + rigidity.c);
    for row in some {
        let mut rest = pairs.of_row(&pairs.cell_material.bend_factors.rest.cells, row);
        let mut here = pairs.ends::<S, DAMPED>(simd, grid, row);
        let mut pull_before = nothing;
        for (at, weight) in (0..count).step_by(pairs.rows).zip(pairs.of_row(&pairs.lattice.twist, row)) {
            let weight = lane(simd, weight);
            let next = pairs.ends::<S, DAMPED>(simd, grid, (at + pairs.rows).min(count - pairs.rows) + row);
            // From a corner to the one below, and how that changes from column to column.
            let down = here[0].position - here[1].position;
            let twist = (down - down.ahead(next[0].position - next[1].position)) * weight;
            let mut right = twist;
            if let Some(rest) = rest.next() {
                right = right - Vec3x8::load(simd, rest);
            }
            if DAMPED {
                let was = here[0].previous - here[1].previous;
                let was = (was - was.ahead(next[0].previous - next[1].previous)) * weight;
                right = right + (twist - was) * f32x8::splat(simd, rigidity.c / rigidity.k);
            }
            let masses = here[0].inverse_mass + here[1].inverse_mass;
            let masses = masses + masses.slide::<1>(next[0].inverse_mass + next[1].inverse_mass);
            let pull = right * (weight * -rigidity.k / (masses * (weight * weight) * total + one));
            let by = pull - pull_before.behind(pull);
            let [above, below] = here;
            (above.position + by * above.inverse_mass).store(&mut grid.position[at + row]);
            (below.position - by * below.inverse_mass).store(&mut grid.position[at + row + 1]);
            (here, pull_before) = (next, pull);
        }
    }
}
