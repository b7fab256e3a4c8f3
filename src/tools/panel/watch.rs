//! Measures the chosen cloths once a frame, and how they have fared over the last second.

use std::collections::VecDeque;

use bevy::prelude::*;

use super::{
    advice::{self, Observed, Situation, Stiffness},
    memory::{Memory, Readings},
};
use crate::{
    cloth::{Cloth, ClothSolver, InForce},
    solver::{MeshStructure, Strain},
    state::{ClothAttachments, ClothGrabs, ClothReport, ClothState, ClothStatus},
    surroundings::ClothGravity,
};

/// How far back a watch looks, s.
const SPAN: f64 = 1.0;
/// From when on it tells, s.
const SHORTEST: f64 = 0.5;

/// A cloth's stretch over the last second.
#[derive(Clone, Debug, Default)]
pub(super) struct Watch {
    /// Time in s, largest strain, overload.
    samples: VecDeque<(f64, f32, f32)>,
}

impl Watch {
    /// Adds a sample. `None` for a moment that tells nothing.
    pub fn note(&mut self, now: f64, sample: Option<(f32, f32)>) {
        // Time stands still, or has been set back.
        match self.samples.back() {
            Some(&(latest, ..)) if now == latest => return,
            Some(&(latest, ..)) if now < latest => self.samples.clear(),
            _ => {}
        }
        match sample {
            Some((strain, overload)) => self.samples.push_back((now, strain, overload)),
            None => self.samples.clear(),
        }
        while self.samples.front().is_some_and(|&(then, ..)| now - then > SPAN) {
            self.samples.pop_front();
        }
    }

    /// Medians of strain and overload, once there are enough samples: a jerk is over before that.
    pub fn medians(&self) -> Option<(f32, f32)> {
        let (first, last) = (self.samples.front()?, self.samples.back()?);
        let median = |value: fn(&(f64, f32, f32)) -> f32| {
            let mut values: Vec<f32> = self.samples.iter().map(value).collect();
            values.sort_unstable_by(f32::total_cmp);
            values[values.len() / 2]
        };
        (last.0 - first.0 >= SHORTEST).then(|| (median(|sample| sample.1), median(|sample| sample.2)))
    }
}

/// Measures all chosen cloths.
pub(super) fn measure(world: &World, memory: &mut Memory) {
    let gravity = world.get_resource::<ClothGravity>().map_or(Vec3::ZERO, |gravity| gravity.0);
    let gravity = if gravity.is_finite() { gravity } else { Vec3::ZERO };
    let now = world.get_resource::<Time>().map_or(0.0, Time::elapsed_secs_f64);
    let mut readings = Readings::default();
    memory.watches.retain(|cloth, _| memory.chosen.contains(cloth));
    for &cloth in &memory.chosen {
        let Some(observed) = observe(world, cloth) else { continue };
        let strain = observed.state.strain();
        let gravity = gravity * observed.in_force.settings.gravity_scale;
        let kinetic = add(&mut readings, &observed, strain, gravity);
        let watch = memory.watches.entry(cloth).or_default();
        let overload = advice::overload(&observed, gravity, kinetic);
        watch.note(now, overload.map(|overload| (strain.largest, overload)));
        let advice = situation(&observed, watch).and_then(|situation| advice::advise(&situation));
        readings.advice.extend(advice.map(|advice| (cloth, advice)));
    }
    readings.mean_strain /= readings.particles.max(1) as f32;
    memory.readings = readings;
}

/// Looks at a cloth that runs.
fn observe(world: &World, cloth: Entity) -> Option<Observed<'_>> {
    let cloth = world.get_entity(cloth).ok()?;
    let status = cloth.get::<ClothStatus>().filter(|status| status.is_running())?;
    Some(Observed {
        is_asleep: *status == ClothStatus::Asleep,
        state: cloth.get::<ClothState>()?,
        attachments: cloth.get::<ClothAttachments>()?,
        grabs: cloth.get::<ClothGrabs>()?,
        in_force: cloth.get::<InForce>()?,
        report: cloth.get::<ClothReport>()?,
    })
}

/// Adds the numbers of one cloth. Gives its kinetic energy, J.
fn add(
    readings: &mut Readings,
    Observed { is_asleep, state, report, .. }: &Observed,
    strain: Strain,
    gravity: Vec3,
) -> f32 {
    let energy = state.energy(gravity);
    readings.asleep += usize::from(*is_asleep);
    if let Some(latest) = report.latest().filter(|_| !is_asleep) {
        if latest.substeps > readings.substeps {
            (readings.substeps, readings.substep_reason) = (latest.substeps, latest.reason);
            readings.needed_substeps = latest.needed_substeps;
        }
        readings.contacts += latest.contacts;
    }
    readings.particles += state.particle_count();
    readings.springs += state.topology().springs.len();
    let structure = structure(state);
    let is_like_others = readings.structure.is_empty() || readings.structure == structure;
    readings.structure = if is_like_others { structure } else { "various".into() };
    readings.largest_strain = readings.largest_strain.max(strain.largest);
    readings.mean_strain += strain.mean * state.particle_count() as f32;
    readings.kinetic += energy.kinetic;
    readings.elastic += energy.elastic;
    readings.total += energy.total();
    energy.kinetic
}

/// What the mesh of a cloth was found to be, and how many levels it has.
fn structure(state: &ClothState) -> String {
    let levels = match state.topology().levels.len() {
        0 => "no levels".into(),
        1 => "1 level".into(),
        count => format!("{count} levels"),
    };
    match state.structure() {
        None => String::new(),
        Some(structure @ MeshStructure::Triangles { .. }) => structure.to_string(),
        Some(structure) => format!("{structure}, {levels}"),
    }
}

fn situation(cloth: &Observed, watch: &Watch) -> Option<Situation> {
    let Cloth { solver, max_substeps, tether_slack, .. } = cloth.in_force.settings;
    let latest = cloth.report.latest()?;
    let stiffness_scale = match solver {
        ClothSolver::Strands | ClothSolver::Xpbd => 1.0,
        ClothSolver::Explicit => latest.stiffness_scale,
    };
    let (strain, overload) = watch.medians().unwrap_or_default();
    Some(Situation {
        solver,
        substeps: latest.substeps,
        max_substeps,
        has_tethers: tether_slack.is_some(),
        stiffness: Stiffness::of(&cloth.state.material?),
        stiffness_scale,
        needed: latest.needed_substeps,
        strain,
        overload,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_need_half_a_second_and_forget_after_one() {
        let mut watch = Watch::default();
        for frame in 0..30 {
            watch.note(f64::from(frame) / 60.0, Some((0.1, 9.0)));
        }
        assert_eq!(watch.medians(), None);
        for frame in 30..60 {
            watch.note(f64::from(frame) / 60.0, Some((0.1, 9.0)));
        }
        assert_eq!(watch.medians(), Some((0.1, 9.0)));
        for frame in 60..125 {
            watch.note(f64::from(frame) / 60.0, Some((0.01, 1.0)));
        }
        assert_eq!(watch.medians(), Some((0.01, 1.0)));
        assert!(watch.samples.len() <= 61);
    }

    #[test]
    fn a_jerk_isnt_a_median_and_a_hand_begins_anew() {
        let mut watch = Watch::default();
        for frame in 0..60 {
            let sample = if frame % 10 == 0 { (5.0, 50.0) } else { (0.01, 1.0) };
            watch.note(f64::from(frame) / 60.0, Some(sample));
        }
        assert_eq!(watch.medians(), Some((0.01, 1.0)));
        watch.note(1.0, None);
        assert_eq!(watch.medians(), None);
    }
}
