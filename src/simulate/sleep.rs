//! Which cloths sleep through a step, and which fall asleep after it.
//!
//! It follows from simulated state alone, never from the clock.

use core::time::Duration;

use bevy::prelude::*;

use super::{Surroundings, meeting::SteppedItem};
use crate::{
    solver::{MAX_TIME_STEP, PinMotion, StepContext, StepReach},
    state::ClothStatus,
};

/// Whether cloths that may touch each other all sleep on through the coming step. Else all of them are awake from now on.
pub(super) fn sleep_on(cloths: &mut [SteppedItem], surroundings: &Surroundings) -> bool {
    let is_left_alone =
        |cloth: &SteppedItem| cloth.sleep.reach.is_some_and(|reach| !cloth.is_disturbed(&reach, surroundings));
    let all_sleep = cloths.iter().all(is_left_alone);
    for cloth in cloths.iter_mut().filter(|cloth| *cloth.status == ClothStatus::Asleep) {
        if all_sleep {
            cloth.report.step_time = Duration::ZERO;
        } else {
            cloth.sleep.end(&mut cloth.status);
        }
    }
    all_sleep
}

/// Puts cloths that may touch each other to sleep after a step of `dt` seconds in which all of them were at rest.
pub(super) fn fall_asleep(cloths: &mut [SteppedItem], dt: f32, surroundings: &Surroundings) {
    let mut all_rest = true;
    for cloth in &mut *cloths {
        all_rest &= cloth.sleep.note_step(&cloth.state, dt);
    }
    let reaches: Option<Vec<StepReach>> =
        all_rest.then(|| cloths.iter().map(|cloth| cloth.rests_alone(surroundings)).collect()).flatten();
    for (cloth, reach) in cloths.iter_mut().zip(reaches.into_iter().flatten()) {
        cloth.sleep.begin(reach, (&mut cloth.status, &mut cloth.state, &mut cloth.input));
    }
    for cloth in cloths {
        cloth.sleep.gravity = surroundings.gravity.0;
        cloth.state.is_disturbed = false;
    }
}

impl SteppedItem<'_, '_> {
    /// What a cloth may touch that nothing has disturbed in the latest step; none of one that something has, or that mustn't
    /// sleep.
    fn rests_alone(&self, surroundings: &Surroundings) -> Option<StepReach> {
        let pushes_bodies = self.input.obstacles.iter().any(|obstacle| obstacle.body.is_some());
        if pushes_bodies || self.report.is_taken_back {
            return None;
        }
        let ctx = StepContext {
            pin_motions: &self.input.pin_motions,
            ..StepContext::new(MAX_TIME_STEP, &self.in_force.solver, self.state.material?)
        };
        let reach = StepReach::new(&self.state.particles, &ctx);
        (!self.is_disturbed(&reach, surroundings)).then_some(reach)
    }

    /// Whether anything moves the cloth, or may, that its own rest doesn't tell of.
    fn is_disturbed(&self, reach: &StepReach, surroundings: &Surroundings) -> bool {
        let input = &*self.input;
        let moves = |pin: &PinMotion| pin.start != pin.end;
        let (origin, filter) = (self.state.origin, self.in_force.solver.collision_filter);
        let own = || surroundings.own_bodies.of(self.entity, self.skinning);
        self.state.is_disturbed
            || self.is_sleeping_disabled
            || self.sleep.gravity != surroundings.gravity.0
            || input.jump.is_some()
            || !input.grabs.is_empty()
            || !input.body_attachments.is_empty()
            || input.pin_motions.iter().any(moves)
            || surroundings.obstacle_changes.are_near(reach, origin, filter, own)
            || self.in_force.settings.fluid_density > 0.0 && surroundings.winds.blow_in(reach, origin)
    }
}
