//! How far the drawn moment lies within the latest step.

use bevy::{ecs::system::SystemParam, prelude::*};

use super::Pass;

/// How the plugin was set up.
#[derive(Resource, Clone, Copy, Debug)]
pub(crate) struct ClothRun {
    pub fixed: bool,
    pub parallel: bool,
}

/// Where the drawn moment lies within the latest step.
#[derive(SystemParam)]
pub(crate) struct ClothClock<'w> {
    run: Res<'w, ClothRun>,
    fixed: Option<Res<'w, Time<Fixed>>>,
}

impl ClothClock<'_> {
    /// Share of the latest step that has passed, 0..=1, for a cloth that steps in `pass`. A late step ends at the moment that
    /// is drawn.
    pub fn overstep(&self, pass: Pass) -> f32 {
        match &self.fixed {
            Some(time) if self.run.fixed && pass == Pass::Fixed => time.overstep_fraction().clamp(0.0, 1.0),
            _ => 1.0,
        }
    }

    /// Time since the latest step of the plugin's schedule ended, s: so far a late step is ahead of it.
    pub fn ahead_of_fixed(&self) -> f32 {
        self.fixed.as_ref().filter(|_| self.run.fixed).map_or(0.0, |time| time.overstep().as_secs_f32())
    }

    /// Whether cloths may be worked on side by side.
    pub fn parallel(&self) -> bool {
        self.run.parallel
    }
}
