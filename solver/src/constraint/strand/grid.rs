//! The rows and columns of a lattice as strands.
//!
//! Eight columns stand side by side in memory already. Eight rows are brought there by transposing their blocks, and
//! back.

use core::ops::Range;

use fearless_simd::{dispatch, f32x8, f32x16, prelude::*};

use crate::{
    constraint::strand::{
        bend_factors::BendFactors,
        law::{GridStrandLaws, Scaled, StrandLaws},
        material::StrandMaterial,
        pentadiagonal::{Factor, StrandBends},
        tridiagonal::{EliminationRows, StrandLanes, StrandSprings},
    },
    input::PinMotion,
    layout::{
        order::{Band, Order},
        points::Block,
        simd::{LANES, Lane, SimdLevel, Wide, lane, transpose},
    },
    particles::lanes::GridView,
    topology::lattice::{Lattice, StrandSet},
};

/// Buffers for strands that are being solved.
#[derive(Clone, Debug, Default)]
pub(crate) struct StrandScratch {
    pub rows: EliminationRows,
    pub position: Vec<Block>,
    pub previous: Vec<Block>,
    pub inverse_mass: Vec<Lane>,
}

impl StrandScratch {
    /// Makes room for as many nodes.
    pub fn make_room(&mut self, count: usize) {
        self.rows.make_room(count);
        for blocks in [&mut self.position, &mut self.previous] {
            blocks.resize(blocks.len().max(count), Block::default());
        }
        self.inverse_mass.resize(self.inverse_mass.len().max(count), Lane::default());
    }
}

/// Inverse masses of a band's rows for eight rows side by side, column after column.
pub(crate) fn masses_along_rows(inverse_mass: &[Lane], band: Band, along_rows: &mut [Lane], simd_level: SimdLevel) {
    let columns = inverse_mass.chunks_exact(band.rows);
    let nodes = columns.len() * LANES;
    dispatch!(simd_level.level(), simd => {
        for (pack, some) in along_rows.chunks_exact_mut(nodes).zip(packs_of_rows(0..band.rows)) {
            for (nodes, column) in pack.chunks_exact_mut(LANES).zip(columns.clone()) {
                across(simd, column[some.clone()].iter(), nodes.iter_mut());
            }
        }
    });
}

/// Which strands are solved last: they are held best.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum StrandDirection {
    Rows,
    Columns,
}

impl StrandDirection {
    /// Both, in their order.
    pub fn order(self) -> [Self; 2] {
        match self {
            Self::Rows => [Self::Columns, Self::Rows],
            Self::Columns => [Self::Rows, Self::Columns],
        }
    }

    /// The strands that carry the most: those that go from pin to pin where few pins are far apart, and those that hang
    /// from them where pins stand close.
    pub fn between(pin_motions: &[PinMotion], order: Order) -> Self {
        let place =
            |anchor: &PinMotion| (anchor.particle as usize / order.columns, anchor.particle as usize % order.columns);
        let spread = |of: fn((usize, usize)) -> usize| {
            let places = pin_motions.iter().map(|anchor| of(place(anchor)));
            places.clone().max().unwrap_or(0) - places.min().unwrap_or(0)
        };
        let (across, down) = (spread(|(_, column)| column), spread(|(row, _)| row));
        let are_far_apart = 2 * pin_motions.len() <= across.max(down);
        if (across > down) == are_far_apart { Self::Rows } else { Self::Columns }
    }
}

/// How the strands of a lattice are solved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GridStrandSolver<'a> {
    pub lattice: &'a Lattice,
    pub strand_material: StrandMaterial,
    pub bend_factors: &'a BendFactors,
    pub simd_level: SimdLevel,
}

