//! Strands along the bias against their whole matrix.

use bevy_math::{DVec3, Vec3A};
use fastrand::Rng;
use fearless_simd::dispatch;
use proptest::prelude::*;

use super::*;
use crate::{constraint::strand::dense::Strand, layout::simd::SimdLevel};

/// Particles in rows and columns, and the diagonals between them of one kind.
struct Cells {
    rows: usize,
    columns: usize,
    /// Rows of the lattice that these are the first of.
    stride: usize,
    rising: bool,
    position: Vec<Block>,
    previous: Vec<Block>,
    inverse_mass: Vec<Lane>,
    rest: Vec<Lane>,
    shares: Vec<Lane>,
}

impl Cells {
    /// Cells of about a square metre, of which some particles are fixed and some diagonals missing.
    fn new([rows, columns, stride]: [usize; 3], rising: bool, rng: &mut Rng) -> Self {
        let packs = columns.div_ceil(LANES);
        let mut cells = Self {
            rows,
            columns,
            stride,
            rising,
            position: vec![Block::default(); packs * rows],
            previous: vec![Block::default(); packs * rows],
            inverse_mass: vec![Lane::default(); packs * rows],
            rest: vec![Lane::default(); packs * stride],
            shares: vec![Lane::default(); packs * stride],
        };
        for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
            let ((at, lane), of_cell) = (cells.slot(row, column), column / LANES * stride + row);
            for (axis, place) in [column as f32, 0.0, row as f32].into_iter().enumerate() {
                cells.position[at][axis][lane] = place + 0.5 * rng.f32();
                cells.previous[at][axis][lane] = cells.position[at][axis][lane] + 0.1 * rng.f32();
            }
            cells.inverse_mass[at][lane] = if rng.u32(0..5) == 0 { 0.0 } else { 0.2 + 2.0 * rng.f32() };
            if row + 1 < rows && column + 1 < columns && rng.u32(0..8) > 0 {
                cells.rest[of_cell][lane] = 1.0 + rng.f32();
                cells.shares[of_cell][lane] = 0.5 + rng.f32();
            }
        }
        cells
    }

    /// Block and lane of a particle.
    fn slot(&self, row: usize, column: usize) -> (usize, usize) {
        (column / LANES * self.rows + row, column % LANES)
    }

    /// The particles of each strand, from row to row.
    fn strands(&self) -> Vec<Vec<(usize, usize)>> {
        let (rows, columns) = (self.rows as isize, self.columns as isize);
        let step = if self.rising { -1 } else { 1 };
        let strand = |first: isize| {
            let on = (0..rows).map(|row| (row as usize, first + step * row));
            on.filter(|(_, column)| (0..columns).contains(column)).map(|(row, column)| (row, column as usize)).collect()
        };
        (-rows..columns + rows).map(strand).collect()
    }

    fn strand(&self, strand: &[(usize, usize)], spring: [f32; 2]) -> Strand {
        let place = |blocks: &[Block], (row, column): (usize, usize)| {
            let (at, lane) = self.slot(row, column);
            Vec3A::from_array(blocks[at].map(|lanes| lanes[lane])).as_dvec3()
        };
        // A cell's diagonals are where its first column is.
        let of_cell = |lanes: &[Lane], [from, to]: [(usize, usize); 2]| {
            let column = from.1.min(to.1);
            lanes[column / LANES * self.stride + from.0][column % LANES]
        };
        let pairs = || strand.windows(2).map(|pair| [pair[0], pair[1]]);
        Strand {
            position: strand.iter().map(|&at| place(&self.position, at)).collect(),
            previous: strand.iter().map(|&at| place(&self.previous, at)).collect(),
            inverse_mass: strand
                .iter()
                .map(|&(row, column)| {
                    let (at, lane) = self.slot(row, column);
                    self.inverse_mass[at][lane].into()
                })
                .collect(),
            rest: pairs().map(|pair| of_cell(&self.rest, pair).into()).collect(),
            constants: pairs().map(|pair| spring.map(|k| (of_cell(&self.shares, pair) * k).into())).collect(),
        }
    }

    fn solve(&mut self, spring: [f32; 2], simd_level: SimdLevel) {
        let Self { rows, stride, rising, position, previous, inverse_mass, rest, shares, .. } = self;
        let diagonals = ShearStrands { rows: *rows, rest, shares, stride: *stride, spring };
        let grid = &mut GridView { position, previous, inverse_mass, row_masses: &[] };
        let shear_scratch = &mut ShearScratch::default();
        match (*rising, spring[1] > 0.0) {
            (false, false) => dispatch!(simd_level.level(), simd =>
                diagonals.solve::<_, false, false>(simd, grid, shear_scratch)),
            (false, true) => dispatch!(simd_level.level(), simd =>
                diagonals.solve::<_, false, true>(simd, grid, shear_scratch)),
            (true, false) => dispatch!(simd_level.level(), simd =>
                diagonals.solve::<_, true, false>(simd, grid, shear_scratch)),
            (true, true) => dispatch!(simd_level.level(), simd =>
                diagonals.solve::<_, true, true>(simd, grid, shear_scratch)),
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn diagonals_are_solved_as_by_their_whole_matrix(
        seed in any::<u64>(),
        rows in 2_usize..14,
        columns in 2_usize..22,
        more_rows in 0_usize..4,
        stiffness in prop_oneof![Just(0.01_f32), 0.1_f32..10.0, Just(100.0)],
        damping in prop_oneof![Just(0.0_f32), 0.1_f32..1.0],
        rising in any::<bool>(),
        simd_level in prop_oneof![Just(SimdLevel::Best), Just(SimdLevel::Baseline)],
    ) {
        let spring = [stiffness, damping];
        let mut cells = Cells::new([rows, columns, rows + more_rows], rising, &mut Rng::with_seed(seed));
        let strands = cells.strands();
        let before: Vec<Strand> = strands.iter().map(|strand| cells.strand(strand, spring)).collect();
        cells.solve(spring, simd_level);
        for (strand, before) in strands.iter().zip(before) {
            let found: Vec<DVec3> = cells.strand(strand, spring).position;
            for (((found, expected), start), at) in found.iter().zip(before.solved()).zip(&before.position).zip(strand) {
                let off = found.distance(expected) / start.distance(expected).max(1.0);
                prop_assert!(off < 5e-3, "{at:?}: {found} for {expected}");
            }
        }
    }
}
