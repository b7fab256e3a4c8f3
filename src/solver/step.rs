//! The loop over the substeps.

use bevy::{math::Vec3A, tasks::TaskPool};

use super::{
    Lattice, Method, Particles, Scratch, StepContext, StepReport, Topology,
    constraint::{anchor, grab, weave::Last},
    contact, explicit,
    force::wind,
    integrate::{self, Motion, SpeedLimit},
    share,
};

mod substep;

use substep::Substep;

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
/// Nothing is allocated once `scratch` has seen a cloth of this size, but for what threads need that share one. The same
/// input gives the same bits. A time step that isn't positive does nothing.
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
    let Loaded { is_pushed, mut has_moved } = load(particles, topology, ctx, dt / wanted as f32, helpers, scratch);
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
    let last = Last::between(ctx.anchors, topology.order());
    let most = if ctx.method == Method::Explicit { f32::INFINITY } else { ctx.max_velocity };
    let limit = SpeedLimit { around: anchor::mean_velocity(ctx.anchors, dt), most };
    let h = dt / substeps as f32;
    let substep = Substep {
        topology,
        ctx,
        h,
        stiffness_scale,
        is_pushed,
        is_near,
        limit,
        helpers,
        last,
        levels,
        slack: ctx.slack(),
    };
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
            contacts = contact::project(&mut scratch.lanes, ctx, span);
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

/// One of several cloths that are stepped together.
#[derive(Debug)]
pub struct Member<'a> {
    /// Its state.
    pub particles: &'a mut Particles,
    /// What is connected to what.
    pub topology: &'a Topology,
    /// What surrounds it. All members have the same time step.
    pub ctx: &'a StepContext<'a>,
    /// Working memory, of each member its own.
    pub scratch: &'a mut Scratch,
    /// Its origin from that of the first member, m.
    pub offset: Vec3A,
    /// What the step did, afterwards.
    pub report: Option<StepReport>,
}

/// Advances cloths that may touch each other, substep by substep, by the time step that they share.
///
/// Those whose [`self_collision`](StepContext::self_collision) isn't off meet each other.
pub fn step_together(members: &mut [Member]) {
    for member in members {
        member.report = Some(step(member.particles, member.topology, member.ctx, member.scratch));
    }
}

/// What is found when a cloth is taken over.
struct Loaded {
    /// Whether anything but gravity acts.
    is_pushed: bool,
    /// Whether the free motion of the first substep is done.
    has_moved: bool,
}

/// Takes over the state of a cloth. Threads that share it begin the first substep, of `h` seconds, where they can.
fn load(
    particles: &Particles,
    topology: &Topology,
    ctx: &StepContext,
    h: f32,
    helpers: Option<(&TaskPool, &Lattice)>,
    scratch: &mut Scratch,
) -> Loaded {
    let Scratch { lanes, instructions, .. } = scratch;
    let feels_air = wind::feels_air(ctx);
    let Some((pool, lattice)) = helpers else {
        lanes.load(particles, topology.order(), *instructions);
        return Loaded { is_pushed: feels_air || particles.is_pushed(0..particles.len()), has_moved: false };
    };
    let free = (!feels_air).then(|| Motion::free(ctx, h));
    let is_pushed = feels_air | share::load(pool, lanes, particles, lattice.order(), free, *instructions);
    Loaded { is_pushed, has_moved: !is_pushed }
}

/// The threads that share the work, where it pays: all springs are on the lattice, and no hand holds it.
fn helpers<'a>(topology: &'a Topology, ctx: &StepContext<'a>) -> Option<(&'a TaskPool, &'a Lattice)> {
    let is_woven = ctx.method == Method::Strands && topology.batches.iter().all(|batch| batch.woven);
    let is_large = topology.particle_count() >= share::LARGE;
    ctx.pool.zip(topology.lattice.as_ref()).filter(|_| is_large && is_woven && ctx.grabs.is_empty())
}
