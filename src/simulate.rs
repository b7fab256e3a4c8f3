//! One step of every cloth: what was gathered goes in, the new state comes out.

use std::sync::{Mutex, PoisonError};

use bevy::{
    ecs::system::{NonSendMarker, SystemParam},
    math::Vec3A,
    platform::time::Instant,
    prelude::*,
    tasks::TaskPool,
};

pub(crate) mod budget;
mod meeting;
mod own_body;
mod sleep;

use crate::{
    cloth::{ClothSolver, InForce},
    frame::{self, ClothRun, Steps},
    solver::{self, Member, Particles, Scratch, StepContext, StepReach, StepReport, Topology},
    state::{
        BodyPush, ClothFellAsleep, ClothReport, ClothReset, ClothState, ClothStatus, ClothWokeUp, ResetCause, Sleep,
        StepInput, Warned,
    },
    surroundings::{
        ClothGravity,
        collider::{Obstacles, changes::ObstacleChanges},
        wind::Winds,
    },
};
use budget::StepDuration;
use meeting::Stepped;
use own_body::OwnBodies;

/// Working memory for as many cloths as are stepped at a time, which is far less than for all.
#[derive(Default)]
pub(crate) struct ScratchPool(Mutex<Vec<Scratch>>);

impl ScratchPool {
    /// Lends working memory. The latest that was handed back comes first: it may still be in the processor's cache.
    fn take(&self) -> Scratch {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).pop().unwrap_or_default()
    }

    fn give_back(&self, scratch: Scratch) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(scratch);
    }
}

/// What acts on all cloths.
#[derive(SystemParam)]
pub(crate) struct Surroundings<'w, 's> {
    gravity: Res<'w, ClothGravity>,
    obstacles: Res<'w, Obstacles>,
    obstacle_changes: Res<'w, ObstacleChanges>,
    winds: Res<'w, Winds>,
    own_bodies: OwnBodies<'w, 's>,
}

/// Steps all cloths of a pass, several at a time: each reads what is shared and writes only itself, so the order doesn't matter. Those
/// that may touch each other are stepped together.
pub(crate) fn step_cloths(
    mut cloths: Query<Stepped>,
    run: Res<ClothRun>,
    (time, steps): (Res<Time>, Res<Steps>),
    surroundings: Surroundings,
    mut duration: ResMut<StepDuration>,
    scratch_pool: Local<ScratchPool>,
    _main_thread: NonSendMarker,
) {
    let gravity = surroundings.gravity.0;
    let gravity = if gravity.is_finite() {
        gravity
    } else {
        warn_once!("ClothGravity isn't finite: cloth has no gravity until it is; set it to a finite acceleration");
        Vec3::ZERO
    };
    let is_stepped = |cloth: &meeting::SteppedItem| cloth.status.is_running() && cloth.input.pass == steps.pass();
    let mut running: Vec<_> = cloths.iter_mut().filter(is_stepped).collect();
    running.iter_mut().for_each(|cloth| cloth.sleep.begin_step(steps.present()));
    let (dt, pool) = (time.delta_secs(), frame::pool(run.parallel));
    let mut groups = meeting::group(running, dt);
    groups.retain_mut(|group| dt <= 0.0 || !sleep::sleep_on(group, &surroundings));
    let begun = Instant::now();
    frame::for_each(groups, run.parallel, |mut group| {
        step_group(&mut group, dt, gravity, &surroundings, pool, &scratch_pool);
    });
    duration.0[steps.pass()] = begun.elapsed().as_secs_f32();
}

/// Steps cloths that may touch each other by `dt` seconds.
fn step_group(
    cloths: &mut [meeting::SteppedItem],
    dt: f32,
    gravity: Vec3,
    surroundings: &Surroundings,
    pool: Option<&TaskPool>,
    scratch_pool: &ScratchPool,
) {
    for cloth in &mut *cloths {
        cloth.report.is_taken_back = false;
        cloth.input.pushes.clear();
    }
    // Paused: nothing is new to draw, and what pushes the cloth is kept until time goes on.
    if dt <= 0.0 {
        return;
    }
    let mut scratches: Vec<Scratch> = cloths.iter().map(|_| scratch_pool.take()).collect();
    let begun = Instant::now();
    let mut parts: Vec<Parts> =
        cloths.iter_mut().filter_map(|cloth| Parts::of(cloth, dt, gravity, surroundings, pool)).collect();
    let first = parts.first().map_or(Vec3::ZERO, |parts| parts.origin);
    let mut members: Vec<Member> = parts
        .iter_mut()
        .zip(&mut scratches)
        .map(|(Parts { particles, topology, ctx, origin }, scratch)| {
            let offset = Vec3A::from(*origin - first);
            Member { particles, topology, ctx, scratch, offset, report: None }
        })
        .collect();
    solver::step_together(&mut members);
    let reports: Vec<Option<StepReport>> = members.into_iter().map(|member| member.report).collect();
    drop(parts);
    let taken = begun.elapsed() / cloths.len().max(1) as u32;
    let stepped = cloths.iter_mut().filter(|cloth| cloth.state.material.is_some());
    for ((cloth, report), scratch) in stepped.zip(reports).zip(&scratches) {
        cloth.report.step_time = taken;
        take_pushes(&mut cloth.input, scratch);
        end_step(&mut cloth.state, &mut cloth.report, &mut cloth.input, report);
    }
    sleep::fall_asleep(cloths, dt, surroundings);
    scratches.into_iter().rev().for_each(|scratch| scratch_pool.give_back(scratch));
}

