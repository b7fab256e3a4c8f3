//! The place that a cloth's positions are relative to: it jumps with teleports and follows on long ways.

use bevy::{math::Vec3A, prelude::*};

use super::{ClothAttachments, ClothGrabs, ClothState};
use crate::frame::Jump;

/// Positions farther than this from the cloth's origin, m, move the origin: an `f32` then still resolves 0.02 mm.
const FARTHEST: f32 = 256.0;

/// Carries the cloth rigidly along with a jump, velocities and world pins with it. Hands let go.
pub(crate) fn carry(state: &mut ClothState, attachments: &mut ClothAttachments, grabs: &mut ClothGrabs, jump: &Jump) {
    grabs.release_all(state);
    let old_origin = move_rigidly(state, jump);
    attachments.world_places().for_each(|place| *place = jump.place(*place, old_origin));
}

/// Moves particles and origin by a rigid motion, and turns velocities. Returns where the origin was, m.
fn move_rigidly(state: &mut ClothState, motion: &Jump) -> Vec3A {
    let old_origin = Vec3A::from(state.origin);
    for positions in [&mut state.particles.position, &mut state.step_start] {
        positions.iter_mut().for_each(|place| *place = motion.place(*place, old_origin));
    }
    state.particles.velocity.iter_mut().for_each(|velocity| *velocity = motion.direction(*velocity));
    state.origin = motion.end().into();
    state.is_disturbed = true;
    old_origin
}

/// Takes a cloth along with a rigid motion that it isn't to feel, velocities turned. Hands and what is pinned to the world stay.
pub(crate) fn take_along(
    state: &mut ClothState,
    attachments: &mut ClothAttachments,
    grabs: &mut ClothGrabs,
    motion: &Jump,
) {
    let old_origin = move_rigidly(state, motion);
    let shift = motion.end() - old_origin;
    attachments.world_places().for_each(|place| *place -= shift);
    grabs.shift_origin(shift);
}

/// Moves the origin after a cloth that has gone far from it.
pub(crate) fn stay_near(state: &mut ClothState, attachments: &mut ClothAttachments, grabs: &mut ClothGrabs) {
    let Some(&place) = state.particles.position.first() else { return };
    if place.abs().max_element() < FARTHEST {
        return;
    }
    let shift = place.round();
    state.origin += Vec3::from(shift);
    for positions in [&mut state.particles.position, &mut state.step_start] {
        positions.iter_mut().for_each(|p| *p -= shift);
    }
    attachments.world_places().for_each(|place| *place -= shift);
    grabs.shift_origin(shift);
}

/// The whole world has been shifted by `by` (m), and the cloth with it.
pub(crate) fn shift(state: &mut ClothState, attachments: &mut ClothAttachments, grabs: &mut ClothGrabs, by: Vec3) {
    state.origin += by;
    state.pose.translation += Vec3A::from(by);
    attachments.anchors.iter_mut().for_each(|anchor| anchor.shift(by));
    grabs.shift_world(by);
}
