//! The place that a cloth's positions are relative to: it jumps with teleports and follows on long ways.

use bevy::{
    math::{Affine3A, Vec3A},
    prelude::*,
};

use crate::{
    anchor::{HeldPin, is_invertible},
    pins::PinTarget,
    state::ClothState,
};

/// Positions farther than this from the cloth's origin, m, move the origin: an `f32` then still resolves 0.02 mm.
const FARTHEST: f32 = 256.0;

/// Carries the cloth rigidly from the pose of its latest step to `pose`, velocities and world pins with it.
pub(crate) fn teleport(state: &mut ClothState, pose: Affine3A) {
    if !is_invertible(&state.pose) || !is_invertible(&pose) {
        return;
    }
    // Without the scale, which the springs' lengths don't follow.
    let turn = Affine3A { matrix3: pose.matrix3 * state.pose.matrix3.inverse(), translation: Vec3A::ZERO };
    let turn = turn.to_scale_rotation_translation().1;
    state.release_all();
    let (old_place, old_origin) = (state.pose.translation, Vec3A::from(state.origin));
    let carry = |p: &mut Vec3A| *p = turn * (*p + (old_origin - old_place));
    state.origin = pose.translation.into();
    for positions in [&mut state.particles.position, &mut state.step_start] {
        positions.iter_mut().for_each(carry);
    }
    for velocity in &mut state.particles.velocity {
        *velocity = turn * *velocity;
    }
    for offset in world_places(&mut state.pins) {
        carry(offset);
    }
}

/// Moves the origin after a cloth that has gone far from it.
pub(crate) fn stay_near(state: &mut ClothState) {
    let Some(&place) = state.particles.position.first() else { return };
    if place.abs().max_element() < FARTHEST {
        return;
    }
    let shift = place.round();
    state.origin += Vec3::from(shift);
    for positions in [&mut state.particles.position, &mut state.step_start] {
        positions.iter_mut().for_each(|p| *p -= shift);
    }
    for offset in world_places(&mut state.pins) {
        *offset -= shift;
    }
    state.grabs.shift(shift);
}

/// Places of the pins to the world, which are relative to the cloth's origin.
fn world_places(pins: &mut [HeldPin]) -> impl Iterator<Item = &mut Vec3A> {
    pins.iter_mut().filter(|pin| pin.target == PinTarget::World).filter_map(|pin| pin.offset.as_mut())
}
