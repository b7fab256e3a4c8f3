//! The place that a cloth's positions are relative to: it jumps with teleports and follows on long ways.

use bevy::{math::Vec3A, prelude::*};

use crate::{anchor::HeldPin, pins::PinTarget, state::ClothState, teleport::Jump};

/// Positions farther than this from the cloth's origin, m, move the origin: an `f32` then still resolves 0.02 mm.
const FARTHEST: f32 = 256.0;

/// Carries the cloth rigidly along with a jump, velocities and world pins with it.
pub(crate) fn carry(state: &mut ClothState, jump: &Jump) {
    state.release_all();
    let old_origin = Vec3A::from(state.origin);
    let carry = |p: &mut Vec3A| *p = jump.place(*p, old_origin);
    state.origin = jump.end().into();
    for positions in [&mut state.particles.position, &mut state.step_start] {
        positions.iter_mut().for_each(carry);
    }
    for velocity in &mut state.particles.velocity {
        *velocity = jump.direction(*velocity);
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

/// The whole world has been shifted, and the cloth with it.
pub(crate) fn shift(state: &mut ClothState, by: Vec3) {
    state.origin += by;
    state.pose.translation += Vec3A::from(by);
    state.carriers.iter_mut().for_each(|carrier| carrier.shift(by));
    state.grabs.shift_targets(by);
}

/// Places of the pins to the world, which are relative to the cloth's origin.
fn world_places(pins: &mut [HeldPin]) -> impl Iterator<Item = &mut Vec3A> {
    pins.iter_mut().filter(|pin| pin.target == PinTarget::World).filter_map(|pin| pin.offset.as_mut())
}
