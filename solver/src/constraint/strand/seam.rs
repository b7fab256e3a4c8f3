//! The seam between two bands of a lattice, which different threads may have solved.

use crate::{
    constraint::strand::{
        cells::{self, CellMaterial},
        shear_strands::ShearScratch,
    },
    layout::{
        order::Band,
        points::Block,
        simd::{Lane, SimdLevel},
    },
    particles::lanes::GridView,
    topology::lattice::Lattice,
};

/// The last row of a band and the first of the next, which have diagonals in common.
#[derive(Clone, Debug, Default)]
pub(crate) struct Seam {
    position: Vec<Block>,
    previous: Vec<Block>,
    inverse_mass: Vec<Lane>,
}

impl Seam {
    /// Takes the last row of the band above, which is the seam's row 0, or the first row of the band below, its row 1.
    pub fn take(&mut self, part: &GridView, band: Band, row: usize) {
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
    pub fn solve(
        &mut self,
        below: Band,
        lattice: &Lattice,
        cell_material: CellMaterial,
        shear_scratch: &mut ShearScratch,
        simd_level: SimdLevel,
    ) {
        let Self { position, previous, inverse_mass } = self;
        let mut grid = GridView { position, previous, inverse_mass, row_masses: &[] };
        cells::solve_pairs(&mut grid, 2, below.first - 1, 0, lattice, cell_material, shear_scratch, simd_level);
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
