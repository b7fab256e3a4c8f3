//! What the panel keeps from frame to frame.

use std::collections::VecDeque;

use bevy::{platform::collections::HashMap, prelude::*};

use super::{ClothPanel, advice::Advice, aim::Aim, watch::Watch};
use crate::{
    frame::{Pass, Steps},
    simulate::budget::ClothBudget,
    solver::SubstepReason,
    state::{ClothReport, ClothStatus, StepInput},
};

/// Steps whose time is remembered.
const STEPS: usize = 300;

#[derive(Debug, Default)]
pub(super) struct Memory {
    /// Wind that is edited.
    pub wind: Option<Entity>,
    /// What a wind was given here: the wind, its velocity, and the direction and speed that it came from.
    pub aim: Option<(Entity, Vec3, Aim)>,
    /// Gravity before anything was edited.
    pub gravity: Option<Vec3>,
    /// The budget before anything was edited.
    pub budget: Option<ClothBudget>,
    /// Winds that weren't there before.
    pub added_winds: Vec<Entity>,
    /// The cloths that are chosen.
    pub chosen: Vec<Entity>,
    /// Time of the latest steps of the chosen cloths, ms.
    pub step_times: VecDeque<f32>,
    /// How each chosen cloth has fared.
    pub watches: HashMap<Entity, Watch>,
    pub readings: Readings,
    /// The advice that is shown: that of the readings, but for while a control is held.
    pub advice: Vec<(Entity, Advice)>,
    /// The frame of egui that the readings were made in.
    pub frame: Option<u64>,
    /// One step is to be done while the clock is paused.
    pub is_step_asked: bool,
    /// For how many frames the panel counts as shown.
    pub shown_for: u8,
}

/// Numbers of the chosen cloths.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Readings {
    pub particles: usize,
    pub springs: usize,
    /// What the mesh was found to be.
    pub structure: String,
    /// Of the one that takes the most.
    pub substeps: u32,
    /// How many that one has asked for.
    pub needed_substeps: u32,
    /// Why they are so many.
    pub substep_reason: SubstepReason,
    /// How many of the cloths are asleep: they take no substeps.
    pub asleep: usize,
    pub contacts: u32,
    pub largest_strain: f32,
    /// Over all cloths, by their particles.
    pub mean_strain: f32,
    /// J.
    pub kinetic: f32,
    pub elastic: f32,
    pub total: f32,
    /// What to change, and for which cloth.
    pub advice: Vec<(Entity, Advice)>,
}

/// Begins a frame: lets the paused clock go on for one step where that was asked for.
pub(super) fn begin_frame(
    mut panel: ResMut<ClothPanel>,
    fixed: Option<Res<Time<Fixed>>>,
    virt: Option<ResMut<Time<Virtual>>>,
    time: Option<ResMut<Time>>,
) {
    let memory = &mut panel.bypass_change_detection().memory;
    memory.shown_for = memory.shown_for.saturating_sub(1);
    if !core::mem::take(&mut memory.is_step_asked) {
        return;
    }
    // The clock is advanced, and not only the fixed one: cloth may step in any schedule.
    if let (Some(fixed), Some(mut virt), Some(mut time)) = (fixed, virt, time)
        && virt.is_paused()
    {
        virt.advance_by(fixed.timestep());
        *time = virt.as_generic();
    }
}

/// Notes the time of a step, while somebody looks: each step in the plugin's schedule, or each late one where a chosen cloth steps late.
pub(super) fn note_step(
    mut panel: ResMut<ClothPanel>,
    cloths: Query<(&ClothReport, &ClothStatus, &StepInput)>,
    steps: Option<Res<Steps>>,
    time: Option<Res<Time>>,
) {
    let memory = &mut panel.bypass_change_detection().memory;
    // No cloth steps without time.
    if memory.shown_for == 0 || time.is_none_or(|time| time.delta_secs() <= 0.0) {
        return;
    }
    let ready = || memory.chosen.iter().filter_map(|&cloth| cloths.get(cloth).ok());
    let is_any_late = ready().any(|(.., input)| input.pass == Pass::Late);
    let pass = if is_any_late { Pass::Late } else { Pass::Fixed };
    if steps.is_none_or(|steps| steps.pass() != pass) {
        return;
    }
    let running = ready().filter(|(_, status, _)| status.is_running());
    let total: f32 = running.map(|(report, ..)| report.step_time().as_secs_f32() * 1e3).sum();
    if memory.step_times.len() == STEPS {
        memory.step_times.pop_front();
    }
    memory.step_times.push_back(total);
}

#[cfg(test)]
mod tests {
    use core::time::Duration;

    use bevy::{mesh::MeshPlugin, time::TimeUpdateStrategy};

    use super::*;
    use crate::{panel::ClothPanelPlugin, prelude::*};

    /// How many steps are noted of cloths of these timings in 30 frames of 1/60 s, with 20 fixed steps a second.
    fn noted(timings: &[ClothTiming]) -> usize {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), MeshPlugin))
            .add_plugins((ClothPlugin::default(), ClothPanelPlugin { window: false, ..default() }))
            .insert_resource(Time::<Fixed>::from_hz(20.0))
            .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(1.0 / 60.0)));
        app.finish();
        app.cleanup();
        let mesh = app.world_mut().resource_mut::<Assets<Mesh>>().add(Mesh::from(ClothGrid::new(1.0, 1.0, 4, 4)));
        let cloth = |timing| (Mesh3d(mesh.clone()), Cloth { timing, ..default() });
        let chosen = timings.iter().map(|&timing| app.world_mut().spawn(cloth(timing)).id()).collect();
        app.update();
        app.world_mut().resource_mut::<ClothPanel>().memory.chosen = chosen;
        for _ in 0..30 {
            app.world_mut().resource_mut::<ClothPanel>().memory.shown_for = 2;
            app.update();
        }
        app.world().resource::<ClothPanel>().memory.step_times.len()
    }

    #[test]
    fn each_step_is_noted_once() {
        assert_eq!(noted(&[ClothTiming::Fixed]), 10);
        assert_eq!(noted(&[ClothTiming::Late]), 30);
        assert_eq!(noted(&[ClothTiming::Fixed, ClothTiming::Late]), 30, "with the latest of the other");
    }
}
