//! One step of every cloth: what was gathered goes in, the new state comes out.

use std::sync::{Mutex, PoisonError};

use bevy::{
    ecs::system::{NonSendMarker, SystemParam},
    math::Vec3A,
    platform::time::Instant,
    prelude::*,
    tasks::TaskPool,
};

use crate::{
    cloth::{Cloth, ClothGravity, ClothReset, ClothSolver, ClothStatus, ResetCause},
    collider::Obstacles,
    parallel,
    schedule::ClothRun,
    solver::{self, Scratch, StepContext},
    state::{ClothState, Work},
    wind::Winds,
};

/// Working memory for as many cloths as are stepped at a time, which is far less than for all.
#[derive(Default)]
pub(crate) struct Workshop(Mutex<Vec<Scratch>>);

impl Workshop {
    /// Lends working memory. The latest that was handed back comes first: it may still be in the processor's cache.
    fn with_scratch(&self, work: impl FnOnce(&mut Scratch)) {
        let idle = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let mut scratch = idle().pop().unwrap_or_default();
        work(&mut scratch);
        idle().push(scratch);
    }
}

/// What acts on all cloths.
#[derive(SystemParam)]
pub(crate) struct Surroundings<'w> {
    gravity: Res<'w, ClothGravity>,
    obstacles: Res<'w, Obstacles>,
    winds: Res<'w, Winds>,
}

/// Steps all cloths, several at a time: each reads what is shared and writes only itself, so the order doesn't matter.
pub(crate) fn step_cloths(
    mut cloths: Query<(&ClothStatus, &mut ClothState)>,
    run: Res<ClothRun>,
    time: Res<Time>,
    Surroundings { gravity, obstacles, winds }: Surroundings,
    workshop: Local<Workshop>,
    _main_thread: NonSendMarker,
) {
    let gravity = if gravity.0.is_finite() {
        gravity.0
    } else {
        warn_once!("ClothGravity isn't finite: cloth has no gravity until it is; set it to a finite acceleration");
        Vec3::ZERO
    };
    let pool = parallel::pool(run.parallel);
    parallel::for_each(&mut cloths, run.parallel, |(status, mut state)| {
        if *status == ClothStatus::Ready {
            workshop.with_scratch(|scratch| step_cloth(&mut state, &time, gravity, &obstacles, &winds, pool, scratch));
        }
    });
}

fn step_cloth(
    state: &mut ClothState,
    time: &Time,
    gravity: Vec3,
    obstacles: &Obstacles,
    winds: &Winds,
    pool: Option<&TaskPool>,
    scratch: &mut Scratch,
) {
    let Some(material) = state.material else { return };
    state.is_taken_back = false;
    state.work.pushes.clear();
    // Paused: nothing is new to draw, and what pushes the cloth is kept until time goes on.
    if time.delta_secs() <= 0.0 {
        return;
    }
    let Cloth { solver, max_substeps, gravity_scale, max_velocity, .. } = state.settings;
    let Work { anchors, grabs, obstacles: near, owners, pushes, winds: felt } = &mut state.work;
    obstacles.around(state.origin, state.settings.collision_mask, near, owners);
    winds.around(state.origin, felt);
    let ctx = StepContext {
        dt: time.delta_secs(),
        method: solver.into(),
        effort: &state.effort,
        max_substeps,
        material,
        gravity: (gravity * gravity_scale).into(),
        anchors,
        grabs,
        max_velocity,
        tethers: state.settings.tether_slack.map(|_| &state.tethers),
        tether_slack: state.settings.tether_slack.unwrap_or_default(),
        margin: state.settings.collision_margin,
        max_depenetration_velocity: state.settings.max_depenetration_velocity,
        self_collision: state.settings.self_collision,
        self_distance: state.settings.self_distance,
        self_friction: state.settings.self_friction,
        obstacles: near,
        fluid_density: state.settings.fluid_density,
        winds: felt,
        pool,
    };
    state.step_start.clone_from(&state.particles.position);
    let begun = Instant::now();
    state.report = Some(solver::step(&mut state.particles, &state.topology, &ctx, scratch));
    state.step_time = begun.elapsed();
    let given = owners.iter().zip(&*near).zip(scratch.pushes()).filter(|((_, obstacle), _)| obstacle.body.is_some());
    pushes.extend(given.map(|((&owner, _), &push)| (owner, push)));
    state.particles.force.fill(Vec3A::ZERO);
    let was_still = core::mem::replace(&mut state.is_still, state.particles.position == state.step_start);
    // The first step that moves nothing counts: what is drawn still comes to rest with it.
    if !(was_still && state.is_still) {
        state.steps += 1;
    }
    state.is_taken_back = !state.particles.is_finite();
    if state.is_taken_back {
        state.particles.position.clone_from(&state.step_start);
        state.particles.velocity.fill(Vec3A::ZERO);
        state.work.pushes.clear();
    }
}

/// Tells of what went wrong in a step.
pub(crate) fn report_steps(mut commands: Commands, mut cloths: Query<(Entity, &ClothStatus, &mut ClothState)>) {
    for (entity, status, mut state) in &mut cloths {
        if *status != ClothStatus::Ready {
            continue;
        }
        if state.is_taken_back {
            commands.trigger(ClothReset { entity, cause: ResetCause::NotFinite });
            if !state.said.not_finite {
                state.said.not_finite = true;
                warn!(
                    "cloth {entity} left the finite numbers and was put back to its last finite pose: look for huge \
                     forces, transforms or stiffness with too few substeps"
                );
            }
        }
        if let Some(report) = state.report
            && report.stiffness_scale < 1.0
            && state.settings.solver == ClothSolver::Explicit
            && !state.said.softened
        {
            state.said.softened = true;
            warn!(
                "cloth {entity} is too stiff for {} substeps of the explicit solver: it runs with {:.1} % of its \
                 stiffness and damping; raise Cloth::max_substeps, lower the stiffness or use ClothSolver::Strands",
                report.substeps,
                report.stiffness_scale * 100.0
            );
        }
    }
}
