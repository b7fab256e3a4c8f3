//! Coarse levels of strands: they carry the long waves.
//!
//! ```text
//!   o---.---.---.---o---.---.---.---o      o nodes     . particles between them
//! ```
//!
//! A strand takes a pull along itself within a substep, not around a corner. On a lattice of few nodes a few
//! iterations take it everywhere. Each level, the coarsest first, starts from where its nodes are by now, pulls at
//! strands that are longer than the cloth is (slack ones fold between the nodes: they are left alone), and hands its
//! nodes' ways on to the next, at last to all particles, interpolated. Like tethers, levels hold cloth within its own
//! length and a slack, however soft its springs are: where there are no tethers, there are no levels.
//!
//! A multigrid of displacements in the spirit of Müller, "Hierarchical Position Based Dynamics" (2008), with exact
//! strands as the smoother.

use core::ops::Range;

use bevy_math::Vec3A;
use fearless_simd::{dispatch, f32x8, prelude::*};

use crate::{
    constraint::{
        attach::tether::{self, PinPlaces},
        strand::{
            bend_factors::BendFactors,
            grid::{self, GridStrandSolver, StrandDirection, StrandScratch},
            law::{Scaled, TensionOnly},
            material::StrandMaterial,
        },
    },
    input::{TetherBlock, Tethers},
    layout::{
        order::{Band, Order},
        points::{Block, Points},
        simd::{LANES, Lane, SimdLevel, Vec3x8, lane},
    },
    particles::lanes::{GridView, Lanes},
    topology::level::{Level, LevelPass, LinearWeights, Prolongation, TransferOperator},
};

/// By how much less than tethers a level gives, no unit: what it leaves, the fine strands are left with.
const TAUTER: f32 = 0.005;

/// Share of its motion against its neighbours that a node loses in a substep, no unit, for the shortest wave along one direction.
///
/// Level and strands each pull with the whole stiffness in every substep, farther together than the cloth gives, and nothing else
/// damps what they do to each other: without this, a hung cloth goes on by some centimetres a second. Long waves, as swings are,
/// lose little: those of 32 nodes a hundredth.
const DAMPING: f32 = 0.1;

/// The nodes of a level during a step.
#[derive(Clone, Debug, Default)]
pub(crate) struct LevelNodes {
    order: Order,
    position: Points,
    /// Where they started, and in the end how far they went, m.
    way: Points,
    /// How far they went in the substep before they are solved, m.
    motion: Points,
    inverse_mass: Vec<Lane>,
    row_masses: Vec<Lane>,
}

/// Buffers of all levels.
#[derive(Clone, Debug, Default)]
pub(crate) struct Levels {
    nodes: Vec<LevelNodes>,
}

/// What the levels need to know of a substep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LevelSolve<'a> {
    pub levels: &'a [Level],
    pub passes: &'a [LevelPass],
    pub tethers: &'a Tethers,
    pub slack: f32,
    pub stretch: Scaled,
    pub last: StrandDirection,
    pub simd_level: SimdLevel,
}

impl LevelSolve<'_> {
    /// Iterations of a level.
    fn iterations(&self, level: &Level) -> u32 {
        self.passes.iter().find(|pass| pass.stride == level.stride).map_or(0, |pass| pass.iterations)
    }

    /// Numbers of the levels from the coarsest that iterates to the finest.
    fn used(&self) -> Range<usize> {
        let iterates = |level: &Level| self.iterations(level) > 0;
        let first = self.levels.iter().position(iterates).unwrap_or(0);
        first..self.levels.iter().rposition(iterates).map_or(0, |last| last + 1)
    }
}

impl Levels {
    /// Makes room, and gives the nodes their masses by those of slots, once a step.
    pub fn fit(&mut self, run: &LevelSolve, inverse_mass: impl Fn(usize) -> f32) {
        self.nodes.resize_with(self.nodes.len().max(run.levels.len()), LevelNodes::default);
        for i in run.used() {
            self.nodes[i].fit(&run.levels[i], &inverse_mass, run.simd_level);
        }
    }

