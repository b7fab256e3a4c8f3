//! What happens in a substep.

use core::ops::Range;

use bevy_math::Vec3A;
use bevy_tasks::TaskPool;

use crate::{
    constraint::{
        attach::{grab, tether},
        implicit::ImplicitSheet,
        multigrid::LevelSolve,
        strand::{
            bend_factors,
            cells::{self, CellMaterial},
            grid::{self, GridStrandSolver, StrandDirection},
            law::Scaled,
            material::StrandMaterial,
            packs::StrandPackSolver,
        },
        unstructured::{UnstructuredPass, bend::BendSolver},
    },
    explicit::{self, Stability},
    force::wind,
    input::{Method, StepContext, Tethers},
    integrate::{self, Finish, Motion, SpeedLimit},
    layout::{points::Points, simd::SimdLevel},
    parallel::grid_substep::{self, SharedStep, WorkerScratch},
    particles::{Particles, lanes::Run},
    scratch::Scratch,
    topology::{Topology, lattice::Lattice, level::LevelPass},
};

/// What all substeps of a step have in common.
#[derive(Clone, Copy)]
pub(crate) struct Substep<'a> {
    pub topology: &'a Topology,
    pub ctx: &'a StepContext<'a>,
    /// Duration, s.
    pub h: f32,
    /// What keeps the step stable.
    pub stability: Stability,
    /// Whether anything but gravity acts.
    pub is_pushed: bool,
    /// Whether anything is so near that it may be touched.
    pub is_near: bool,
    /// Whether triangles and edges may touch something.
    pub touches: bool,
    pub limit: SpeedLimit,
    /// The threads that share the work, and the lattice that all springs are on.
    pub helpers: Option<(&'a TaskPool, &'a Lattice)>,
    pub last: StrandDirection,
    pub levels: &'a [LevelPass],
    /// How a sheet on any triangles is solved, where it is one.
    pub implicit: Option<ImplicitSheet<'a>>,
    /// By how much of its length a tether gives, no unit.
    pub slack: f32,
}

