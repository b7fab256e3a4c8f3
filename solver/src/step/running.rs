//! A cloth within its step: it is taken over, advanced substep by substep, and handed back.

use core::ops::Range;

use bevy_math::Vec3A;
use bevy_tasks::TaskPool;

use crate::{
    constraint::{
        attach::{grab, pin_motion},
        implicit::{ImplicitSheet, contact::PredictedContact, system::SheetSystem},
        strand::grid::StrandDirection,
    },
    contact::{self, body::Bodies, feature::ClothInStep, mesh::MeshContacts},
    explicit::Stability,
    force::wind,
    imperfection,
    input::{Method, Skin, StepContext},
    integrate::{self, Motion, SpeedLimit},
    layout::simd::SimdLevel,
    parallel::grid_substep,
    particles::{Particles, contact_load::FeatureLoad, lanes::Lanes},
    scratch::Scratch,
    step::{
        plan::Plan,
        report::{StepReport, SubstepReason},
        substep::Substep,
    },
    topology::{Topology, lattice::Lattice},
};

/// How often the forces of the air are renewed within a step, Hz. They change more slowly than the springs.
const AIR_RATE: f32 = 160.0;

/// A cloth within its step.
pub(super) struct Running<'a> {
    pub particles: &'a mut Particles,
    pub scratch: &'a mut Scratch,
    pub topology: &'a Topology,
    pub ctx: &'a StepContext<'a>,
    pub substep: Substep<'a>,
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
    pub touched: u32,
}

impl<'a> Running<'a> {
    pub fn begin(
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
        scratch.skin.begin(ctx, topology.order(), scratch.simd_level);
        let substep = Substep {
            topology,
            ctx,
            h,
            stability,
            is_pushed,
            is_near,
            touches: ctx.settings.self_collision || is_near,
            limit: SpeedLimit {
                around: velocity_around(scratch.skin.of(ctx), ctx, dt),
                most: ctx.settings.max_velocity,
            },
            helpers,
            last: StrandDirection::between(ctx.pin_motions, topology.order()),
            levels,
            implicit: ImplicitSheet::new(topology, ctx, h),
            slack: ctx.slack(),
        };
        scratch.air.sample(particles, ctx);
        if substep.implicit.is_some() {
            scratch.implicit.contacts.begin(&particles.contact_load.particles, particles.len());
        }
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

    /// Moves the cloth through the part `span` of the step, its substep `i`, as if nothing held it together.
    pub fn predict(&mut self, i: u32, span: Range<f32>) {
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
        self.contacts = 0;
        scratch.implicit.contacts.predicted.clear();
    }

    /// Solves what holds the cloth together in the part `span` of the step, unless it has an implicit step: prepares that.
    pub fn solve(&mut self, span: Range<f32>) {
        let Self { scratch, substep, .. } = self;
        let ctx = substep.ctx;
        match (substep.implicit, ctx.settings.method) {
            (Some(_), _) => {
                grab::solve(&mut scratch.lanes, ctx.grabs, span.clone(), substep.h);
                let Scratch { lanes, broad_phase, faces, bodies, implicit, skin, simd_level, .. } = &mut **scratch;
                let predicted = &mut implicit.contacts.predicted;
                if substep.is_near {
                    let around = (broad_phase, &mut faces[..], bodies);
                    contact::predict(lanes, around, ctx, span.clone(), substep.h, predicted, *simd_level);
                }
                if let Some(skin) = skin.solver(ctx, span, substep.h, *simd_level) {
                    skin.predict(lanes, ctx.gravity * (substep.h * substep.h), predicted);
                }
            }
            (None, Method::Strands) => {
                grab::solve(&mut scratch.lanes, ctx.grabs, span.clone(), substep.h);
                self.is_finished = substep.solve_strands(scratch, span, self.has_moved);
            }
            (None, Method::Xpbd) => {
                substep.solve_springs(scratch);
                grab::solve(&mut scratch.lanes, ctx.grabs, span, substep.h);
                // After the hands: where both can't hold, pins are stronger.
                substep.solve_tethers(scratch);
            }
            (None, Method::Explicit) => grab::solve(&mut scratch.lanes, ctx.grabs, span, substep.h),
        }
    }

    /// Its part of the linear system of an implicit step, if it has one. It is the cloth of this `number`.
    pub fn system(&mut self, number: u32) -> Option<SheetSystem<'_>> {
        let sheet = self.substep.implicit?;
        let Scratch { lanes, gathered, implicit, applied_force, simd_level, .. } = &mut *self.scratch;
        let force = self.substep.applied(applied_force);
        Some(SheetSystem { number, sheet, lanes, force, gathered, buffers: implicit, simd_level: *simd_level })
    }