/// Keeps what bodies have been given.
fn take_pushes(input: &mut StepInput, scratch: &Scratch) {
    let StepInput { obstacles, owners, attachment_owners, pushes, .. } = input;
    let by_contact = scratch.obstacle_impulses().iter().copied().zip(scratch.obstacle_displacements().iter().copied());
    let bodies = obstacles.iter().zip(&*owners).zip(by_contact).filter(|((obstacle, _), _)| obstacle.body.is_some());
    let bodies = bodies.map(|((_, owner), pushed)| (*owner, pushed));
    let by_pins = attachment_owners.iter().copied().zip(scratch.attachment_impulses().iter().copied());
    let push = |(to, (impulse, displacement))| BodyPush { to, impulse, displacement };
    pushes.extend(bodies.chain(by_pins).map(push));
}

/// The parts of a cloth that go into a step.
struct Parts<'a> {
    particles: &'a mut Particles,
    topology: &'a Topology,
    ctx: StepContext<'a>,
    origin: Vec3,
}

impl<'a> Parts<'a> {
    /// None where the cloth isn't made of anything yet.
    fn of(
        cloth: &'a mut meeting::SteppedItem,
        dt: f32,
        gravity: Vec3,
        surroundings: &Surroundings,
        pool: Option<&'a TaskPool>,
    ) -> Option<Self> {
        let InForce { settings, solver } = cloth.in_force;
        let state = &mut *cloth.state;
        let material = state.material?;
        state.step_start.clone_from(&state.particles.position);
        let ClothState { particles, topology, origin, .. } = state;
        let StepInput {
            pin_motions,
            body_attachments,
            attached_pins,
            grabs,
            obstacles: near,
            owners,
            winds: felt,
            jump,
            allowance,
            ..
        } = &mut *cloth.input;
        surroundings.winds.around(*origin, felt);
        let ctx = StepContext {
            gravity: (gravity * settings.gravity_scale).into(),
            fluid_density: settings.fluid_density,
            pin_motions,
            body_attachments,
            attached_pins,
            grabs,
            tethers: settings.tether_slack.map(|_| cloth.attachments.as_tethers()),
            skin: cloth.skinning.0.as_ref().and_then(|bound| bound.as_constraint()),
            winds: felt,
            substep_limit: allowance.substeps.min(settings.substep_limit(particles.len())),
            pool,
            ..StepContext::new(dt, solver, material)
        };
        let reach = || StepReach::new(particles, &ctx);
        let own = surroundings.own_bodies.of(cloth.entity, cloth.skinning);
        surroundings.obstacles.around(reach, *origin, solver.collision_filter, *jump, own, (near, owners));
        let ctx = StepContext { obstacles: near, ..ctx };
        Some(Self { particles, topology, ctx, origin: *origin })
    }
}

/// Takes note of what a step has done to a cloth.
fn end_step(state: &mut ClothState, report: &mut ClothReport, input: &mut StepInput, latest: Option<StepReport>) {
    report.latest = latest;
    state.particles.force.fill(Vec3A::ZERO);
    let was_still = core::mem::replace(&mut state.is_still, state.particles.position == state.step_start);
    // The first step that moves nothing counts: what is drawn still comes to rest with it.
    if !(was_still && state.is_still) {
        state.steps += 1;
    }
    report.is_taken_back = !state.particles.is_finite();
    if report.is_taken_back {
        state.particles.position.clone_from(&state.step_start);
        state.particles.velocity.fill(Vec3A::ZERO);
        input.pushes.clear();
    }
}

/// Tells of what went wrong in a step, and of cloth that fell asleep or woke up.
pub(crate) fn report_steps(
    mut commands: Commands,
    mut cloths: Query<(Entity, &ClothStatus, &ClothReport, &InForce, &StepInput, &mut Warned, &mut Sleep)>,
    steps: Res<Steps>,
) {
    for (entity, status, report, in_force, input, mut warned, mut sleep) in &mut cloths {
        if input.pass != steps.pass() {
            continue;
        }
        let is_asleep = *status == ClothStatus::Asleep;
        if is_asleep != sleep.is_told {
            sleep.is_told = is_asleep;
            if is_asleep {
                commands.trigger(ClothFellAsleep { entity });
            } else {
                commands.trigger(ClothWokeUp { entity });
            }
        }
        if *status != ClothStatus::Ready {
            continue;
        }
        if report.is_taken_back {
            commands.trigger(ClothReset { entity, cause: ResetCause::NotFinite });
            if !warned.not_finite {
                warned.not_finite = true;
                warn!(
                    "cloth {entity} left the finite numbers and was put back to its last finite pose: look for huge \
                     forces, transforms or stiffness with too few substeps"
                );
            }
        }
        if let Some(report) = report.latest
            && report.stiffness_scale < 1.0
            && in_force.settings.solver == ClothSolver::Explicit
            && !warned.softened
        {
            warned.softened = true;
            warn!(
                "cloth {entity} is too stiff for {} substeps of the explicit solver: it runs with {:.1} % of its \
                 stiffness and damping; raise Cloth::max_substeps, lower the stiffness or use ClothSolver::Strands",
                report.substeps,
                report.stiffness_scale * 100.0
            );
        }
    }
}
