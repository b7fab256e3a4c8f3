//! Cloth that has come to rest: for how long, and what it is left alone by until something near it changes.

use bevy::{math::Vec3A, prelude::*};

use super::{ClothState, ClothStatus, StepInput};
use crate::{
    frame::{FromLatestStep, StepNumber},
    solver::StepReach,
};

/// Way of a particle, m, up to which it counts as at rest.
const MOVED: f32 = 1e-4;

/// Time, s, after which a cloth sleeps whose particles are all at rest.
const SLEEPS_AFTER: f32 = 0.5;

/// Keeps a cloth from falling asleep. Goes next to its [`Cloth`](crate::prelude::Cloth), and wakes one that is asleep.
///
/// Without it, a cloth falls [asleep](ClothStatus::Asleep) once nothing about it has moved for half a second.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Default, Debug, Clone, PartialEq)]
pub struct ClothSleepingDisabled;

/// A cloth has come to rest and is no longer simulated. Sent in [`ClothSystems::Finalize`](crate::prelude::ClothSystems::Finalize).
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClothFellAsleep {
    /// The cloth.
    pub entity: Entity,
}

/// Something has changed near a cloth that was asleep, and it is simulated again: the step has been done. Sent in
/// [`ClothSystems::Finalize`](crate::prelude::ClothSystems::Finalize).
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClothWokeUp {
    /// The cloth.
    pub entity: Entity,
}

/// How long a cloth has been at rest, and what it was surrounded by.
#[derive(Component, Clone, Debug, Default)]
#[component(clone_behavior = Ignore)]
pub(crate) struct Sleep {
    /// Where its particles were when one had last moved, m, relative to the cloth's origin.
    places: Vec<Vec3A>,
    /// The particle that had.
    mover: usize,
    /// Time since then, s.
    at_rest_for: f32,
    /// Gravity in the latest step, m/s².
    pub gravity: Vec3,
    /// What it may touch, while it is asleep.
    pub reach: Option<StepReach>,
    /// Whether the game has been told that it is asleep.
    pub is_told: bool,
    /// The latest step that it was there in.
    seen: FromLatestStep<()>,
}

impl Sleep {
    /// Begins a step. What was disabled or gone in the step before doesn't know what it has missed, and can't sleep on.
    pub fn begin_step(&mut self, step: StepNumber) {
        if self.seen.get(step).is_none() {
            self.reach = None;
        }
        self.seen.set(step, ());
    }

    /// Takes note of a step of `dt` seconds. True where the cloth has been at rest for long enough to sleep.
    pub fn note_step(&mut self, state: &ClothState, dt: f32) -> bool {
        let position = &state.particles.position;
        let has_moved = |(now, then): (&Vec3A, &Vec3A)| now.distance_squared(*then) > MOVED * MOVED;
        let is_known = self.places.len() == position.len();
        // Mostly it is the same one again.
        let is_same = is_known && position.get(self.mover).zip(self.places.get(self.mover)).is_some_and(has_moved);
        let mover = if is_same { Some(self.mover) } else { position.iter().zip(&self.places).position(has_moved) };
        if mover.is_none() && is_known {
            self.at_rest_for += dt;
        } else {
            self.mover = mover.unwrap_or(0);
            self.places.clone_from(position);
            self.at_rest_for = 0.0;
        }
        self.at_rest_for >= SLEEPS_AFTER
    }

    /// Puts a cloth to sleep that may touch what `reach` includes.
    pub fn begin(
        &mut self,
        reach: StepReach,
        (status, state, input): (&mut ClothStatus, &mut ClothState, &mut StepInput),
    ) {
        *status = ClothStatus::Asleep;
        self.reach = Some(reach);
        state.particles.velocity.fill(Vec3A::ZERO);
        state.step_start.clone_from(&state.particles.position);
        // It is drawn once more, at rest.
        state.steps += 1;
        state.is_still = true;
        // They may share memory with what moves on.
        input.obstacles.clear();
        input.owners.clear();
    }

    /// Knows nothing of a cloth that has been built anew.
    pub fn start_over(&mut self) {
        *self = Self { is_told: self.is_told, ..default() };
    }

    /// Wakes a cloth up.
    pub fn end(&mut self, status: &mut ClothStatus) {
        *status = ClothStatus::Ready;
        self.reach = None;
        self.at_rest_for = 0.0;
    }
}
