//! What a lattice's bends have in common in all substeps of a step.

use fearless_simd::{dispatch, f32x8, prelude::*};

use crate::{
    constraint::strand::{
        grid::{StrandScratch, blocks_across, take},
        material::StrandMaterial,
        pentadiagonal::{self, Factor},
    },
    layout::{
        points::Block,
        simd::{LANES, SHORTEST, SimdLevel, Vec3x8},
    },
    particles::lanes::Lanes,
    topology::lattice::{Lattice, RestCurvature, StrandSet},
};

/// As strands are solved: for eight side by side, node after node.
#[derive(Clone, Debug, Default)]
pub(crate) struct BendFactors {
    /// The matrix of the rows' bends, in factors.
    pub rows: Vec<Factor>,
    /// The matrix of the columns' bends, in factors.
    pub columns: Vec<Factor>,
    /// What bends and twists are at rest, turned into the directions that the cloth has now, m.
    pub rest: RestBends,
}

/// Empty where the cloth is flat.
#[derive(Clone, Debug, Default)]
pub(crate) struct RestBends {
    pub rows: Vec<Block>,
    pub columns: Vec<Block>,
    pub cells: Vec<Block>,
}

impl BendFactors {
    /// What bends nowhere.
    pub const NONE: Self = Self {
        rows: Vec::new(),
        columns: Vec::new(),
        rest: RestBends { rows: Vec::new(), columns: Vec::new(), cells: Vec::new() },
    };
}

impl RestBends {
    /// Turns what bends are at rest into the directions that the cloth has at the start of the step.
    pub fn turn(&mut self, lattice: &Lattice, lanes: &Lanes, simd_level: SimdLevel) {
        let Some(curl) = &lattice.curl else {
            *self = Self::default();
            return;
        };
        let count = lattice.order().block_count();
        self.rows.resize(lattice.along_rows.stretch.len(), Block::default());
        self.columns.resize(count, Block::default());
        self.cells.resize(count, Block::default());
        let places = Places { lattice, blocks: &lanes.position.0 };
        dispatch!(simd_level.level(), simd => self.turn_all(simd, places, curl));
    }

    #[inline(always)]
    fn turn_all<S: Simd>(&mut self, simd: S, places: Places, curl: &RestCurvature) {
        let (rows, width) = (places.lattice.rows, places.lattice.along_rows.nodes);
        for pack in 0..width / LANES {
            for first in (0..rows).step_by(LANES) {
                let mut eight = [Block::default(); LANES];
                let some = first..rows.min(first + LANES);
                for row in some.clone() {
                    let at = pack * rows + row;
                    let [above, here, below] = places.column(simd, row, pack);
                    let right = places.right(simd, row, pack, here);
                    let along = right - places.left(simd, row, pack, here);
                    let across = if row + 1 < rows { below - here } else { here - above };
                    turned(simd, &curl.along_rows[at], along, across).store(&mut eight[row - first]);
                    let across = places.towards_right(simd, row, pack, here);
                    turned(simd, &curl.along_columns[at], below - above, across).store(&mut self.columns[at]);
                    let opposite = places.right(simd, (row + 1).min(rows - 1), pack, below);
                    turned(simd, &curl.twist[at], opposite - here, below - right).store(&mut self.cells[at]);
                }
                let nodes = &mut self.rows[first / LANES * width + pack * LANES..][..LANES];
                blocks_across(simd, &eight[..some.len()], nodes);
            }
        }
    }
}

/// A vector of a frame that has one direction along, one across as far as it isn't along, and one normal to both.
#[inline(always)]
fn turned<S: Simd>(simd: S, rest: &Block, along: Vec3x8<S>, across: Vec3x8<S>) -> Vec3x8<S> {
    let Vec3x8 { x, y, z } = Vec3x8::load(simd, rest);
    let along = unit(simd, along);
    let across = unit(simd, across - along * across.dot(along));
    along * x + across * y + along.cross(across) * z
}

#[inline(always)]
fn unit<S: Simd>(simd: S, direction: Vec3x8<S>) -> Vec3x8<S> {
    let length = direction.dot(direction).sqrt().max(f32x8::splat(simd, SHORTEST));
    direction * (f32x8::splat(simd, 1.0) / length)
}

