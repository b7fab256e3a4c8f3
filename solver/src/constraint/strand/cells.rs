//! What holds the cells of a lattice in shape: the springs along their diagonals, and what resists their being twisted.
//!
//! ```text
//!   o       o       o       row           \ falling      / rising
//!     \   /   \   /
//!     /   \   /   \
//!   o       o       o       next row
//! ```
//!
//! Of a sheet, diagonals are strands along the bias, solved exactly in [`shear_strands`](crate::constraint::strand::shear_strands).
//! Plain springs are solved each for itself, in [`diagonal`](crate::constraint::unstructured::diagonal): those between two rows
//! have no particle in common with those between the next two but one.

use fearless_simd::{dispatch, f32x8, prelude::*};

use crate::{
    constraint::{
        strand::{
            bend_factors::BendFactors,
            law::Scaled,
            seam::Seam,
            shear_strands::{ShearScratch, ShearStrands},
            twist,
        },
        unstructured::diagonal,
    },
    layout::{
        order::Band,
        simd::{SimdLevel, Vec3x8, lane},
    },
    material::{Elasticity, Material, SpringConstants},
    particles::{gathered::End, lanes::GridView},
    topology::{SpringKind, lattice::Lattice},
};

/// What cells resist.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CellMaterial<'a> {
    /// The springs along diagonals: those of the whole stiffness.
    pub spring: Scaled,
    /// Whether cells have a part of it, as those of a sheet do, instead of all being alike.
    pub is_sheet: bool,
    /// B h² and its damping. None where nothing resists being twisted.
    pub rigidity: Option<Scaled>,
    /// What twists are at rest.
    pub bend_factors: &'a BendFactors,
}

impl<'a> CellMaterial<'a> {
    pub fn new(material: &Material, h: f32, bend_factors: &'a BendFactors) -> Self {
        match &material.elasticity {
            Elasticity::Springs(constants) => {
                let spring = Scaled::new(constants[SpringKind::Shear.index()], h);
                Self { spring, is_sheet: false, rigidity: None, bend_factors }
            }
            Elasticity::Moduli(moduli) => {
                let shear = SpringConstants { stiffness: moduli.shear, damping: moduli.shear * moduli.stretch_damping };
                let rigidity = Some(Scaled::new(moduli.rigidity(), h)).filter(Scaled::acts);
                Self { spring: Scaled::new(shear, h), is_sheet: true, rigidity, bend_factors }
            }
        }
    }
}

/// Solves the diagonals of all cells: those between an even row and the next, then those below.
pub(crate) fn solve(
    grid: &mut GridView,
    lattice: &Lattice,
    cell_material: CellMaterial,
    seam: &mut Seam,
    shear_scratch: &mut ShearScratch,
    simd_level: SimdLevel,
) {
    let bands = lattice.order().bands();
    for parity in [0, 1] {
        for band in bands.clone() {
            solve_band(&mut grid.band(band), band, parity, lattice, cell_material, shear_scratch, simd_level);
        }
    }
    for (upper, lower) in bands.clone().zip(bands.skip(1)) {
        for (band, row) in [(upper, 0), (lower, 1)] {
            seam.take(&grid.band(band), band, row);
        }
        seam.solve(lower, lattice, cell_material, shear_scratch, simd_level);
        for (band, row) in [(upper, 0), (lower, 1)] {
            seam.put(grid.band(band).position, band, row);
        }
    }
}

/// Solves the diagonals between rows of a band: those below its even rows, or those below the odd ones.
pub(crate) fn solve_band(
    grid: &mut GridView,
    band: Band,
    parity: usize,
    lattice: &Lattice,
    cell_material: CellMaterial,
    shear_scratch: &mut ShearScratch,
    simd_level: SimdLevel,
) {
    solve_pairs(grid, band.rows, band.first, parity, lattice, cell_material, shear_scratch, simd_level);
}