    /// Solves all levels, once a substep. Particles of a lattice are moved along with them by [`move_band`](Self::move_band),
    /// others at once. Strands and `across` are buffers.
    pub fn solve(
        &mut self,
        run: &LevelSolve,
        lanes: &mut Lanes,
        pins: &PinPlaces,
        (strand_scratch, across): (&mut StrandScratch, &mut Points),
    ) {
        let nodes = &mut self.nodes;
        let mut coarser: Option<&LevelNodes> = None;
        for ((i, level), nodes) in run.used().zip(&run.levels[run.used()]).zip(&mut nodes[run.used()]) {
            nodes.restrict(level, lanes);
            if let (Some(coarser), Some(spread)) = (coarser, &level.from_coarser) {
                let LevelNodes { order, position, inverse_mass, .. } = nodes;
                for band in order.bands() {
                    let (position, inverse_mass) = (&mut position.0[band.blocks()], &inverse_mass[band.blocks()]);
                    coarser.prolong(spread, band, position, inverse_mass, across, run.simd_level);
                }
            }
            nodes.damp(level, lanes);
            let tethers = run.tethers.of_level(i);
            for _ in 0..run.iterations(level) {
                nodes.iterate(level, run, tethers, pins, strand_scratch);
            }
            nodes.finish();
            coarser = Some(nodes);
        }
        let finest = run.levels[run.used()].last().map(|level| &level.transfer);
        if let (Some(nodes), Some(TransferOperator::Chart { particles, .. })) = (coarser, finest) {
            let (position, inverse_mass) = (&mut lanes.position.0, &lanes.inverse_mass);
            let set = run.simd_level.level();
            dispatch!(set, simd => nodes.prolong_chart(simd, particles, position, inverse_mass));
        }
    }

    /// Moves a band of a lattice along with the finest level. `across` is a buffer.
    pub fn move_band(
        &self,
        run: &LevelSolve,
        band: Band,
        position: &mut [Block],
        inverse_mass: &[Lane],
        across: &mut Points,
    ) {
        let Some(finest) = run.used().last() else { return };
        if let TransferOperator::Lattice { spread, .. } = &run.levels[finest].transfer {
            self.nodes[finest].prolong(spread, band, position, inverse_mass, across, run.simd_level);
        }
    }
}

impl LevelNodes {
    fn fit(&mut self, level: &Level, inverse_mass: &impl Fn(usize) -> f32, simd_level: SimdLevel) {
        self.order = level.lattice.order();
        let blocks = self.order.block_count();
        self.position.resize(blocks);
        self.way.resize(blocks);
        self.motion.resize(blocks);
        self.inverse_mass.clear();
        self.inverse_mass.resize(blocks, Lane::default());
        let masses = self.inverse_mass.as_flattened_mut();
        match &level.transfer {
            TransferOperator::Lattice { slots, .. } => {
                for (mass, &slot) in
                    masses.iter_mut().zip(slots.as_flattened()).filter(|(_, slot)| **slot != Level::NOBODY)
                {
                    *mass = inverse_mass(slot as usize) / level.share;
                }
            }
            TransferOperator::Chart { nodes, .. } => {
                for (mass, (corners, weights)) in masses.iter_mut().zip(nodes) {
                    let of_corner = |i: usize| weights[i] * inverse_mass(corners[i] as usize);
                    *mass = (of_corner(0) + of_corner(1) + of_corner(2)) / level.share;
                }
            }
        }
        self.row_masses.resize(self.order.row_mass_count(), Lane::default());
        for band in self.order.bands() {
            let inverse_mass = &self.inverse_mass[band.blocks()];
            grid::masses_along_rows(inverse_mass, band, &mut self.row_masses[band.row_masses()], simd_level);
        }
    }

    /// Puts the nodes where the cloth is.
    fn restrict(&mut self, level: &Level, lanes: &Lanes) {
        match &level.transfer {
            TransferOperator::Lattice { slots, .. } => {
                for (node, &slot) in slots.as_flattened().iter().enumerate() {
                    if slot != Level::NOBODY {
                        self.position.set(node, lanes.position.get(slot as usize));
                    }
                }
            }
            TransferOperator::Chart { nodes, .. } => {
                for (node, (corners, weights)) in nodes.iter().enumerate() {
                    let corner = |i: usize| lanes.position.get(corners[i] as usize) * weights[i];
                    self.position.set(node, corner(0) + corner(1) + corner(2));
                }
            }
        }
        self.way.0.clone_from(&self.position.0);
    }

