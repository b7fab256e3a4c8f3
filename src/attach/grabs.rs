//! Grabbed points follow their targets.

use std::sync::Arc;

use bevy::{math::Vec3A, prelude::*};

use crate::{
    cloth::InForce,
    frame::Steps,
    solver::Grab,
    state::{ClothGrabbed, ClothGrabs, ClothReleased, ClothState, ClothStatus, HeldGrab, StepInput},
};

/// Plans the way of every grabbed point over the coming step.
pub(crate) fn lead_grabs(
    mut cloths: Query<(&ClothState, &ClothStatus, &InForce, &mut ClothGrabs, &mut StepInput)>,
    (time, steps): (Res<Time>, Res<Steps>),
) {
    for (state, status, in_force, mut grabs, mut input) in &mut cloths {
        if !status.is_running() || input.pass != steps.pass() || grabs.is_empty() && input.grabs.is_empty() {
            continue;
        }
        let has_tethers = in_force.settings.tether_slack.is_some();
        input.grabs.clear();
        input.grabs.extend(grabs.held.iter_mut().map(|held| {
            let triangle = state.topology.triangles[held.point.triangle as usize];
            let start = held.led;
            let target = Vec3A::from(held.target - state.origin);
            held.led = start.move_towards(target, held.grip.max_speed * time.delta_secs());
            Grab {
                particles: triangle,
                weights: held.point.weights.to_array(),
                start,
                end: held.led,
                stiffness: held.grip.stiffness,
                damping: held.grip.damping,
                max_force: held.grip.max_force,
                mass: held.grip.mass,
                tethers: if has_tethers { held.tethers.clone() } else { Arc::default() },
            }
        }));
    }
}

/// Tells of grabs that have begun or ended.
pub(crate) fn send_grab_events(mut commands: Commands, mut cloths: Query<(Entity, &ClothState, &mut ClothGrabs)>) {
    for (entity, state, mut grabs) in &mut cloths {
        let grabs = grabs.bypass_change_detection();
        let position_of = |held: &HeldGrab| state.point_position(held.point).unwrap_or(held.target);
        let grabbed = |held: &HeldGrab, position| ClothGrabbed { entity, grab: held.id, point: held.point, position };
        for (held, position) in grabs.ended.drain(..) {
            let position = position.unwrap_or_else(|| position_of(&held));
            if !held.is_told {
                commands.trigger(grabbed(&held, position));
            }
            commands.trigger(ClothReleased { entity, grab: held.id, point: held.point, position });
        }
        for held in grabs.held.iter_mut().filter(|held| !held.is_told) {
            held.is_told = true;
            commands.trigger(grabbed(held, position_of(held)));
        }
    }
}