/// Particles and those beside them.
#[derive(Clone, Copy)]
struct Places<'a> {
    lattice: &'a Lattice,
    blocks: &'a [Block],
}

impl Places<'_> {
    #[inline(always)]
    fn at<S: Simd>(&self, simd: S, row: usize, pack: usize) -> Vec3x8<S> {
        Vec3x8::load(simd, &self.blocks[self.lattice.order().block_at(row, pack)])
    }

    /// Eight particles of a row, between those above and below, as far as there are any.
    #[inline(always)]
    fn column<S: Simd>(&self, simd: S, row: usize, pack: usize) -> [Vec3x8<S>; 3] {
        let last = self.lattice.rows - 1;
        [self.at(simd, row.saturating_sub(1), pack), self.at(simd, row, pack), self.at(simd, last.min(row + 1), pack)]
    }

    /// Those left of the particles `here`.
    #[inline(always)]
    fn left<S: Simd>(&self, simd: S, row: usize, pack: usize, here: Vec3x8<S>) -> Vec3x8<S> {
        self.at(simd, row, pack.saturating_sub(1)).behind(here)
    }

    /// Those right of them.
    #[inline(always)]
    fn right<S: Simd>(&self, simd: S, row: usize, pack: usize, here: Vec3x8<S>) -> Vec3x8<S> {
        here.ahead(self.at(simd, row, (pack + 1).min(self.lattice.along_rows.nodes / LANES - 1)))
    }

    /// From each particle to the next one right; to the last column, from the one left, or of a ring to the first column.
    #[inline(always)]
    fn towards_right<S: Simd>(&self, simd: S, row: usize, pack: usize, here: Vec3x8<S>) -> Vec3x8<S> {
        let strands = &self.lattice.along_rows;
        let towards = self.right(simd, row, pack, here) - here;
        let last = strands.count - 1;
        if last / LANES != pack {
            return towards;
        }
        let at_end = if strands.closed {
            let [x, y, z] = &self.blocks[self.lattice.order().block_at(row, 0)];
            Vec3x8::splat(simd, [x[0], y[0], z[0]]) - here
        } else {
            here - self.left(simd, row, pack, here)
        };
        let mut is_last = [0.0; LANES];
        is_last[last % LANES] = 1.0;
        let is_last = f32x8::simd_from(simd, is_last).simd_gt(f32x8::splat(simd, 0.0));
        at_end.or(is_last, towards)
    }
}

/// Works out what the bends of a lattice have in common in all substeps. Only the strands of a sheet have any.
pub(crate) fn prepare(
    bend_factors: &mut BendFactors,
    lattice: &Lattice,
    strand_material: StrandMaterial,
    lanes: &mut Lanes,
    strand_scratch: &mut StrandScratch,
    simd_level: SimdLevel,
) {
    let StrandMaterial::SheetStrands { rigidity: Some(rigidity), .. } = strand_material else { return };
    bend_factors.rest.turn(lattice, lanes, simd_level);
    let (order, level) = (lattice.order(), simd_level.level());
    let StrandSet { nodes, count, curvature: weights, .. } = &lattice.along_columns;
    bend_factors.columns.resize(weights.len(), Factor::default());
    strand_scratch.make_room(*nodes);
    for (first, factors) in bend_factors.columns.chunks_exact_mut(*nodes).enumerate() {
        for band in order.bands() {
            take(lanes.band(band).inverse_mass, band, *nodes, first..first + 1, &mut strand_scratch.inverse_mass);
        }
        let (masses, weights) = (&strand_scratch.inverse_mass, &weights[first * nodes..]);
        dispatch!(level, simd => {
            pentadiagonal::factorize(simd, *count, masses, weights, rigidity, factors)
        });
    }
    let StrandSet { nodes, count, curvature: weights, .. } = &lattice.along_rows;
    bend_factors.rows.resize(weights.len(), Factor::default());
    let masses = lanes.row_masses.chunks_exact(*nodes).zip(weights.chunks_exact(*nodes));
    for ((masses, weights), factors) in masses.zip(bend_factors.rows.chunks_exact_mut(*nodes)) {
        dispatch!(level, simd => {
            pentadiagonal::factorize(simd, *count, masses, weights, rigidity, factors)
        });
    }
}
