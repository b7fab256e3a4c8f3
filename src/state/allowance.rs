//! How many substeps a cloth may take, and what they cost.

use bevy::prelude::*;

use super::ClothReport;

/// A cloth gets more again only where that is more by this share: what is cut shouldn't change in every step.
const HYSTERESIS: f32 = 0.2;

/// Weight of the latest step in the mean time of a substep.
const LATEST: f32 = 0.1;

/// What a cloth may spend, and what it has spent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Allowance {
    /// The most substeps of the coming step.
    pub substeps: u32,
    /// Mean time of a substep, s.
    pub seconds_per_substep: f32,
}

impl Default for Allowance {
    fn default() -> Self {
        Self { substeps: u32::MAX, seconds_per_substep: 0.0 }
    }
}

impl Allowance {
    /// Takes the time of the latest step into the mean.
    pub fn note_step(&mut self, report: &ClothReport) {
        let Some(latest) = report.latest.filter(|latest| latest.substeps > 0) else { return };
        let seconds = report.step_time.as_secs_f32() / latest.substeps as f32;
        let is_first = self.seconds_per_substep == 0.0;
        self.seconds_per_substep = if is_first { seconds } else { self.seconds_per_substep.lerp(seconds, LATEST) };
    }

    /// Allows so many substeps, or what was allowed before where they are hardly more.
    pub fn allow(&mut self, substeps: Option<u32>) {
        let is_hardly_more = substeps.is_some_and(|substeps| {
            substeps > self.substeps && (substeps as f32) < (1.0 + HYSTERESIS) * self.substeps as f32
        });
        if !is_hardly_more {
            self.substeps = substeps.unwrap_or(u32::MAX);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_allowed_grows_again_by_a_fifth_at_once_or_to_the_whole() {
        let mut allowance = Allowance { substeps: 10, ..Allowance::default() };
        let mut then = |substeps| {
            allowance.allow(substeps);
            allowance.substeps
        };
        assert_eq!([Some(11), Some(12), Some(11), Some(12), None].map(&mut then), [10, 12, 11, 11, u32::MAX]);
    }
}
