//! The loop over the substeps.

use bevy::{math::Vec3A, tasks::TaskPool};

use super::{
    Lattice, LevelPass, Method, Particles, Scratch, StepContext, StepReport, Tethers, Topology,
    constraint::{
        anchor,
        braid::Strung,
        grab,
        level::LevelRun,
        spring::{self, Scaled},
        strand::Both,
        tether,
        weave::{self, Last, Sheet, Weave, Yarn},
    },
    contact, explicit,
    force::wind,
    integrate::{self, Finish, Motion, SpeedLimit},
    lanes::{Points, Run},
    share::{self, Work},
    topology::SpringKind,
};

/// Longest time step that is simulated, s. A longer one is cut down to it: after a stall the cloth falls behind the
/// clock instead of being thrown about.
pub const MAX_TIME_STEP: f32 = 0.1;

/// How often the forces of the air are renewed within a step, Hz. They change more slowly than the springs.
const AIR_RATE: f32 = 160.0;

/// Advances one cloth by `ctx.dt`.
///
/// One substep of duration h integrates the velocities (symplectic Euler), moves the fixed particles, solves the
/// constraints and projects the particles out of the obstacles. Small substeps with one iteration each follow
/// Macklin et al., "Small Steps in Physics Simulation" (2019).
///
/// Nothing is allocated once `scratch` has seen a cloth of this size. The same input gives the same bits. A time step
/// that isn't positive does nothing.
pub fn step(particles: &mut Particles, topology: &Topology, ctx: &StepContext, scratch: &mut Scratch) -> StepReport {
    let dt = ctx.dt.min(MAX_TIME_STEP);
    if particles.is_empty() || ctx.dt.is_nan() || ctx.dt <= 0.0 {
        return StepReport { substeps: 0, needed_substeps: 0, stiffness_scale: 1.0, contacts: 0, steady_force: 0.0 };
    }
    let instructions = scratch.instructions;
    let is_near = contact::is_any_near(particles, ctx, dt);
    let is_tethered = ctx.tethers.is_some_and(|tethers| !tethers.is_empty());
    let with_care = is_near || !is_tethered || !ctx.grabs.is_empty();
    let (wanted, levels) = ctx.effort.of_step(with_care, dt);
    let helpers = helpers(topology, ctx);
    let mut has_moved = false;
    let is_pushed = match helpers {
        Some((pool, _)) => {
            let is_free = !wind::feels_air(ctx);
            let free = is_free.then(|| Motion::free(ctx, dt / wanted as f32));
            let is_pushed = share::load(pool, &mut scratch.lanes, particles, topology.order(), free, instructions);
            has_moved = is_free && !is_pushed;
            is_pushed
        }
        None => {
            scratch.lanes.load(particles, topology.order(), instructions);
            particles.is_pushed(0..particles.len())
        }
    };
    grab::take_up(&mut scratch.lanes, ctx.grabs);
    let (most, needed_substeps, stiffness_scale, levels) = match ctx.method {
        Method::Strands => (u32::MAX, wanted, 1.0, levels),
        Method::Xpbd => (u32::MAX, wanted, 1.0, &[][..]),
        Method::Explicit => {
            let (needed, scale) =
                explicit::stable_substeps(&scratch.lanes, topology, ctx, dt, &mut scratch.spring_sums);
            (ctx.max_substeps.max(1), needed, scale, &[][..])
        }
    };
    let substeps = needed_substeps.min(most);
    let is_pushed = wind::feels_air(ctx) || is_pushed;
    let last = Last::between(ctx.anchors, topology.order());
    let most = if ctx.method == Method::Explicit { f32::INFINITY } else { ctx.max_velocity };
    let limit = SpeedLimit { around: anchor::mean_velocity(ctx.anchors, dt), most };
    let h = dt / substeps as f32;
    let substep = Substep { topology, ctx, h, stiffness_scale, is_pushed, is_near, limit, helpers, last, levels };
    let air_interval = ((1.0 / (AIR_RATE * substep.h)) as u32).max(1);
    let mut contacts = 0;

    scratch.air.sample(particles, ctx);
    substep.prepare(scratch);
    for i in 0..substeps {
        let span = i as f32 / substeps as f32..(i + 1) as f32 / substeps as f32;
        if i % air_interval == 0 {
            substep.renew_steady_force(particles, air_interval, scratch);
        }
        grab::carry(&mut scratch.lanes, ctx.grabs, span.clone(), substep.h);
        if ctx.method == Method::Explicit {
            substep.add_spring_forces(particles, scratch);
        }
        if !has_moved {
            substep.move_freely(scratch);
        }
        anchor::advance(&mut scratch.lanes, ctx.anchors, span.end, dt);
        if let Some(tethers) = ctx.tethers {
            scratch.pins.read(tethers, &scratch.lanes);
        }
        // Hands, and forces that are renewed, come first.
        let goes_on = i + 1 < substeps && ctx.grabs.is_empty() && !(is_pushed && (i + 1) % air_interval == 0);
        has_moved = goes_on && ctx.method != Method::Explicit;
        let mut is_finished = false;
        match ctx.method {
            Method::Strands => {
                grab::solve(&mut scratch.lanes, ctx.grabs, span.clone(), substep.h);
                is_finished = substep.solve_strands(scratch, has_moved);
            }
            Method::Xpbd => {
                substep.solve_springs(scratch);
                grab::solve(&mut scratch.lanes, ctx.grabs, span.clone(), substep.h);
                // After the hands: where both can't hold, pins are stronger.
                substep.solve_tethers(scratch);
            }
            Method::Explicit => grab::solve(&mut scratch.lanes, ctx.grabs, span.clone(), substep.h),
        }
        if is_near {
            contacts = contact::project(&mut scratch.lanes, ctx.obstacles, &ctx.material, span);
        }
        // Without a constraint the integrated velocity is the exact one: rounding stays out of it.
        if !is_finished && (ctx.method != Method::Explicit || contacts > 0 || !ctx.grabs.is_empty()) {
            let Scratch { lanes, applied_force, .. } = &mut *scratch;
            integrate::finish(&mut lanes.whole(), substep.finish(applied_force, has_moved), instructions);
        }
    }
    match helpers {
        Some((pool, _)) => share::store(pool, &mut scratch.lanes, particles, instructions),
        None => scratch.lanes.store(particles, instructions),
    }
    let steady_force = if is_pushed { scratch.steady_force.iter().map(|force| force.length()).sum() } else { 0.0 };
    StepReport { substeps, needed_substeps, stiffness_scale, contacts, steady_force }
}