/// The same in a part of so many `rows`, whose `first` has that number in the lattice.
#[expect(clippy::too_many_arguments, reason = "what is solved, where, with what")]
pub(crate) fn solve_pairs(
    grid: &mut GridView,
    rows: usize,
    first: usize,
    parity: usize,
    lattice: &Lattice,
    cell_material: CellMaterial,
    shear_scratch: &mut ShearScratch,
    simd_level: SimdLevel,
) {
    let level = simd_level.level();
    let some = (parity..rows - 1).step_by(2);
    let pairs = RowPairs { lattice, rows, first, cell_material };
    if let Some(rigidity) = cell_material.rigidity {
        let some = some.clone();
        if rigidity.c > 0.0 {
            dispatch!(level, simd => twist::solve::<_, true>(simd, &pairs, grid, some, rigidity));
        } else {
            dispatch!(level, simd => twist::solve::<_, false>(simd, &pairs, grid, some, rigidity));
        }
    }
    match (cell_material.is_sheet, cell_material.spring.c > 0.0) {
        _ if !cell_material.spring.acts() => {}
        (false, false) => dispatch!(level, simd => diagonal::solve::<_, false>(simd, &pairs, grid, some)),
        (false, true) => dispatch!(level, simd => diagonal::solve::<_, true>(simd, &pairs, grid, some)),
        // All rows at once.
        (true, _) if parity > 0 => {}
        (true, false) => dispatch!(level, simd => pairs.solve_bias::<_, false>(simd, grid, shear_scratch)),
        (true, true) => dispatch!(level, simd => pairs.solve_bias::<_, true>(simd, grid, shear_scratch)),
    }
}

/// Rows of a part of a lattice that has so many `rows`, the `first` of them having that number in the lattice.
pub(crate) struct RowPairs<'a> {
    pub lattice: &'a Lattice,
    pub rows: usize,
    pub first: usize,
    pub cell_material: CellMaterial<'a>,
}

impl RowPairs<'_> {
    /// What the lattice has for each block of a row.
    pub fn of_row<'b, T>(&self, all: &'b [T], row: usize) -> impl Iterator<Item = &'b T> + use<'b, T> {
        all.get(self.first + row..).unwrap_or_default().iter().step_by(self.lattice.rows)
    }

    #[inline(always)]
    pub fn end<S: Simd, const DAMPED: bool>(&self, simd: S, grid: &GridView, at: usize) -> End<f32x8<S>> {
        let position = Vec3x8::load(simd, &grid.position[at]);
        let previous = if DAMPED { Vec3x8::load(simd, &grid.previous[at]) } else { position };
        End { position, previous, inverse_mass: lane(simd, &grid.inverse_mass[at]) }
    }

    /// The block at a place, and the one below.
    #[inline(always)]
    pub fn ends<S: Simd, const DAMPED: bool>(&self, simd: S, grid: &GridView, at: usize) -> [End<f32x8<S>>; 2] {
        [self.end::<S, DAMPED>(simd, grid, at), self.end::<S, DAMPED>(simd, grid, at + 1)]
    }

    /// Solves the diagonals of a sheet as strands.
    #[inline(always)]
    fn solve_bias<S: Simd, const DAMPED: bool>(&self, simd: S, grid: &mut GridView, shear_scratch: &mut ShearScratch) {
        let Scaled { k, c } = self.cell_material.spring;
        let Lattice { rows: stride, falling, rising, diagonal_shares: [of_falling, of_rising], .. } = self.lattice;
        let first = self.first;
        let diagonals = |rest, shares| ShearStrands { rows: self.rows, rest, shares, stride: *stride, spring: [k, c] };
        diagonals(&falling[first..], &of_falling[first..]).solve::<S, false, DAMPED>(simd, grid, shear_scratch);
        diagonals(&rising[first..], &of_rising[first..]).solve::<S, true, DAMPED>(simd, grid, shear_scratch);
    }
}
