//! Divides the time that cloth may take among the cloths: what is far from all cameras is cut first.

use core::cmp::Ordering;

use bevy::prelude::*;

use crate::{
    frame::{PerPass, Steps},
    parameter::Parameter,
    state::{Allowance, ClothReport, ClothState, ClothStatus, StepInput},
};

/// The time that all cloth together may take in a step, by the clock, in ms. Infinite by default: nothing is cut.
///
/// Where cloths would take longer, they get fewer substeps, down to a quarter of what they ask for: the one farthest from all
/// active cameras first, and the nearest last. What is cut stretches more, and lets small obstacles through sooner.
/// [`ClothReport::latest`] and the panel tell of it. A quarter of all may still be more than the budget: then cloth takes that.
///
/// It counts for each step of the plugin's schedule, and apart from that for the cloths that step
/// [late](crate::prelude::ClothTiming::Late): a frame may take it several times.
///
/// It follows the clock, so two runs aren't the same: leave it off where they have to be, and set
/// [`Cloth::max_work`](crate::prelude::Cloth::max_work) instead. [`ClothSolver::Explicit`](crate::prelude::ClothSolver::Explicit) is
/// never cut, since that would make it softer.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_drape::prelude::*;
/// App::new().add_plugins(ClothPlugin::default()).insert_resource(ClothBudget { milliseconds: 2.0 });
/// ```
#[derive(Resource, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Resource, Default, Debug, Clone, PartialEq)]
pub struct ClothBudget {
    /// Time in ms for each step, greater than 0, infinite by default, which cuts nothing, as whatever isn't a positive number does.
    /// 1 to 4 in a game at 60 Hz.
    #[reflect(@Parameter::positive("ms", (0.1, 16.0)).logarithmic(0.1).entered((0.001, 1e6)).titled("Time for a step"))]
    pub milliseconds: f32,
}

impl Default for ClothBudget {
    fn default() -> Self {
        Self { milliseconds: f32::INFINITY }
    }
}

impl ClothBudget {
    /// Time for a step, s; none where nothing is to be cut.
    pub(crate) fn seconds(self) -> Option<f32> {
        (self.milliseconds > 0.0 && self.milliseconds.is_finite()).then_some(self.milliseconds * 1e-3)
    }
}

/// The fewest substeps that are left to a cloth, as a share of what it asks for: below that, cloth looks like rubber.
const LEAST: f32 = 0.25;

/// The time that the latest step of all cloths of each pass has taken by the clock, s.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub(crate) struct StepDuration(pub PerPass<f32>);

/// What a cloth asks for.
#[derive(Clone, Copy, Debug)]
struct Demand {
    /// Distance to the nearest camera, m; infinite where there is none.
    distance: f32,
    substeps: u32,
    seconds_per_substep: f32,
}

impl Demand {
    fn least(&self) -> u32 {
        (LEAST * self.substeps as f32).ceil().max(1.0) as u32
    }
}

/// Sets how many substeps each cloth of the present pass may take in the coming step.
pub(crate) fn divide_budget(
    budget: Res<ClothBudget>,
    (latest, steps): (Res<StepDuration>, Res<Steps>),
    cameras: Query<(&Camera, &GlobalTransform)>,
    mut cloths: Query<(Entity, &ClothStatus, &ClothState, &ClothReport, &mut StepInput)>,
    mut was_on: Local<bool>,
) {
    let Some(seconds) = budget.seconds() else {
        if core::mem::take(&mut *was_on) {
            cloths.iter_mut().for_each(|(.., mut input)| input.allowance = Allowance::default());
        }
        return;
    };
    *was_on = true;
    let eyes: Vec<Vec3> =
        cameras.iter().filter(|(camera, _)| camera.is_active).map(|(_, at)| at.translation()).collect();
    let mut all: Vec<_> = cloths
        .iter_mut()
        .filter(|(_, status, .., input)| **status == ClothStatus::Ready && input.pass == steps.pass())
        .collect();
    all.sort_unstable_by_key(|(entity, ..)| *entity);
    let mut worked = 0.0;
    let demands: Vec<Demand> = all
        .iter_mut()
        .map(|(_, _, state, report, input)| {
            worked += report.step_time.as_secs_f32();
            input.allowance.note_step(report);
            let distance = eyes.iter().map(|eye| eye.distance(state.origin)).fold(f32::INFINITY, f32::min);
            let substeps = report.latest.map_or(0, |latest| latest.needed_substeps);
            Demand { distance, substeps, seconds_per_substep: input.allowance.seconds_per_substep }
        })
        .collect();
    // Cloths are stepped side by side: together they may work for longer than the clock runs.
    let latest = latest.0[steps.pass()];
    let workers = if latest > 0.0 { (worked / latest).max(1.0) } else { 1.0 };
    for ((.., input), substeps) in all.iter_mut().zip(divide(&demands, seconds * workers)) {
        input.allowance.allow(substeps);
    }
}

/// Divides `seconds` of work among cloths: how many substeps each may take, none for as many as it asks for.
///
/// Each gets its least, and of what is left the nearest takes first.
fn divide(demands: &[Demand], seconds: f32) -> Vec<Option<u32>> {
    let cost = |demand: &Demand, substeps: u32| substeps as f32 * demand.seconds_per_substep;
    let mut left = seconds - demands.iter().map(|demand| cost(demand, demand.least())).sum::<f32>();
    let mut nearest: Vec<usize> = (0..demands.len()).collect();
    nearest
        .sort_by(|&one, &other| demands[one].distance.partial_cmp(&demands[other].distance).unwrap_or(Ordering::Equal));
    let mut allowed = vec![None; demands.len()];
    for cloth in nearest {
        let demand = &demands[cloth];
        let more = demand.substeps.saturating_sub(demand.least());
        if demand.substeps == 0 || cost(demand, more) <= left {
            left -= cost(demand, more);
        } else {
            let affordable = (left / demand.seconds_per_substep).max(0.0) as u32;
            left -= cost(demand, affordable);
            allowed[cloth] = Some(demand.least() + affordable);
        }
    }
    allowed
}

#[cfg(test)]
mod tests {
    use super::*;

    fn demand(distance: f32) -> Demand {
        Demand { distance, substeps: 8, seconds_per_substep: 1.0 }
    }

    #[test]
    fn the_farthest_is_cut_first_and_the_nearest_last() {
        let demands = [demand(3.0), demand(1.0), demand(2.0)];
        assert_eq!(divide(&demands, 24.0), [None, None, None]);
        assert_eq!(divide(&demands, 21.0), [Some(5), None, None]);
        assert_eq!(divide(&demands, 15.0), [Some(2), None, Some(5)]);
        assert_eq!(divide(&demands, 9.0), [Some(2), Some(5), Some(2)]);
        assert_eq!(divide(&demands, 0.1), [Some(2); 3], "a quarter is left in any case");
    }

    #[test]
    fn no_cloths_and_cloths_that_ask_for_nothing_divide_nothing() {
        assert_eq!(divide(&[], 1.0), []);
        let nothing = Demand { substeps: 0, seconds_per_substep: 0.0, ..demand(f32::INFINITY) };
        assert_eq!(divide(&[nothing, Demand { distance: f32::NAN, ..nothing }], 1.0), [None, None]);
    }
}
