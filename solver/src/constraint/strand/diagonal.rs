//! The diagonals of a lattice's cells, eight at a time: the springs against shear. Those of a sheet are strands, in
//! [`shear_scratch`](crate::constraint::strand::shear_strands).
//!
//! ```text
//!   o       o       o       row           \ falling      / rising
//!     \   /   \   /
//!     /   \   /   \
//!   o       o       o       next row
//! ```
//!
//! Those between two rows have no particle in common with those between the next two but one. They aren't strands: each
//! is solved for itself.
//!
//! The cells of a sheet also resist being twisted: with the energy B/2 |T|² of T = t (x00 + x11 - x01 - x10), as
//! [`Bend`](crate::topology::Bend) has it. It is linear in the positions, and so is its answer.

use fearless_simd::{dispatch, f32x8, prelude::*};

use crate::{
    constraint::{
        strand::{
            bend_factors::BendFactors,
            law::Scaled,
            shear_strands::{ShearScratch, ShearStrands},
        },
        unstructured::spring::solve_abreast,
    },
    layout::{
        order::Band,
        points::Block,
        simd::{Lane, SimdLevel, Vec3x8, lane},
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
    strand_material: CellMaterial,
    seam: &mut Seam,
    shear_scratch: &mut ShearScratch,
    simd_level: SimdLevel,
) {
    let bands = lattice.order().bands();
    for parity in [0, 1] {
        for band in bands.clone() {
            solve_band(&mut grid.band(band), band, parity, lattice, strand_material, shear_scratch, simd_level);
        }
    }
    for (upper, lower) in bands.clone().zip(bands.skip(1)) {
        for (band, row) in [(upper, 0), (lower, 1)] {
            seam.take(&grid.band(band), band, row);
        }
        seam.solve(lower, lattice, strand_material, shear_scratch, simd_level);
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
    strand_material: CellMaterial,
    shear_scratch: &mut ShearScratch,
    simd_level: SimdLevel,
) {
    solve_pairs(grid, band.rows, band.first, parity, lattice, strand_material, shear_scratch, simd_level);
}

#[expect(clippy::too_many_arguments, reason = "what is solved, where, with what")]
/// The same in a sheet of so many `rows`, whose `first` is its number in the lattice.
fn solve_pairs(
    grid: &mut GridView,
    rows: usize,
    first: usize,
    parity: usize,
    lattice: &Lattice,
    strand_material: CellMaterial,
    shear_scratch: &mut ShearScratch,
    simd_level: SimdLevel,
) {
    let level = simd_level.level();
    let some = (parity..rows - 1).step_by(2);
    let pairs = RowPairs { lattice, rows, first, strand_material };
    if let Some(rigidity) = strand_material.rigidity {
        let some = some.clone();
        if rigidity.c > 0.0 {
            dispatch!(level, simd => pairs.solve_twists::<_, true>(simd, grid, some, rigidity));
        } else {
            dispatch!(level, simd => pairs.solve_twists::<_, false>(simd, grid, some, rigidity));
        }
    }
    match (strand_material.is_sheet, strand_material.spring.c > 0.0) {
        _ if !strand_material.spring.acts() => {}
        (false, false) => dispatch!(level, simd => pairs.solve_diagonals::<_, false>(simd, grid, some)),
        (false, true) => dispatch!(level, simd => pairs.solve_diagonals::<_, true>(simd, grid, some)),
        // All rows at once.
        (true, _) if parity > 0 => {}
        (true, false) => dispatch!(level, simd => pairs.solve_bias::<_, false>(simd, grid, shear_scratch)),
        (true, true) => dispatch!(level, simd => pairs.solve_bias::<_, true>(simd, grid, shear_scratch)),
    }
}

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
        strand_material: CellMaterial,
        shear_scratch: &mut ShearScratch,
        simd_level: SimdLevel,
    ) {
        let Self { position, previous, inverse_mass } = self;
        let mut grid = GridView { position, previous, inverse_mass, row_masses: &[] };
        solve_pairs(&mut grid, 2, below.first - 1, 0, lattice, strand_material, shear_scratch, simd_level);
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

/// Rows of a sheet that has so many `rows`, the `first` of them having that number in the lattice.
struct RowPairs<'a> {
    lattice: &'a Lattice,
    rows: usize,
    first: usize,
    strand_material: CellMaterial<'a>,
}

impl RowPairs<'_> {
    /// What the lattice has for each block of a row.
    fn of_row<'b, T>(&self, all: &'b [T], row: usize) -> impl Iterator<Item = &'b T> + use<'b, T> {
        all.get(self.first + row..).unwrap_or_default().iter().step_by(self.lattice.rows)
    }

    #[inline(always)]
    fn end<S: Simd, const DAMPED: bool>(&self, simd: S, grid: &GridView, at: usize) -> End<f32x8<S>> {
        let position = Vec3x8::load(simd, &grid.position[at]);
        let previous = if DAMPED { Vec3x8::load(simd, &grid.previous[at]) } else { position };
        End { position, previous, inverse_mass: lane(simd, &grid.inverse_mass[at]) }
    }

    /// The block at a place, and the one below.
    #[inline(always)]
    fn ends<S: Simd, const DAMPED: bool>(&self, simd: S, grid: &GridView, at: usize) -> [End<f32x8<S>>; 2] {
        [self.end::<S, DAMPED>(simd, grid, at), self.end::<S, DAMPED>(simd, grid, at + 1)]
    }

    /// Solves the diagonals of a sheet as strands.
    #[inline(always)]
    fn solve_bias<S: Simd, const DAMPED: bool>(&self, simd: S, grid: &mut GridView, shear_scratch: &mut ShearScratch) {
        let Scaled { k, c } = self.strand_material.spring;
        let Lattice { rows: stride, falling, rising, cell_shares, .. } = self.lattice;
        let shares = &cell_shares[self.first..];
        let diagonals = |rest| ShearStrands { rows: self.rows, rest, shares, stride: *stride, spring: [k, c] };
        diagonals(&falling[self.first..]).solve::<S, false, DAMPED>(simd, grid, shear_scratch);
        diagonals(&rising[self.first..]).solve::<S, true, DAMPED>(simd, grid, shear_scratch);
    }

    /// Solves the diagonals below `some` rows one by one.
    #[inline(always)]
    fn solve_diagonals<S: Simd, const DAMPED: bool>(
        &self,
        simd: S,
        grid: &mut GridView,
        some: impl Iterator<Item = usize>,
    ) {
        for row in some {
            let falling = (&*self.lattice.falling, [row, row + 1]);
            let rising = (&*self.lattice.rising, [row + 1, row]);
            // By turns, so that what comes first doesn't set the cloth spinning.
            let pairs = if (self.first + row) % 4 < 2 { [falling, rising] } else { [rising, falling] };
            for (rest, ends) in pairs {
                self.solve_row_pair::<S, DAMPED>(simd, grid, row, rest, ends);
            }
        }
    }

    /// Solves the springs from each particle of one row to the next column of another. `rest` has their lengths, m.
    #[inline(always)]
    fn solve_row_pair<S: Simd, const DAMPED: bool>(
        &self,
        simd: S,
        grid: &mut GridView,
        row: usize,
        rest: &[Lane],
        [from, to]: [usize; 2],
    ) {
        let (count, spring) = (grid.position.len(), self.strand_material.spring);
        let mut here = self.end::<S, DAMPED>(simd, grid, to);
        // The first particle of the row is nobody's next one.
        let mut moved_before = here.position.ahead(here.position);
        for (at, rest) in (0..count).step_by(self.rows).zip(self.of_row(rest, row)) {
            // After the last block comes nobody: there are no springs to it.
            let next = self.end::<S, DAMPED>(simd, grid, (at + self.rows + to).min(count - self.rows + to));
            let ahead = End {
                position: here.position.ahead(next.position),
                previous: if DAMPED { here.previous.ahead(next.previous) } else { here.position },
                inverse_mass: here.inverse_mass.slide::<1>(next.inverse_mass),
            };
            let (end, rest) = (self.end::<S, DAMPED>(simd, grid, at + from), lane(simd, rest));
            let [a, b] = solve_abreast::<_, _, DAMPED>(simd, end, ahead, rest, spring);
            a.store(&mut grid.position[at + from]);
            moved_before.behind(b).store(&mut grid.position[at + to]);
            (here, moved_before) = (next, b);
        }
    }

    /// Solves the twists of the cells below `some` rows, all cells of a row at once.
    #[inline(always)]
    fn solve_twists<S: Simd, const DAMPED: bool>(
        &self,
        simd: S,
        grid: &mut GridView,
        some: impl Iterator<Item = usize>,
        rigidity: Scaled,
    ) {
        let count = grid.position.len();
        let (nothing, one) = (Vec3x8::splat(simd, [0.0; 3]), f32x8::splat(simd, 1.0));
        // Each corner is in two of the cells that are solved at once: they share its mass.
        let total = 2.0 * (rigidity.k + rigidity.c);
        for row in some {
            let mut rest = self.of_row(&self.strand_material.bend_factors.rest.cells, row);
            let mut here = self.ends::<S, DAMPED>(simd, grid, row);
            let mut pull_before = nothing;
            for (at, weight) in (0..count).step_by(self.rows).zip(self.of_row(&self.lattice.twist, row)) {
                let weight = lane(simd, weight);
                let next = self.ends::<S, DAMPED>(simd, grid, (at + self.rows).min(count - self.rows) + row);
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
}
