//! The loop over the substeps.

use core::ops::Range;

use bevy_math::Vec3A;
use bevy_tasks::TaskPool;

use crate::{
    constraint::{
        attach::{grab, pin_motion},
        strand::grid::StrandDirection,
    },
    contact::{
        self,
        body::Bodies,
        feature::{self, ClothInStep, FeatureContacts},
        mesh::MeshContacts,
    },
    explicit::{self, Stability},
    force::wind,
    imperfection,
    input::{ContactRisk, MAX_TIME_STEP, Method, SelfCollision, StepContext},
    integrate::{self, Motion, SpeedLimit},
    layout::simd::SimdLevel,
    parallel::grid_substep,
    particles::{Particles, lanes::Lanes},
    scratch::Scratch,
    shape::sharp_features::Sharpness,
    step::{
        report::{StepReport, SubstepReason},
        substep::Substep,
    },
    topology::{Topology, lattice::Lattice, level::LevelPass},
};

pub(crate) mod report;
mod substep;

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
    let mut touch = core::mem::take(&mut scratch.touch);
    let report = match Plan::new(particles, topology, ctx, scratch) {
        None => StepReport::NOTHING,
        Some(plan) => {
            let substeps = plan.substeps;
            let mut running = [Running::begin(plan, particles, topology, ctx, scratch, substeps, Vec3A::ZERO)];
            run(&mut running, substeps, &mut touch);
            let [running] = running;
            running.end()
        }
    };
    scratch.touch = touch;
    report
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
/// Those whose [`self_collision`](crate::StepSettings::self_collision) isn't off meet each other. All take as many substeps as the
/// one that needs most.
pub fn step_together(members: &mut [Member]) {
    let Some(first) = members.first_mut() else { return };
    let mut touch = core::mem::take(&mut first.scratch.touch);
    let plans: Vec<Option<Plan>> = members
        .iter_mut()
        .map(|Member { particles, topology, ctx, scratch, .. }| Plan::new(particles, topology, ctx, scratch))
        .collect();
    let substeps = plans.iter().flatten().map(|plan| plan.substeps).max().unwrap_or(0);
    let mut numbers = Vec::new();
    let mut running = Vec::new();
    for (number, (member, plan)) in members.iter_mut().zip(plans).enumerate() {
        member.report = Some(StepReport::NOTHING);
        let Some(plan) = plan else { continue };
        let Member { particles, topology, ctx, scratch, offset, .. } = member;
        running.push(Running::begin(plan, particles, topology, ctx, scratch, substeps, *offset));
        numbers.push(number);
    }
    run(&mut running, substeps, &mut touch);
    let reports: Vec<StepReport> = running.into_iter().map(Running::end).collect();
    for (number, report) in numbers.into_iter().zip(reports) {
        members[number].report = Some(report);
    }
    if let Some(first) = members.first_mut() {
        first.scratch.touch = touch;
    }
}

/// The substeps of cloths that may touch each other.
fn run(cloths: &mut [Running], substeps: u32, touch: &mut FeatureContacts) {
    let may_touch = touch.begin(cloths);
    for i in 0..substeps {
        let span = i as f32 / substeps as f32..(i + 1) as f32 / substeps as f32;
        for cloth in &mut *cloths {
            cloth.advance(i, span.clone());
        }
        if may_touch && let Some(Substep { h, ctx, .. }) = cloths.first().map(|cloth| cloth.substep) {
            let touched = touch.solve(cloths, span.clone(), h, ctx.dt.min(MAX_TIME_STEP));
            // Whose they are isn't known: they count once.
            cloths[0].touched = touched;
        }
        for cloth in &mut *cloths {
            cloth.finish(span.clone());
        }
    }
}

/// What is known of a cloth's step before its substeps begin.
struct Plan<'a> {
    dt: f32,
    is_near: bool,
    /// Length that the longest edge is taken to have at obstacles, m.
    longest_edge: f32,
    levels: &'a [LevelPass],
    substeps: u32,
    reason: SubstepReason,
    stability: Stability,
}