impl GridStrandSolver<'_> {
    /// Solves all columns and all rows.
    pub fn solve(&self, grid: &mut GridView, last: StrandDirection, strand_scratch: &mut StrandScratch) {
        for strands in last.order() {
            match strands {
                StrandDirection::Columns => self.solve_columns(grid, strand_scratch),
                StrandDirection::Rows => {
                    for band in self.lattice.order().bands() {
                        self.solve_rows(&mut grid.band(band), band, strand_scratch);
                    }
                }
            }
        }
    }

    fn solve_columns(&self, grid: &mut GridView, strand_scratch: &mut StrandScratch) {
        let order = self.lattice.order();
        if order.bands().len() > 1 {
            for first in (0..order.pack_count()).step_by(2) {
                for band in order.bands() {
                    self.take_columns(&grid.band(band), band, first, strand_scratch);
                }
                self.solve_taken_columns(first, strand_scratch);
                for band in order.bands() {
                    self.put_columns(strand_scratch, grid.band(band).position, band, first);
                }
            }
            return;
        }
        // Of one band, columns can be solved where they stand.
        let stride = order.rows;
        strand_scratch.make_room(2 * stride);
        let GridView { position, previous, inverse_mass, .. } = grid;
        let pairs = position.chunks_mut(2 * stride).zip(previous.chunks(2 * stride));
        for (first, ((position, previous), inverse_mass)) in
            (0..).step_by(2).zip(pairs.zip(inverse_mass.chunks(2 * stride)))
        {
            let mut pack = StrandLanes { position, previous, inverse_mass, stride };
            self.solve_packs(&mut pack, self.columns(first), &mut strand_scratch.rows);
        }
    }

    /// Takes a band's part of up to two packs of columns from the `first` into the buffers.
    pub fn take_columns(&self, part: &GridView, band: Band, first: usize, strand_scratch: &mut StrandScratch) {
        let stride = self.lattice.rows;
        strand_scratch.make_room(2 * stride);
        let packs = self.packs(first);
        take(part.position, band, stride, packs.clone(), &mut strand_scratch.position);
        take(part.inverse_mass, band, stride, packs.clone(), &mut strand_scratch.inverse_mass);
        if self.strand_material.is_damped() {
            take(part.previous, band, stride, packs, &mut strand_scratch.previous);
        }
    }

    /// Solves the columns that were taken.
    pub fn solve_taken_columns(&self, first: usize, strand_scratch: &mut StrandScratch) {
        let stride = self.lattice.rows;
        let count = self.packs(first).len() * stride;
        let StrandScratch { rows, position, previous, inverse_mass } = strand_scratch;
        let mut pack = StrandLanes { position: &mut position[..count], previous, inverse_mass, stride };
        self.solve_packs(&mut pack, self.columns(first), rows);
    }

    /// Puts a band's part of columns back to where it was taken from.
    pub fn put_columns(&self, strand_scratch: &StrandScratch, position: &mut [Block], band: Band, first: usize) {
        let taken = strand_scratch.position.chunks_exact(self.lattice.rows);
        for (column, taken) in position.chunks_exact_mut(band.rows).skip(first).zip(taken).take(2) {
            column.copy_from_slice(&taken[band.first..][..band.rows]);
        }
    }

    /// Numbers of up to two packs of columns.
    fn packs(&self, first: usize) -> Range<usize> {
        first..self.lattice.order().pack_count().min(first + 2)
    }

    /// Solves the rows of a band.
    pub fn solve_rows(&self, part: &mut GridView, band: Band, strand_scratch: &mut StrandScratch) {
        let (level, strands) = (self.simd_level.level(), &self.lattice.along_rows);
        let nodes = strands.nodes;
        strand_scratch.make_room(2 * nodes);
        let GridView { position, previous, row_masses, .. } = part;
        for first in (0..band.rows).step_by(2 * LANES) {
            let some = first..band.rows.min(first + 2 * LANES);
            dispatch!(level, simd => take_rows(simd, position, band.rows, some.clone(), nodes, &mut strand_scratch.position));
            if self.strand_material.is_damped() {
                dispatch!(level, simd => take_rows(simd, previous, band.rows, some.clone(), nodes, &mut strand_scratch.previous));
            }
            let StrandScratch { rows, position: taken, previous, .. } = &mut *strand_scratch;
            let (number, count) = ((band.first + first) / LANES, some.len().div_ceil(LANES) * nodes);
            let inverse_mass = &row_masses[first / LANES * nodes..][..count];
            let mut pack = StrandLanes { position: &mut taken[..count], previous, inverse_mass, stride: nodes };
            self.solve_packs(&mut pack, self.rows(number), rows);
            dispatch!(level, simd => put_rows(simd, taken, nodes, position, band.rows, some));
        }
    }

    /// The columns of some packs from the `first` on.
    fn columns(&self, first: usize) -> StrandRun<'_> {
        self.run(&self.lattice.along_columns, &self.bend_factors.columns, &self.bend_factors.rest.columns, first)
    }

    /// The rows of some packs from the `first` on.
    fn rows(&self, first: usize) -> StrandRun<'_> {
        self.run(&self.lattice.along_rows, &self.bend_factors.rows, &self.bend_factors.rest.rows, first)
    }

    fn run<'a>(&self, strands: &'a StrandSet, factors: &'a [Factor], rest: &'a [Block], first: usize) -> StrandRun<'a> {
        let first = first * strands.nodes;
        StrandRun {
            strands,
            first,
            factors: from(factors, first),
            rest: from(rest, first),
            strand_material: self.strand_material,
        }
    }

    /// Solves one or two packs of strands.
    fn solve_packs(&self, pack: &mut StrandLanes, run: StrandRun, rows: &mut EliminationRows) {
        let level = self.simd_level.level();
        match (pack.position.len() > pack.stride, self.strand_material.is_stretch_damped()) {
            (true, false) => dispatch!(level, simd => run.solve::<_, f32x16<_>, false>(simd, pack, rows)),
            (true, true) => dispatch!(level, simd => run.solve::<_, f32x16<_>, true>(simd, pack, rows)),
            (false, false) => dispatch!(level, simd => run.solve::<_, f32x8<_>, false>(simd, pack, rows)),
            (false, true) => dispatch!(level, simd => run.solve::<_, f32x8<_>, true>(simd, pack, rows)),
        }
    }
}

