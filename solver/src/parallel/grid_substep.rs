//! The springs of a large lattice in one substep, shared between threads.
//!
//! What is along rows is shared by bands of rows, as they stand together in memory, and what is along columns by pairs of
//! packs. What a thread does in a phase depends on nothing that others do in it, so the bits are those of one thread.

use core::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use bevy_tasks::TaskPool;

use crate::{
    constraint::{
        attach::{
            skin::SkinSolver,
            tether::{self, PinPlaces},
        },
        multigrid::{LevelSolve, Levels},
        strand::{
            cells::{self, CellMaterial},
            grid::{self, GridStrandSolver, StrandDirection, StrandScratch},
            seam::Seam,
            shear_strands::ShearScratch,
        },
    },
    input::TetherBlock,
    integrate::{self, Finish, Motion},
    layout::{
        order::{Band, Order},
        points::Points,
        simd::SimdLevel,
    },
    parallel::phases::{self, Phase},
    particles::{
        Particles,
        lanes::{Lanes, Run},
    },
};

/// Particles from which on it pays: below, waking another thread takes as long as the work.
pub(crate) const LARGE: usize = 10_000;

/// What the threads need to know of a substep.
#[derive(Clone, Debug)]
pub(crate) struct SharedStep<'a> {
    pub grid_solver: GridStrandSolver<'a>,
    pub cells: CellMaterial<'a>,
    pub last: StrandDirection,
    /// Levels that are solved already, if there are any.
    pub levels: Option<(&'a LevelSolve<'a>, &'a Levels)>,
    pub tethers: &'a [TetherBlock],
    pub pins: &'a PinPlaces,
    pub slack: f32,
    /// What holds the cloth to an animated mesh once the springs are solved.
    pub skin: Option<SkinSolver<'a>>,
    /// What follows then.
    pub finish: Option<Finish<'a>>,
}

/// Buffers of one thread.
#[derive(Clone, Debug, Default)]
pub(crate) struct WorkerScratch {
    /// Strands that are being solved.
    pub strand_scratch: StrandScratch,
    /// Rows between bands.
    pub seam: Seam,
    /// Diagonals that are being solved.
    pub shear_scratch: ShearScratch,
    /// Ways of a level's rows, spread over eight columns.
    pub across: Points,
}

/// Moves the cloth along with its levels, solves tethers, springs and skin, and finishes the substep.
pub(crate) fn solve(pool: &TaskPool, lanes: &mut Lanes, worker_scratches: &mut Vec<WorkerScratch>, work: &SharedStep) {
    worker_scratches.resize_with(worker_scratches.len().max(phases::size(pool)), WorkerScratch::default);
    let order = lanes.order;
    let cloth = Cloth {
        work,
        bands: order.bands().collect(),
        runs: lanes.bands().into_iter().map(Mutex::new).collect(),
        worker_scratches: worker_scratches.iter_mut().map(Mutex::new).collect(),
    };
    let begin = |band, worker| cloth.begin(band, worker);
    let cross = |band, worker| cloth.cross(band, worker);
    let columns = |pair, worker| cloth.solve_columns(pair, worker);
    let rows = |band, worker| cloth.solve_rows(band, worker);
    let end = |band, _| cloth.finish(band);
    let bands = cloth.bands.len();
    let [first, second] = work.last.order().map(|strands| match strands {
        StrandDirection::Columns => Phase { units: order.pack_count().div_ceil(2), work: &columns },
        StrandDirection::Rows => Phase { units: bands, work: &rows },
    });
    let [begin, cross, end] = [
        Phase { units: bands, work: &begin },
        Phase { units: bands, work: &cross },
        Phase { units: bands, work: &end },
    ];
    phases::run(pool, &[begin, cross, first, second, end]);
}

/// Takes over the state of a cloth, and begins the first substep where no external force acts and there is a motion that
/// is `free` of others. Says whether an external force acts.
pub(crate) fn load(
    pool: &TaskPool,
    lanes: &mut Lanes,
    particles: &Particles,
    order: Order,
    free: Option<Motion>,
    simd_level: SimdLevel,
) -> bool {
    lanes.fit(order);
    let runs: Vec<_> = order.bands().zip(lanes.bands()).map(Mutex::new).collect();
    let is_pushed = AtomicBool::new(false);
    let load = |number: usize, _| {
        let (band, run) = &mut *lock(&runs[number]);
        run.load(particles, *band, simd_level);
        grid::masses_along_rows(run.inverse_mass, *band, run.row_masses, simd_level);
        is_pushed.fetch_or(particles.is_pushed(band.particles()), Ordering::Relaxed);
    };
    let begin = |number: usize, _| {
        if let Some(motion) = free.filter(|_| !is_pushed.load(Ordering::Relaxed)) {
            integrate::predict(&mut lock(&runs[number]).1, motion, simd_level);
        }
    };
    phases::run(pool, &[Phase { units: runs.len(), work: &load }, Phase { units: runs.len(), work: &begin }]);
    is_pushed.into_inner()
}