impl<'a> Plan<'a> {
    /// None where there is nothing to do.
    fn new(
        particles: &Particles,
        topology: &Topology,
        ctx: &'a StepContext<'a>,
        scratch: &mut Scratch,
    ) -> Option<Self> {
        let dt = ctx.dt.min(MAX_TIME_STEP);
        scratch.bodies.begin(ctx);
        if particles.is_empty() || ctx.dt.is_nan() || ctx.dt <= 0.0 {
            return None;
        }
        let mut near = contact::near_obstacles(particles, ctx, dt).peekable();
        let is_near = near.peek().is_some();
        // Nothing else asks for it: a cloth that nothing is near needs no surface.
        let longest_edge = if is_near { feature::longest_edge(near.clone(), particles, topology, ctx) } else { 0.0 };
        let is_tethered = ctx.tethers.is_some_and(|tethers| !tethers.is_empty());
        let touches = ctx.settings.self_collision != SelfCollision::Off;
        let is_on_body = !ctx.attached_pins.is_empty();
        let some = match () {
            () if is_near => Some(SubstepReason::Obstacle),
            () if touches => Some(SubstepReason::SelfCollision),
            () if is_on_body => Some(SubstepReason::OnBody),
            () if !ctx.grabs.is_empty() => Some(SubstepReason::Grabbed),
            () if !is_tethered => Some(SubstepReason::Untethered),
            () => None,
        };
        let risk =
            match (feature::sharpest(near, particles, topology, longest_edge, ctx, dt), ctx.settings.self_collision) {
                (Some((Sharpness::Tip, wanted)), _) => ContactRisk::Tip(wanted),
                (Some((Sharpness::Edge, wanted)), _) => ContactRisk::Edge(wanted),
                (None, SelfCollision::Robust) => ContactRisk::Robust,
                (None, _) if some.is_some() => ContactRisk::Some,
                (None, _) => ContactRisk::None,
            };
        let (wanted, levels) = ctx.settings.substep_policy.of_step(risk, dt);
        let (without_risk, _) = ctx.settings.substep_policy.of_step(ContactRisk::None, dt);
        let reason = match ctx.settings.method {
            Method::Explicit => SubstepReason::Stability,
            Method::Strands | Method::Xpbd if !ctx.settings.substep_policy.follows_time_step => SubstepReason::Fixed,
            Method::Strands | Method::Xpbd if wanted == without_risk => SubstepReason::Strain,
            Method::Strands | Method::Xpbd => SubstepReason::of_risk(risk, some.unwrap_or_default()),
        };
        // Levels move what hangs on a body without its weight on the body.
        let levels = if is_on_body { &[] } else { levels };
        let (most, stability, levels) = match ctx.settings.method {
            Method::Strands => (u32::MAX, Stability::unconditional(wanted), levels),
            Method::Xpbd => (u32::MAX, Stability::unconditional(wanted), &[][..]),
            Method::Explicit => {
                scratch.lanes.load(particles, topology.order(), scratch.simd_level);
                grab::take_up(&mut scratch.lanes, ctx.grabs);
                scratch.body_attachments.begin(&mut scratch.lanes, topology, ctx);
                let stability = explicit::stability(&scratch.lanes, topology, ctx, dt, &mut scratch.spring_sums);
                (ctx.settings.max_substeps.max(1), stability, &[][..])
            }
        };
        let substeps = stability.needed.min(most);
        Some(Self { dt, is_near, longest_edge, levels, substeps, reason, stability })
    }
}

/// A cloth within its step.
pub(crate) struct Running<'a> {
    pub particles: &'a mut Particles,
    pub scratch: &'a mut Scratch,
    pub topology: &'a Topology,
    pub ctx: &'a StepContext<'a>,
    substep: Substep<'a>,
    /// Its origin from that of the first cloth, m.
    pub offset: Vec3A,
    /// Length that its longest edge is taken to have at obstacles, m.
    pub longest_edge: f32,
    dt: f32,
    substeps: u32,
    reason: SubstepReason,
    /// Substeps from one renewal of the air's forces to the next.
    air_interval: u32,
    /// Whether the free motion of the coming substep is done.
    has_moved: bool,
    /// Whether threads that share the work have finished the substep.
    is_finished: bool,
    contacts: u32,
    /// Pairs of features that touched in the latest substep.
    touched: u32,
}