    /// Lets bodies feel what is attached to them, and holds the cloth to its skin in the part `span` of the step.
    pub fn settle(&mut self, span: Range<f32>) {
        let Self { scratch, substep, .. } = self;
        let Scratch { lanes, body_attachments, .. } = &mut **scratch;
        body_attachments.settle(lanes, substep.ctx, substep.h);
        substep.solve_skin(scratch, span);
    }

    /// Keeps the cloth out of obstacles in the part `span` of the step.
    pub fn project(&mut self, span: Range<f32>) {
        let Self { scratch, substep, .. } = self;
        if substep.is_near {
            let Scratch { lanes, broad_phase, faces, bodies, simd_level, .. } = &mut **scratch;
            let Substep { ctx, h, .. } = *substep;
            let pushed = contact::project(lanes, (broad_phase, faces, bodies), ctx, span, h, *simd_level);
            self.contacts = self.contacts.max(pushed);
        }
    }

    /// Ends the substep, which is the part `span` of the step.
    pub fn finish(&mut self, span: Range<f32>) {
        let Self { scratch, substep, .. } = self;
        let ctx = substep.ctx;
        if substep.is_near || substep.touches {
            substep.hold_to_skin(scratch, span);
        }
        if substep.is_near && substep.implicit.is_some() {
            self.contacts = self.contacts.max(scratch.implicit.contacts.len() as u32);
        }
        // Without a constraint the integrated velocity is the exact one: rounding stays out of it.
        let is_held = !ctx.grabs.is_empty() || scratch.skin.of(ctx).is_some();
        let is_constrained = ctx.settings.method != Method::Explicit || substep.touches || is_held;
        if !self.is_finished && is_constrained {
            let Scratch { lanes, applied_force, simd_level, .. } = &mut **scratch;
            integrate::finish(&mut lanes.whole(), substep.finish(applied_force, self.has_moved), *simd_level);
        }
    }

    /// Hands the state back.
    pub fn end(self) -> StepReport {
        let Self { particles, scratch, substep, substeps, reason, contacts, touched, .. } = self;
        let contacts = contacts + touched;
        let Scratch { lanes, steady_force, implicit, simd_level, .. } = scratch;
        match substep.implicit {
            Some(_) => implicit.contacts.end(&mut particles.contact_load.particles),
            None => particles.contact_load.particles.clear(),
        }
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

    fn is_implicit(&self) -> bool {
        self.substep.implicit.is_some()
    }

    fn predicted(&self) -> &[PredictedContact] {
        &self.scratch.implicit.contacts.predicted
    }

    fn predicted_mut(&mut self) -> &mut Vec<PredictedContact> {
        &mut self.scratch.implicit.contacts.predicted
    }

    fn feature_loads(&self) -> &[FeatureLoad] {
        &self.particles.contact_load.features
    }

    fn feature_loads_mut(&mut self) -> &mut Vec<FeatureLoad> {
        &mut self.particles.contact_load.features
    }
}

/// Mean velocity of what holds the cloth over a step of `dt` seconds, m/s: of its pins, or of its skin where it has none.
fn velocity_around(skin: Option<Skin>, ctx: &StepContext, dt: f32) -> Vec3A {
    let of_skin = skin.filter(|_| ctx.pin_motions.is_empty()).map(|skin| skin.mean_velocity(dt));
    of_skin.unwrap_or_else(|| pin_motion::mean_velocity(ctx.pin_motions, dt))
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