impl Substep<'_> {
    /// Works out what doesn't change from substep to substep.
    pub fn prepare(&self, scratch: &mut Scratch) {
        if let Some(sheet) = self.implicit {
            sheet.prepare(&scratch.lanes, self.ctx, &mut scratch.implicit);
            return;
        }
        let is_solved = self.ctx.settings.method != Method::Explicit;
        let with_strands = self.ctx.settings.method == Method::Xpbd;
        let bending = || BendSolver::new(self.topology, with_strands, &self.ctx.material, &scratch.lanes, self.h);
        scratch.bending = is_solved.then(bending).flatten();
        // Threads that share the work have done it already.
        if self.ctx.settings.method == Method::Strands && self.topology.lattice.is_some() && self.helpers.is_none() {
            for band in scratch.lanes.order.bands() {
                let Run { inverse_mass, row_masses, .. } = scratch.lanes.band(band);
                grid::masses_along_rows(inverse_mass, band, row_masses, scratch.simd_level);
            }
        }
        if let Some(lattice) = self.topology.lattice.as_ref().filter(|_| self.ctx.settings.method == Method::Strands) {
            let Scratch { lanes, bend_factors, worker_scratch, simd_level, .. } = &mut *scratch;
            let strand_material = StrandMaterial::new(&self.ctx.material, self.h);
            bend_factors::prepare(
                bend_factors,
                lattice,
                strand_material,
                lanes,
                &mut worker_scratch.strand_scratch,
                *simd_level,
            );
        }
        let Scratch { lanes, levels, skin, simd_level, .. } = scratch;
        if let Some(run) = self.levels(*simd_level) {
            // Levels leave alone what the skin holds within less than an edge.
            let tight = skin.of(self.ctx).map(|skin| skin.limits);
            let is_tight = |slot: usize| tight.is_some_and(|limits| limits.is_tight(limits.max_distance(slot)));
            levels.fit(&run, |slot| if is_tight(slot) { 0.0 } else { lanes.inverse_mass(slot) });
        }
    }

    /// Sums up the forces that act for the next `interval` substeps.
    pub fn renew_steady_force(&self, particles: &mut Particles, interval: u32, scratch: &mut Scratch) {
        let Scratch { lanes, air, steady_force, applied_force, simd_level, .. } = scratch;
        if !self.is_pushed {
            return;
        }
        steady_force.clone_from(&particles.force);
        if wind::feels_air(self.ctx) {
            lanes.store(particles, *simd_level);
            wind::apply_air(particles, self.topology, self.ctx, self.h * interval as f32, air, steady_force);
        }
        applied_force.load(lanes.order, steady_force, *simd_level);
    }

    /// Adds the forces of the springs to the steady one.
    pub fn add_spring_forces(&self, particles: &mut Particles, scratch: &mut Scratch) {
        let Scratch { lanes, steady_force, force, applied_force, simd_level, .. } = scratch;
        steady_force.resize(particles.len(), Vec3A::ZERO);
        force.clone_from(steady_force);
        lanes.store(particles, *simd_level);
        explicit::add_spring_forces(particles, self.topology, &self.ctx.material, self.stability, force);
        if let Some(moduli) = self.ctx.material.moduli() {
            explicit::add_sheet_forces(particles, self.topology, moduli, self.stability, force);
        }
        applied_force.load(lanes.order, force, *simd_level);
    }

    /// Moves the particles as if nothing held them together.
    pub fn move_freely(&self, scratch: &mut Scratch) {
        let Scratch { lanes, applied_force, simd_level, .. } = scratch;
        integrate::predict(&mut lanes.whole(), self.motion(applied_force), *simd_level);
    }

    fn motion<'a>(&self, force: &'a Points) -> Motion<'a> {
        // The other methods see to it when constraints have been solved.
        let limit = (self.ctx.settings.method == Method::Explicit).then_some(self.limit);
        let free = Motion { limit, ..Motion::free(self.ctx, self.h) };
        match self.implicit {
            // They are in its right-hand side.
            Some(_) => Motion { gravity: Vec3A::ZERO, ..free },
            None => Motion { force: self.applied(force), ..free },
        }
    }

    /// The force that is applied, if one is.
    pub fn applied<'a>(&self, force: &'a Points) -> Option<&'a Points> {
        (self.is_pushed || self.ctx.settings.method == Method::Explicit).then_some(force)
    }

    /// What ends the substep, and begins the next one where that `goes_on` at once.
    pub fn finish<'a>(&self, force: &'a Points, goes_on: bool) -> Finish<'a> {
        Finish { limit: self.limit, h: self.h, next: goes_on.then(|| self.motion(force)) }
    }

    /// Coarse levels, tethers, and then the springs: strands the last, and best held. Of a large cloth threads
    /// also solve the skin, and finish the substep: true where they did that.
    pub fn solve_strands(&self, scratch: &mut Scratch, span: Range<f32>, goes_on: bool) -> bool {
        let Scratch { lanes, worker_scratch, pins, levels, simd_level, .. } = scratch;
        let run = self.levels(*simd_level);
        if let Some(run) = &run {
            levels.solve(run, lanes, pins, (&mut worker_scratch.strand_scratch, &mut worker_scratch.across));
        }
        let strand_material = StrandMaterial::new(&self.ctx.material, self.h);
        if let Some((pool, lattice)) = self.helpers {
            let Scratch { skin, bend_factors, worker_scratches, applied_force, .. } = scratch;
            let finish = (!self.is_near && !self.touches).then(|| self.finish(applied_force, goes_on));
            let work = SharedStep {
                grid_solver: GridStrandSolver { lattice, strand_material, bend_factors, simd_level: *simd_level },
                cells: CellMaterial::new(&self.ctx.material, self.h, bend_factors),
                last: self.last,
                levels: run.as_ref().map(|run| (run, &*levels)),
                tethers: self.ctx.tethers.map_or(&[], Tethers::of_cloth),
                pins,
                slack: self.slack,
                skin: skin.solver(self.ctx, span, self.h, *simd_level),
                finish,
            };
            grid_substep::solve(pool, lanes, worker_scratches, &work);
            return finish.is_some();
        }
        if let Some(run) = &run {
            for band in lanes.order.bands() {
                let Run { position, inverse_mass, .. } = lanes.band(band);
                levels.move_band(run, band, position, inverse_mass, &mut worker_scratch.across);
            }
        }
        self.solve_tethers(scratch);
        let Scratch {
            lanes,
            gathered,
            ways,
            bending,
            worker_scratch: WorkerScratch { strand_scratch, seam, shear_scratch, .. },
            bend_factors,
            simd_level,
            ..
        } = scratch;
        let (material, h) = (&self.ctx.material, self.h);
        let strand_packs = &self.topology.strand_packs;
        let strand_pack_solver = (!strand_packs.is_empty()).then_some(StrandPackSolver {
            strand_packs,
            strand_material,
            strand_scratch: &mut *strand_scratch,
        });
        self.loose(false, *bending, strand_pack_solver).solve(lanes, gathered, ways, *simd_level);
        if let Some(lattice) = &self.topology.lattice {
            let mut run = lanes.whole();
            let mut grid = run.grid();
            cells::solve(
                &mut grid,
                lattice,
                CellMaterial::new(material, h, bend_factors),
                seam,
                shear_scratch,
                *simd_level,
            );
            GridStrandSolver { lattice, strand_material, bend_factors, simd_level: *simd_level }.solve(
                &mut grid,
                self.last,
                strand_scratch,
            );
        }
        false
    }

    /// All springs, colour after colour.
    pub fn solve_springs(&self, scratch: &mut Scratch) {
        let Scratch { lanes, gathered, ways, bending, simd_level, .. } = scratch;
        self.loose(true, *bending, None).solve(lanes, gathered, ways, *simd_level);
    }

    fn loose<'a>(
        &'a self,
        with_strands: bool,
        bending: Option<BendSolver>,
        strand_pack_solver: Option<StrandPackSolver<'a>>,
    ) -> UnstructuredPass<'a> {
        UnstructuredPass {
            topology: self.topology,
            material: &self.ctx.material,
            h: self.h,
            with_strands,
            bending,
            strand_pack_solver,
        }
    }

    /// Tethers to hands, then those to pins.
    pub fn solve_tethers(&self, scratch: &mut Scratch) {
        let Scratch { lanes, pins, simd_level, .. } = scratch;
        grab::solve_tethers(lanes, self.ctx.grabs, self.slack);
        if let Some(tethers) = self.ctx.tethers {
            let (position, inverse_mass) = (&mut lanes.position.0, &lanes.inverse_mass);
            tether::solve(position, inverse_mass, 0, tethers.of_cloth(), pins, self.slack, *simd_level);
        }
    }

    /// What holds the cloth to an animated mesh in the part `span` of the step, unless threads have done it.
    pub fn solve_skin(&self, scratch: &mut Scratch, span: Range<f32>) {
        let Scratch { lanes, skin, simd_level, .. } = scratch;
        if self.helpers.is_none()
            && let Some(solver) = skin.solver(self.ctx, span, self.h, *simd_level)
        {
            solver.solve(&mut lanes.whole());
        }
    }

    /// Takes back what obstacles have moved beyond its largest distance from an animated mesh, in the part `span` of the step.
    pub fn hold_to_skin(&self, scratch: &mut Scratch, span: Range<f32>) {
        let Scratch { lanes, skin, simd_level, .. } = scratch;
        if let Some(solver) = skin.solver(self.ctx, span, self.h, *simd_level) {
            solver.distances_only().solve(&mut lanes.whole());
        }
    }

    /// The coarse levels, if there are tethers: both hold the cloth within its length.
    fn levels(&self, simd_level: SimdLevel) -> Option<LevelSolve<'_>> {
        Some(LevelSolve {
            levels: &self.topology.levels,
            passes: self.levels,
            tethers: self.ctx.tethers.filter(|tethers| !tethers.is_empty())?,
            slack: self.slack,
            stretch: Scaled::new(self.ctx.material.strand_stiffness(), self.h),
            last: self.last,
            simd_level,
        })
    }
}