impl<'a> Running<'a> {
    fn begin(
        plan: Plan<'a>,
        particles: &'a mut Particles,
        topology: &'a Topology,
        ctx: &'a StepContext<'a>,
        scratch: &'a mut Scratch,
        substeps: u32,
        offset: Vec3A,
    ) -> Self {
        let Plan { dt, is_near, longest_edge, levels, stability, .. } = plan;
        let reason = if plan.substeps < substeps { SubstepReason::OtherCloth } else { plan.reason };
        let h = dt / substeps as f32;
        let helpers = helpers(topology, ctx);
        imperfection::seed(particles, topology, ctx);
        let Loaded { is_pushed, has_moved } = load(particles, topology, ctx, h, helpers, scratch);
        grab::take_up(&mut scratch.lanes, ctx.grabs);
        scratch.broad_phase.begin();
        scratch.faces.resize_with(ctx.obstacles.len().max(scratch.faces.len()), MeshContacts::default);
        scratch.faces.iter_mut().for_each(MeshContacts::begin);
        scratch.body_attachments.begin(&mut scratch.lanes, topology, ctx);
        let substep = Substep {
            topology,
            ctx,
            h,
            stability,
            is_pushed,
            is_near,
            touches: ctx.settings.self_collision != SelfCollision::Off || is_near,
            limit: SpeedLimit {
                around: pin_motion::mean_velocity(ctx.pin_motions, dt),
                most: ctx.settings.max_velocity,
            },
            helpers,
            last: StrandDirection::between(ctx.pin_motions, topology.order()),
            levels,
            slack: ctx.slack(),
        };
        scratch.air.sample(particles, ctx);
        substep.prepare(scratch);
        scratch.body_attachments.rest(&mut scratch.lanes);
        Self {
            particles,
            scratch,
            topology,
            ctx,
            substep,
            offset,
            longest_edge,
            dt,
            substeps,
            reason,
            air_interval: ((1.0 / (AIR_RATE * h)) as u32).max(1),
            has_moved,
            is_finished: false,
            contacts: 0,
            touched: 0,
        }
    }

    /// Moves the cloth through the part `span` of the step, its substep `i`, as if it touched nothing.
    fn advance(&mut self, i: u32, span: Range<f32>) {
        let Self { particles, scratch, substep, air_interval, .. } = self;
        let ctx = substep.ctx;
        if i.is_multiple_of(*air_interval) {
            substep.renew_steady_force(particles, *air_interval, scratch);
        }
        grab::carry(&mut scratch.lanes, ctx.grabs, span.clone(), substep.h);
        if ctx.settings.method == Method::Explicit {
            substep.add_spring_forces(particles, scratch);
        }
        if !self.has_moved {
            substep.move_freely(scratch);
        }
        pin_motion::advance(&mut scratch.lanes, ctx.pin_motions, span.end, self.dt);
        let Scratch { lanes, body_attachments, applied_force, .. } = &mut **scratch;
        body_attachments.advance(lanes, ctx, span.clone(), self.dt, substep.applied(applied_force));
        scratch.bodies.advance(ctx, span.clone(), substep.h);
        if let Some(tethers) = ctx.tethers {
            scratch.pins.read(tethers, &scratch.lanes);
        }
        // Hands, and forces that are renewed, come first.
        let is_renewed = substep.is_pushed && (i + 1).is_multiple_of(*air_interval);
        let goes_on = i + 1 < self.substeps && ctx.grabs.is_empty() && !is_renewed;
        self.has_moved = goes_on && ctx.settings.method != Method::Explicit;
        self.is_finished = false;
        match ctx.settings.method {
            Method::Strands => {
                grab::solve(&mut scratch.lanes, ctx.grabs, span, substep.h);
                self.is_finished = substep.solve_strands(scratch, self.has_moved);
            }
            Method::Xpbd => {
                substep.solve_springs(scratch);
                grab::solve(&mut scratch.lanes, ctx.grabs, span, substep.h);
                // After the hands: where both can't hold, pins are stronger.
                substep.solve_tethers(scratch);
            }
            Method::Explicit => grab::solve(&mut scratch.lanes, ctx.grabs, span, substep.h),
        }
        let Scratch { lanes, body_attachments, .. } = &mut **scratch;
        body_attachments.settle(lanes, ctx, substep.h);
    }

