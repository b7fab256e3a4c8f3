//! How long steps and frames are.

use core::time::Duration;

use bevy::{prelude::*, time::TimeUpdateStrategy};

use super::{dice::Dice, stage::Stage};

/// Shortest and longest step, s.
const SHORTEST: f32 = 1e-4;
const LONGEST: f32 = 3.0;

/// The rhythm of a scene.
#[derive(Clone, Copy, Debug)]
pub struct Clock {
    /// Usual duration of a step, s.
    step: f32,
    /// Share of the frames with another one.
    unrest: f32,
    /// Steps in a frame.
    steps: f32,
}

impl Clock {
    pub fn roll(dice: &mut Dice) -> Self {
        let step = match dice.count(0..=9) {
            0 => dice.spread(SHORTEST, LONGEST),
            1 => 1.0 / 30.0,
            2 => 1.0 / 144.0,
            _ => 1.0 / 60.0,
        };
        let unrest = dice.one_of([0.0, 0.0, 0.05, 1.0]);
        let steps = if dice.chance(0.7) { 1.0 } else { dice.within(0.3, 2.5) };
        Self { step, unrest, steps }
    }

    /// Sets the clock of the app for a frame, and tells how long that is, s.
    pub fn tick(&self, stage: &mut Stage) -> f32 {
        let is_odd = stage.dice.chance(self.unrest);
        let step = if is_odd { stage.dice.spread(SHORTEST, LONGEST) } else { self.step };
        let is_paused = stage.dice.chance(0.02);
        let frame = if is_paused { 0.0 } else { step * self.steps };
        if is_odd || is_paused {
            stage.diary.note(format_args!("steps of {step} s in a frame of {frame} s"));
        }
        let world = stage.app.world_mut();
        world.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f32(frame)));
        world.resource_mut::<Time<Virtual>>().set_max_delta(Duration::from_secs(60));
        let mut fixed = world.resource_mut::<Time<Fixed>>();
        let step = Duration::from_secs_f32(step);
        if fixed.timestep() != step {
            // What is left of a long step would be thousands of short ones.
            let left = fixed.overstep();
            fixed.discard_overstep(left);
            fixed.set_timestep(step);
        }
        frame
    }
}
