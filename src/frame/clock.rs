//! When cloth steps, and how far the drawn moment lies within the latest step.

use bevy::{ecs::system::SystemParam, prelude::*};

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
    /// Share of the latest step that has passed, 0..=1.
    pub fn overstep(&self) -> f32 {
        match &self.fixed {
            Some(time) if self.run.fixed => time.overstep_fraction().clamp(0.0, 1.0),
            _ => 1.0,
        }
    }

    /// Whether cloths may be worked on side by side.
    pub fn parallel(&self) -> bool {
        self.run.parallel
    }
}

/// Number of the present step, counted from 1.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct StepNumber(u64);

impl StepNumber {
    /// The number that comes `steps` later.
    pub fn later(self, steps: u64) -> Self {
        Self(self.0 + steps)
    }
}

/// Begins another step.
pub(crate) fn count_steps(mut number: ResMut<StepNumber>) {
    *number = number.later(1);
}

/// A value that is known from one step to the next, and not longer.
///
/// What is disabled or despawned, or has no transform, is seen by no system: when it comes back, what it was before is
/// out of date.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FromLatestStep<T> {
    step: StepNumber,
    value: Option<T>,
}

impl<T: Copy> FromLatestStep<T> {
    /// The value that the step before `step` has left, or that one itself.
    pub fn get(&self, step: StepNumber) -> Option<T> {
        self.value.filter(|_| self.step.later(1) >= step)
    }

    /// Keeps a value of this step.
    pub fn set(&mut self, step: StepNumber, value: T) {
        *self = Self { step, value: Some(value) };
    }

    /// Has no value any more.
    pub fn forget(&mut self) {
        self.value = None;
    }

    /// The value to be changed, out of date or not.
    pub fn as_mut(&mut self) -> Option<&mut T> {
        self.value.as_mut()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_known_in_the_next_step_only() {
        let first = StepNumber::default().later(1);
        let mut value = FromLatestStep::default();
        assert_eq!(value.get(first), None);
        value.set(first, 7);
        assert_eq!([0, 1, 2].map(|steps| value.get(first.later(steps))), [Some(7), Some(7), None]);
        value.forget();
        assert_eq!(value.get(first.later(1)), None);
    }
}
