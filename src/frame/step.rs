//! Which step it is, of which pass, and what is known from the one before.

use bevy::prelude::*;

use super::{Pass, PerPass};

/// The steps of both passes.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub(crate) struct Steps {
    pass: Pass,
    latest: PerPass<StepNumber>,
}

impl Steps {
    /// Begins another step of a pass.
    pub fn begin(&mut self, pass: Pass) {
        let number = self.present().number + 1;
        let StepNumber { number: before, past: [before_that, _] } = self.latest[pass];
        self.pass = pass;
        self.latest[pass] = StepNumber { number, past: [before, before_that] };
    }

    /// The pass that is going on, or was the latest.
    pub fn pass(&self) -> Pass {
        self.pass
    }

    /// The step that is going on, or was the latest.
    pub fn present(&self) -> StepNumber {
        self.latest[self.pass]
    }

    /// The latest step of a pass, which may be going on.
    pub fn latest_of(&self, pass: Pass) -> StepNumber {
        self.latest[pass]
    }
}

/// Number of a step among those of both passes, counted from 1, and of the two before it in its own pass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct StepNumber {
    number: u64,
    past: [u64; 2],
}

impl StepNumber {
    /// Whether the step before `step` in its pass had not begun yet when this one did, or is this one: what was true then is true
    /// at the start of `step`, and what came then has come since the latest.
    pub fn is_since_step_before(self, step: Self) -> bool {
        self.number >= step.past[0]
    }

    /// The same for the step before that.
    pub fn is_since_two_steps_before(self, step: Self) -> bool {
        self.number >= step.past[1]
    }

    /// Whether this is `step`, or began later.
    pub fn is_since(self, step: Self) -> bool {
        self.number >= step.number
    }

    /// The number that comes one later, in the same pass.
    #[cfg(test)]
    pub fn next(self) -> Self {
        Self { number: self.number + 1, past: [self.number, self.past[0]] }
    }
}

/// Begins a step in the plugin's schedule.
pub(crate) fn begin_fixed_step(mut steps: ResMut<Steps>) {
    steps.begin(Pass::Fixed);
}

/// Begins the step of the late pass. In each frame in which time goes on, whether there is a late cloth or not: what is
/// remembered of the step before is then known to be out of date.
pub(crate) fn begin_late_step(mut steps: ResMut<Steps>) {
    steps.begin(Pass::Late);
}

/// A value that is known from one step to the next of the same pass, and not longer.
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
        self.value.filter(|_| self.step.is_since_step_before(step))
    }

    /// The value if it is of `step`, or has been set since.
    pub fn get_since(&self, step: StepNumber) -> Option<T> {
        self.value.filter(|_| self.step.is_since(step))
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
        let first = StepNumber::default().next();
        let mut value = FromLatestStep::default();
        assert_eq!(value.get(first), None);
        value.set(first, 7);
        assert_eq!([first, first.next(), first.next().next()].map(|step| value.get(step)), [Some(7), Some(7), None]);
        value.forget();
        assert_eq!(value.get(first.next()), None);
    }

    #[test]
    fn a_value_is_known_in_the_next_step_of_its_pass_however_often_the_other_steps() {
        let mut steps = Steps::default();
        let mut begin = |pass| {
            steps.begin(pass);
            steps.present()
        };
        let mut value = FromLatestStep::default();
        value.set(begin(Pass::Late), 7);
        for _ in 0..3 {
            begin(Pass::Fixed);
        }
        assert_eq!(value.get(begin(Pass::Late)), Some(7));
        assert_eq!(value.get(begin(Pass::Late)), None);
    }
}
