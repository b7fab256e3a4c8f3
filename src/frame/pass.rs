//! The two passes of a frame in which cloth steps, and what is kept for each of them.

use core::ops::{Index, IndexMut};

/// In which part of a frame a cloth steps.
///
/// Both passes read the same colliders, pins and winds, but at other moments and by other time steps: what is remembered of
/// these from step to step is remembered for each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) enum Pass {
    /// In the plugin's schedule, a fixed one mostly.
    #[default]
    Fixed,
    /// Once a frame in `PostUpdate`, when animation has been applied and transforms have been propagated.
    Late,
}

impl Pass {
    /// Both of them.
    pub const BOTH: [Self; 2] = [Self::Fixed, Self::Late];
}

/// A value for each pass.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PerPass<T>([T; 2]);

impl<T> PerPass<T> {
    /// Both values.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut T> {
        self.0.iter_mut()
    }
}

impl<T> Index<Pass> for PerPass<T> {
    type Output = T;

    fn index(&self, pass: Pass) -> &T {
        let [fixed, late] = &self.0;
        match pass {
            Pass::Fixed => fixed,
            Pass::Late => late,
        }
    }
}

impl<T> IndexMut<Pass> for PerPass<T> {
    fn index_mut(&mut self, pass: Pass) -> &mut T {
        let [fixed, late] = &mut self.0;
        match pass {
            Pass::Fixed => fixed,
            Pass::Late => late,
        }
    }
}