/// What is there from a place on: nothing, of what is empty.
fn from<T>(all: &[T], first: usize) -> &[T] {
    all.get(first..).unwrap_or_default()
}

/// Takes a band's part of some packs of columns to where whole columns stand one after the other.
pub(crate) fn take<T: Copy>(from: &[T], band: Band, rows: usize, packs: Range<usize>, to: &mut [T]) {
    let columns = from.chunks_exact(band.rows).skip(packs.start).take(packs.len());
    for (column, taken) in columns.zip(to.chunks_exact_mut(rows)) {
        taken[band.first..][..band.rows].copy_from_slice(column);
    }
}

/// Rows of each pack that some rows make up.
fn packs_of_rows(some: Range<usize>) -> impl Iterator<Item = Range<usize>> {
    some.clone().step_by(LANES).map(move |row| row..some.end.min(row + LANES))
}

/// Takes some rows of a band that has so many, each of `nodes`.
#[inline(always)]
fn take_rows<S: Simd>(simd: S, columns: &[Block], rows: usize, some: Range<usize>, nodes: usize, taken: &mut [Block]) {
    for (some, taken) in packs_of_rows(some).zip(taken.chunks_exact_mut(nodes)) {
        for (nodes, column) in taken.chunks_exact_mut(LANES).zip(columns.chunks_exact(rows)) {
            blocks_across(simd, &column[some.clone()], nodes);
        }
    }
}

/// Puts them back.
#[inline(always)]
fn put_rows<S: Simd>(simd: S, taken: &[Block], nodes: usize, columns: &mut [Block], rows: usize, some: Range<usize>) {
    for (some, taken) in packs_of_rows(some).zip(taken.chunks_exact(nodes)) {
        for (nodes, column) in taken.chunks_exact(LANES).zip(columns.chunks_exact_mut(rows)) {
            blocks_across(simd, nodes, &mut column[some.clone()]);
        }
    }
}