/// The threads that share the work, where it pays: all springs are on the lattice, and no hand holds it.
fn helpers<'a>(topology: &'a Topology, ctx: &StepContext<'a>) -> Option<(&'a TaskPool, &'a Lattice)> {
    let is_woven = ctx.method == Method::Strands && topology.batches.iter().all(|batch| batch.woven);
    let is_large = topology.particle_count() >= share::LARGE;
    ctx.pool.zip(topology.lattice.as_ref()).filter(|_| is_large && is_woven && ctx.grabs.is_empty())
}

/// What all substeps of a step have in common.
#[derive(Clone, Copy)]
struct Substep<'a> {
    topology: &'a Topology,
    ctx: &'a StepContext<'a>,
    /// Duration, s.
    h: f32,
    /// Share of the stiffness and damping that is used.
    stiffness_scale: f32,
    /// Whether anything but gravity acts.
    is_pushed: bool,
    /// Whether anything is so near that it may be touched.
    is_near: bool,
    limit: SpeedLimit,
    /// The threads that share the work, and the lattice that all springs are on.
    helpers: Option<(&'a TaskPool, &'a Lattice)>,
    last: Last,
    levels: &'a [LevelPass],
}

impl Substep<'_> {
    /// Works out what doesn't change from substep to substep.
    fn prepare(&self, scratch: &mut Scratch) {
        // Threads that share the work have done it already.
        if self.ctx.method == Method::Strands && self.topology.lattice.is_some() && self.helpers.is_none() {
            for band in scratch.lanes.order.bands() {
                let Run { inverse_mass, row_masses, .. } = scratch.lanes.band(band);
                weave::masses_along_rows(inverse_mass, band, row_masses, scratch.instructions);
            }
        }
        if let Some(run) = self.levels(scratch) {
            scratch.levels.fit(&run, &scratch.lanes);
        }
    }

    /// Sums up the forces that act for the next `interval` substeps.
    fn renew_steady_force(&self, particles: &mut Particles, interval: u32, scratch: &mut Scratch) {
        let Scratch { lanes, air, steady_force, applied_force, instructions, .. } = scratch;
        if !self.is_pushed {
            return;
        }
        steady_force.clone_from(&particles.force);
        if wind::feels_air(self.ctx) {
            lanes.store(particles, *instructions);
            wind::apply_air(particles, self.topology, self.ctx, self.h * interval as f32, air, steady_force);
        }
        applied_force.load(lanes.order, steady_force, *instructions);
    }

    /// Adds the forces of the springs to the steady one.
    fn add_spring_forces(&self, particles: &mut Particles, scratch: &mut Scratch) {
        let Scratch { lanes, steady_force, force, applied_force, instructions, .. } = scratch;
        steady_force.resize(particles.len(), Vec3A::ZERO);
        force.clone_from(steady_force);
        lanes.store(particles, *instructions);
        explicit::add_spring_forces(particles, self.topology, &self.ctx.material, self.stiffness_scale, force);
        applied_force.load(lanes.order, force, *instructions);
    }

    /// Moves the particles as if nothing held them together.
    fn move_freely(&self, scratch: &mut Scratch) {
        let Scratch { lanes, applied_force, instructions, .. } = scratch;
        integrate::predict(&mut lanes.whole(), self.motion(applied_force), *instructions);
    }

    fn motion<'a>(&self, force: &'a Points) -> Motion<'a> {
        let is_applied = self.is_pushed || self.ctx.method == Method::Explicit;
        Motion { force: is_applied.then_some(force), ..Motion::free(self.ctx, self.h) }
    }

    /// What ends the substep, and begins the next one where that `goes_on` at once.
    fn finish<'a>(&self, force: &'a Points, goes_on: bool) -> Finish<'a> {
        Finish { limit: self.limit, h: self.h, next: goes_on.then(|| self.motion(force)) }
    }

    /// Coarse levels, tethers, and then the springs: threads as strands, the last and best held. Of a large cloth threads
    /// also finish the substep: true where they did.
    fn solve_strands(&self, scratch: &mut Scratch, goes_on: bool) -> bool {
        let run = self.levels(scratch);
        if let Some(run) = &run {
            let Scratch { lanes, loom, pins, levels, .. } = scratch;
            levels.solve(run, lanes, pins, loom);
        }
        let scaled = |kind| Scaled::new(self.ctx.material.spring(kind), self.h);
        let bend = Some(scaled(SpringKind::Bend)).filter(Scaled::acts);
        let yarn = Yarn { stretch: scaled(SpringKind::Structural), bend, give: 1.0 };
        if let Some((pool, lattice)) = self.helpers {
            let Scratch { lanes, pins, levels, benches, applied_force, instructions, .. } = scratch;
            let finish = (!self.is_near).then(|| self.finish(applied_force, goes_on));
            let work = Work {
                weave: Weave { lattice, yarn, instructions: *instructions },
                shear: scaled(SpringKind::Shear),
                last: self.last,
                levels: run.as_ref().map(|run| (run, &*levels)),
                tethers: self.ctx.tethers.map_or(&[], Tethers::of_cloth),
                pins,
                slack: self.ctx.tether_slack,
                finish,
            };
            share::solve(pool, lanes, benches, &work);
            return finish.is_some();
        }
        if let Some(run) = &run {
            for band in scratch.lanes.order.bands() {
                let Run { position, inverse_mass, .. } = scratch.lanes.band(band);
                scratch.levels.move_band(run, position, inverse_mass, band);
            }
        }
        self.solve_tethers(scratch);
        let Scratch { lanes, beads, loom, spool, seam, instructions, .. } = scratch;
        let (material, h) = (&self.ctx.material, self.h);
        let loose = self.topology.batches.iter().filter(|batch| !batch.woven);
        let braids = &self.topology.braids;
        let strung = (!braids.is_empty()).then_some(Strung { braids, yarn, spool });
        spring::solve(lanes, self.topology, loose, material, h, beads, strung, *instructions);
        if let Some(lattice) = &self.topology.lattice {
            let mut sheet = Sheet {
                position: &mut lanes.position.0,
                previous: &lanes.previous.0,
                inverse_mass: &lanes.inverse_mass,
                row_masses: &lanes.row_masses,
            };
            weave::solve_diagonals(&mut sheet, lattice, scaled(SpringKind::Shear), seam, *instructions);
            Weave { lattice, yarn, instructions: *instructions }.solve::<Both>(&mut sheet, self.last, loom);
        }
        false
    }

    /// All springs, colour after colour.
    fn solve_springs(&self, scratch: &mut Scratch) {
        let batches = self.topology.batches.iter();
        let Scratch { lanes, beads, instructions, .. } = scratch;
        spring::solve(lanes, self.topology, batches, &self.ctx.material, self.h, beads, None, *instructions);
    }

    /// Tethers to hands, then those to pins.
    fn solve_tethers(&self, scratch: &mut Scratch) {
        let Scratch { lanes, pins, instructions, .. } = scratch;
        grab::solve_tethers(lanes, self.ctx.grabs, self.ctx.tether_slack);
        if let Some(tethers) = self.ctx.tethers {
            let (position, inverse_mass) = (&mut lanes.position.0, &lanes.inverse_mass);
            tether::solve(position, inverse_mass, 0, tethers.of_cloth(), pins, self.ctx.tether_slack, *instructions);
        }
    }

    /// The coarse levels, if there are tethers: both hold the cloth within its length.
    fn levels(&self, scratch: &Scratch) -> Option<LevelRun<'_>> {
        Some(LevelRun {
            levels: &self.topology.levels,
            passes: self.levels,
            tethers: self.ctx.tethers.filter(|tethers| !tethers.is_empty())?,
            slack: self.ctx.tether_slack,
            stretch: Scaled::new(self.ctx.material.spring(SpringKind::Structural), self.h),
            last: self.last,
            instructions: scratch.instructions,
        })
    }
}