    /// Damps the motion of nodes against their neighbours, where nodes are particles.
    fn damp(&mut self, level: &Level, lanes: &Lanes) {
        let TransferOperator::Lattice { slots, .. } = &level.transfer else { return };
        for (node, &slot) in slots.as_flattened().iter().enumerate().filter(|(_, slot)| **slot != Level::NOBODY) {
            let slot = slot as usize;
            self.motion.set(node, lanes.position.get(slot) - lanes.previous.get(slot));
        }
        let Self { order, position, motion, inverse_mass, .. } = self;
        let (rows, columns, closed) = (order.rows, order.columns, level.lattice.along_rows.closed);
        let masses = inverse_mass.as_flattened();
        for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
            let node = order.slot_at(row, column);
            if masses[node] == 0.0 {
                continue;
            }
            let is_first = column == 0;
            let is_last = column + 1 == columns;
            let neighbours = [
                (row > 0).then(|| (row - 1, column)),
                (row + 1 < rows).then(|| (row + 1, column)),
                (closed || !is_first).then(|| (row, if is_first { columns - 1 } else { column - 1 })),
                (closed || !is_last).then(|| (row, if is_last { 0 } else { column + 1 })),
            ];
            let here = motion.get(node);
            let against =
                neighbours.into_iter().flatten().map(|(row, column)| motion.get(order.slot_at(row, column)) - here);
            position.set(node, position.get(node) + against.sum::<Vec3A>() * (DAMPING / 4.0));
        }
    }

    fn iterate(
        &mut self,
        level: &Level,
        run: &LevelSolve,
        tethers: &[TetherBlock],
        pins: &PinPlaces,
        strand_scratch: &mut StrandScratch,
    ) {
        let position = &mut self.position.0;
        tether::solve(position, &self.inverse_mass, 0, tethers, pins, run.slack, run.simd_level);
        let mut grid = GridView {
            position,
            previous: &self.way.0,
            inverse_mass: &self.inverse_mass,
            row_masses: &self.row_masses,
        };
        let spring = Scaled { c: 0.0, ..run.stretch };
        let strand_material =
            StrandMaterial::LevelSprings(TensionOnly { spring, rest_scale: 1.0 + (run.slack - TAUTER).max(0.0) });
        let grid_solver = GridStrandSolver {
            lattice: &level.lattice,
            strand_material,
            bend_factors: &BendFactors::NONE,
            simd_level: run.simd_level,
        };
        grid_solver.solve(&mut grid, run.last, strand_scratch);
    }

    /// Works out how far the nodes went.
    fn finish(&mut self) {
        for (way, position) in self.way.0.iter_mut().zip(&self.position.0) {
            for (way, position) in way.as_flattened_mut().iter_mut().zip(position.as_flattened()) {
                *way = position - *way;
            }
        }
    }

    /// Moves what is free in a finer band along with the nodes that it lies between.
    fn prolong(
        &self,
        spread: &Prolongation,
        band: Band,
        position: &mut [Block],
        inverse_mass: &[Lane],
        across: &mut Points,
        simd_level: SimdLevel,
    ) {
        across.resize(self.order.rows);
        let rows = &spread.rows[band.first..][..band.rows];
        let columns = position.chunks_exact_mut(band.rows).zip(inverse_mass.chunks_exact(band.rows));
        let columns = columns.zip(&spread.columns);
        dispatch!(simd_level.level(), simd => {
            for ((places, masses), nodes) in columns {
                self.prolong_eight(simd, rows, nodes, places, masses, &mut across.0);
            }
        });
    }

    /// Moves what is free in eight columns: first the ways of the rows of nodes around are spread `across` the columns,
    /// then between those.
    #[inline(always)]
    fn prolong_eight<S: Simd>(
        &self,
        simd: S,
        rows: &[LinearWeights],
        nodes: &[(u32, Lane)],
        places: &mut [Block],
        masses: &[Lane],
        across: &mut [Block],
    ) {
        let first = rows.first().map_or(0, |row| row.first as usize);
        let after = rows.last().map_or(0, |row| row.first as usize + 2);
        for (row, across) in across.iter_mut().enumerate().take(after).skip(first) {
            let mut way = Vec3x8::splat(simd, [0.0; 3]);
            for (column, shares) in nodes {
                let node = self.way.get(self.order.slot_at(row, *column as usize)).to_array();
                way = way + Vec3x8::splat(simd, node) * lane(simd, shares);
            }
            way.store(across);
        }
        for ((place, w), &LinearWeights { first, share }) in places.iter_mut().zip(masses).zip(rows) {
            let above = Vec3x8::load(simd, &across[first as usize]);
            let below = Vec3x8::load(simd, &across[first as usize + 1]);
            move_free(simd, place, w, above + (below - above) * f32x8::splat(simd, share));
        }
    }

    #[inline(always)]
    fn prolong_chart<S: Simd>(
        &self,
        simd: S,
        particles: &[([u32; 4], [f32; 4])],
        position: &mut [Block],
        inverse_mass: &[Lane],
    ) {
        let blocks = position.iter_mut().zip(inverse_mass).zip(particles.chunks(LANES));
        for ((place, w), particles) in blocks {
            let mut way = Block::default();
            for (lane, (nodes, shares)) in particles.iter().enumerate() {
                let mut sum = Vec3A::ZERO;
                for (&node, &share) in nodes.iter().zip(shares) {
                    sum += self.way.get(node as usize) * share;
                }
                (way[0][lane], way[1][lane], way[2][lane]) = sum.into();
            }
            move_free(simd, place, w, Vec3x8::load(simd, &way));
        }
    }
}

#[inline(always)]
fn move_free<S: Simd>(simd: S, place: &mut Block, inverse_mass: &Lane, way: Vec3x8<S>) {
    let before = Vec3x8::load(simd, place);
    let is_free = lane(simd, inverse_mass).simd_gt(f32x8::splat(simd, 0.0));
    (before + way).or(is_free, before).store(place);
}
