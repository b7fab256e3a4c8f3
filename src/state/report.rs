//! What the latest step of a cloth did.

use core::time::Duration;

use bevy::prelude::*;

use crate::solver::StepReport;

/// What the latest step of a cloth did, and how long it took. Comes with [`Cloth`](crate::prelude::Cloth).
#[derive(Component, Clone, Debug, Default)]
#[component(clone_behavior = Ignore)]
pub struct ClothReport {
    pub(crate) latest: Option<StepReport>,
    pub(crate) step_time: Duration,
    /// The latest step ended in a state that wasn't finite, and was taken back.
    pub(crate) is_taken_back: bool,
}

impl ClothReport {
    /// What the latest step did: substeps and why so many, contacts. None before the first.
    pub fn latest(&self) -> Option<StepReport> {
        self.latest
    }

    /// Time that the latest step took by the clock. Of cloths that are stepped together, since they may touch each other, each has an
    /// equal part.
    pub fn step_time(&self) -> Duration {
        self.step_time
    }
}