/// Hands the state back.
pub(crate) fn store(pool: &TaskPool, lanes: &mut Lanes, particles: &mut Particles, simd_level: SimdLevel) {
    let Particles { position, velocity, .. } = particles;
    let (mut position, mut velocity) = (&mut position[..], &mut velocity[..]);
    let order = lanes.order;
    let cut = |(band, run): (Band, _)| {
        let count = band.particles().len();
        let position = position.split_off_mut(..count).unwrap_or_default();
        let velocity = velocity.split_off_mut(..count).unwrap_or_default();
        Mutex::new((band, run, position, velocity))
    };
    let runs: Vec<_> = order.bands().zip(lanes.bands()).map(cut).collect();
    let store = |number: usize, _| {
        let (band, run, position, velocity) = &mut *lock(&runs[number]);
        run.store(position, velocity, *band, simd_level);
    };
    phases::run(pool, &[Phase { units: runs.len(), work: &store }]);
}

/// A cloth while threads work on it. Nobody holds more than one band at a time.
struct Cloth<'a> {
    work: &'a SharedStep<'a>,
    bands: Vec<Band>,
    /// What is in the bands.
    runs: Vec<Mutex<Run<'a>>>,
    /// One for each worker.
    worker_scratches: Vec<Mutex<&'a mut WorkerScratch>>,
}

impl Cloth<'_> {
    /// Levels, tethers, and the diagonals below even rows.
    fn begin(&self, number: usize, worker: usize) {
        let SharedStep {
            grid_solver: GridStrandSolver { lattice, simd_level, .. },
            cells,
            levels,
            tethers,
            pins,
            slack,
            ..
        } = *self.work;
        let (band, mut run) = (self.bands[number], lock(&self.runs[number]));
        let Run { first, position, inverse_mass, .. } = &mut *run;
        if let Some((run, levels)) = levels {
            levels.move_band(run, band, position, inverse_mass, &mut lock(&self.worker_scratches[worker]).across);
        }
        tether::solve(position, inverse_mass, *first, tethers, pins, slack, simd_level);
        let shear_scratch = &mut lock(&self.worker_scratches[worker]).shear_scratch;
        cells::solve_band(&mut run.grid(), band, 0, lattice, cells, shear_scratch, simd_level);
    }

    /// The diagonals below odd rows, and those to the band above: they have no particle in common.
    fn cross(&self, number: usize, worker: usize) {
        let SharedStep { grid_solver: GridStrandSolver { lattice, simd_level, .. }, cells, .. } = *self.work;
        let band = self.bands[number];
        let WorkerScratch { seam, shear_scratch, .. } = &mut **lock(&self.worker_scratches[worker]);
        cells::solve_band(&mut lock(&self.runs[number]).grid(), band, 1, lattice, cells, shear_scratch, simd_level);
        let Some(above) = number.checked_sub(1) else { return };
        for (row, band) in [above, number].into_iter().enumerate() {
            seam.take(&lock(&self.runs[band]).grid(), self.bands[band], row);
        }
        seam.solve(band, lattice, cells, shear_scratch, simd_level);
        for (row, band) in [above, number].into_iter().enumerate() {
            seam.put(lock(&self.runs[band]).position, self.bands[band], row);
        }
    }

    /// Two packs of columns.
    fn solve_columns(&self, pair: usize, worker: usize) {
        let (grid_solver, first) = (&self.work.grid_solver, 2 * pair);
        let strand_scratch = &mut lock(&self.worker_scratches[worker]).strand_scratch;
        for (&band, run) in self.bands.iter().zip(&self.runs) {
            grid_solver.take_columns(&lock(run).grid(), band, first, strand_scratch);
        }
        grid_solver.solve_taken_columns(first, strand_scratch);
        for (&band, run) in self.bands.iter().zip(&self.runs) {
            grid_solver.put_columns(strand_scratch, lock(run).position, band, first);
        }
    }

    fn solve_rows(&self, number: usize, worker: usize) {
        let strand_scratch = &mut lock(&self.worker_scratches[worker]).strand_scratch;
        let part = &mut lock(&self.runs[number]);
        self.work.grid_solver.solve_rows(&mut part.grid(), self.bands[number], strand_scratch);
    }

    fn finish(&self, number: usize) {
        let run = &mut lock(&self.runs[number]);
        if let Some(skin) = &self.work.skin {
            skin.solve(run);
        }
        if let Some(finish) = self.work.finish {
            integrate::finish(run, finish, self.work.grid_solver.simd_level);
        }
    }
}

/// Each holds only what nobody else needs now: no panic leaves it half done for others.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
