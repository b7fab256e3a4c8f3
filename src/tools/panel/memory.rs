//! What the panel keeps from frame to frame.

use std::collections::VecDeque;

use bevy::{platform::collections::HashMap, prelude::*};

use super::{ClothPanel, advice::Advice, aim::Aim, watch::Watch};
use crate::{
    solver::SubstepReason,
    state::{ClothReport, ClothStatus},
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
    /// Winds that weren't there before.
    pub added_winds: Vec<Entity>,
    /// The cloths that are chosen.
    pub chosen: Vec<Entity>,
    /// Time of the latest steps of the chosen cloths, ms.
    pub step_times: VecDeque<f32>,
    /// How each chosen cloth has fared.
    pub watches: HashMap<Entity, Watch>,
    pub readings: Readings,
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

/// Notes the time of a step, while somebody looks.
pub(super) fn note_step(mut panel: ResMut<ClothPanel>, cloths: Query<(&ClothReport, &ClothStatus)>, time: Res<Time>) {
    let memory = &mut panel.bypass_change_detection().memory;
    // No cloth steps without time.
    if memory.shown_for == 0 || time.delta_secs() <= 0.0 {
        return;
    }
    let ready = memory.chosen.iter().filter_map(|&cloth| cloths.get(cloth).ok());
    let ready = ready.filter(|(_, status)| status.is_running());
    let total: f32 = ready.map(|(report, _)| report.step_time().as_secs_f32() * 1e3).sum();
    if memory.step_times.len() == STEPS {
        memory.step_times.pop_front();
    }
    memory.step_times.push_back(total);
}