    /// Keeps the cloth out of obstacles and ends the substep.
    fn finish(&mut self, span: Range<f32>) {
        let Self { scratch, substep, .. } = self;
        let ctx = substep.ctx;
        if substep.is_near {
            self.contacts = {
                let Scratch { lanes, broad_phase, faces, bodies, simd_level, .. } = &mut **scratch;
                contact::project(lanes, (broad_phase, faces, bodies), ctx, span, substep.h, *simd_level)
            };
        }
        // Without a constraint the integrated velocity is the exact one: rounding stays out of it.
        let is_constrained = ctx.settings.method != Method::Explicit || substep.touches || !ctx.grabs.is_empty();
        if !self.is_finished && is_constrained {
            let Scratch { lanes, applied_force, simd_level, .. } = &mut **scratch;
            integrate::finish(&mut lanes.whole(), substep.finish(applied_force, self.has_moved), *simd_level);
        }
    }

    /// Hands the state back.
    fn end(self) -> StepReport {
        let Self { particles, scratch, substep, substeps, reason, contacts, touched, .. } = self;
        let contacts = contacts + touched;
        let Scratch { lanes, steady_force, simd_level, .. } = scratch;
        match substep.helpers {
            Some((pool, _)) => grid_substep::store(pool, lanes, particles, *simd_level),
            None => lanes.store(particles, *simd_level),
        }
        let steady_force = if substep.is_pushed { steady_force.iter().map(|force| force.length()).sum() } else { 0.0 };
        let Stability { needed: needed_substeps, scale: stiffness_scale, .. } = substep.stability;
        StepReport { substeps, reason, needed_substeps, stiffness_scale, contacts, steady_force }
    }
}

impl ClothInStep for Running<'_> {
    fn ctx(&self) -> &StepContext<'_> {
        self.ctx
    }

    fn topology(&self) -> &Topology {
        self.topology
    }

    fn lanes(&self) -> &Lanes {
        &self.scratch.lanes
    }

    fn lanes_mut(&mut self) -> &mut Lanes {
        &mut self.scratch.lanes
    }

    fn bodies(&self) -> &Bodies {
        &self.scratch.bodies
    }

    fn bodies_mut(&mut self) -> &mut Bodies {
        &mut self.scratch.bodies
    }

    fn simd_level(&self) -> SimdLevel {
        self.scratch.simd_level
    }

    fn offset(&self) -> Vec3A {
        self.offset
    }

    fn longest_edge(&self) -> f32 {
        self.longest_edge
    }

    fn is_near(&self) -> bool {
        self.substep.is_near
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
    let Scratch { lanes, simd_level, .. } = scratch;
    let feels_air = wind::feels_air(ctx);
    let Some((pool, lattice)) = helpers else {
        lanes.load(particles, topology.order(), *simd_level);
        return Loaded { is_pushed: feels_air || particles.is_pushed(0..particles.len()), has_moved: false };
    };
    let free = (!feels_air).then(|| Motion::free(ctx, h));
    let is_pushed = feels_air | grid_substep::load(pool, lanes, particles, lattice.order(), free, *simd_level);
    Loaded { is_pushed, has_moved: !is_pushed }
}

/// The threads that share the work, where it pays: all springs are on the lattice, and neither hands nor bodies hold it.
fn helpers<'a>(topology: &'a Topology, ctx: &StepContext<'a>) -> Option<(&'a TaskPool, &'a Lattice)> {
    let is_on_strands = ctx.settings.method == Method::Strands && topology.batches.iter().all(|batch| batch.on_strand);
    let is_large = topology.particle_count() >= grid_substep::LARGE;
    let is_free = ctx.grabs.is_empty() && ctx.attached_pins.is_empty();
    ctx.pool.zip(topology.lattice.as_ref()).filter(|_| is_large && is_on_strands && is_free)
}