/// One or two packs of strands that are being solved.
#[derive(Clone, Copy)]
struct StrandRun<'a> {
    strands: &'a StrandSet,
    /// Where the first pack begins among all nodes.
    first: usize,
    /// The matrix of these packs' bends.
    factors: &'a [Factor],
    /// What the bends of these packs are at rest, m; empty where the cloth is flat.
    rest: &'a [Block],
    strand_material: StrandMaterial,
}

impl StrandRun<'_> {
    #[inline(always)]
    fn solve<S: Simd, F: Wide<S>, const DAMPED: bool>(
        &self,
        simd: S,
        pack: &mut StrandLanes,
        rows: &mut EliminationRows,
    ) {
        let Self { strands, first, .. } = *self;
        let count = strands.count;
        // What comes last is held best: stretch shows more than bending.
        match self.strand_material {
            StrandMaterial::Alike { stretch, bend } => {
                if let Some(bend) = bend {
                    pack.solve_bends::<S, F, DAMPED>(simd, count, &strands.bend[first..], bend);
                }
                if stretch.acts() {
                    self.stretch::<S, F, _, DAMPED>(simd, pack, stretch, rows);
                }
            }
            StrandMaterial::LevelSprings(pull) => self.stretch::<S, F, _, false>(simd, pack, pull, rows),
            StrandMaterial::SheetStrands { stretch, rigidity } => {
                if let Some(rigidity) = rigidity {
                    if rigidity.c > 0.0 {
                        self.bend::<S, true>(simd, pack, rigidity, rows);
                    } else {
                        self.bend::<S, false>(simd, pack, rigidity, rows);
                    }
                }
                let grading = stretch[strands.grain.index()];
                let laws = GridStrandLaws { shares: &strands.shares[first..], grading };
                self.stretch::<S, F, _, DAMPED>(simd, pack, laws, rows);
            }
        }
    }

    /// One pack after the other: two at once don't fit into the fastest cache.
    #[inline(always)]
    fn bend<S: Simd, const DAMPED: bool>(
        &self,
        simd: S,
        pack: &mut StrandLanes,
        rigidity: Scaled,
        rows: &mut EliminationRows,
    ) {
        let (count, stride) = (self.strands.count, pack.stride);
        for first in (0..pack.position.len()).step_by(stride) {
            let bends = StrandBends {
                weights: &self.strands.curvature[self.first + first..],
                rest: from(self.rest, first),
                factors: &self.factors[first..],
                rigidity,
            };
            let mut pack = StrandLanes {
                position: &mut pack.position[first..][..stride],
                previous: if DAMPED { &pack.previous[first..] } else { &[] },
                inverse_mass: &pack.inverse_mass[first..],
                stride,
            };
            if bends.rest.is_empty() {
                pack.solve_curvature::<S, DAMPED, false>(simd, count, bends, rows);
            } else {
                pack.solve_curvature::<S, DAMPED, true>(simd, count, bends, rows);
            }
        }
    }

    #[inline(always)]
    fn stretch<S: Simd, F: Wide<S>, L: StrandLaws<S, F>, const DAMPED: bool>(
        &self,
        simd: S,
        pack: &mut StrandLanes,
        laws: L,
        rows: &mut EliminationRows,
    ) {
        let springs = StrandSprings { rest: &self.strands.stretch[self.first..], laws };
        if self.strands.closed {
            pack.solve::<S, F, L, DAMPED, true>(simd, self.strands.count, springs, rows);
        } else {
            pack.solve::<S, F, L, DAMPED, false>(simd, self.strands.count, springs, rows);
        }
    }
}

/// Turns up to eight blocks into up to eight others: lane i of block j becomes lane j of block i.
#[inline(always)]
pub(crate) fn blocks_across<S: Simd>(simd: S, from: &[Block], to: &mut [Block]) {
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
