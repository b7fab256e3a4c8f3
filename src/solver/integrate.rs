//! From velocities to positions and back.

use bevy::math::Vec3A;
use fearless_simd::{dispatch, f32x8, prelude::*};

use super::{
    Lanes,
    lanes::Points,
    simd::{Instructions, Vec3x8, lane},
};

/// What moves particles freely during a substep.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion<'a> {
    /// Gravity, m/s².
    pub gravity: Vec3A,
    /// Force on each particle, N; none where nothing but gravity acts.
    pub force: Option<&'a Points>,
    /// What is left of a velocity after the substep, 0..=1.
    pub decay: f32,
    /// Duration of the substep, s.
    pub h: f32,
}

/// Symplectic Euler: velocities from forces (N) and gravity (m/s²), then positions from the new velocities.
pub(super) fn predict(lanes: &mut Lanes, motion: Motion, instructions: Instructions) {
    dispatch!(instructions.level(), simd => predict_eights(simd, lanes, motion));
}

#[inline(always)]
fn predict_eights<S: Simd>(simd: S, lanes: &mut Lanes, Motion { gravity, force, decay, h }: Motion) {
    // What was the position is what it was before.
    core::mem::swap(&mut lanes.position, &mut lanes.previous);
    let pull = Vec3x8::splat(simd, (gravity * h).to_array());
    let (decay, duration) = (f32x8::splat(simd, decay), f32x8::splat(simd, h));
    let Lanes { position, previous, velocity, inverse_mass, .. } = lanes;
    let all = position.0.iter_mut().zip(&previous.0).zip(&mut velocity.0).zip(inverse_mass);
    for (i, (((position, previous), velocity), w)) in all.enumerate() {
        let (place, before) = (Vec3x8::load(simd, previous), Vec3x8::load(simd, velocity));
        let w = lane(simd, w);
        let mut after = before * decay + pull;
        if let Some(force) = force {
            after = after + Vec3x8::load(simd, &force.0[i]) * (w * duration);
        }
        let is_free = w.simd_gt(f32x8::splat(simd, 0.0));
        after.or(is_free, before).store(velocity);
        (place + after * duration).or(is_free, place).store(position);
    }
}

/// The most that particles may be faster than what holds the cloth.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpeedLimit {
    /// Mean velocity of what holds the cloth, m/s.
    pub around: Vec3A,
    /// The most that a particle may differ from it, m/s.
    pub most: f32,
}

/// Velocities from the way that the particles went within a substep of `h` seconds.
///
/// That is (position - previous) / h, written as what the constraints have added to the integrated velocity: a way of
/// g h² is lost to rounding when h is small, a change of speed of g h isn't.
pub(super) fn derive_velocities(lanes: &mut Lanes, limit: SpeedLimit, h: f32, instructions: Instructions) {
    dispatch!(instructions.level(), simd => derive_eights(simd, lanes, limit, h));
}

#[inline(always)]
fn derive_eights<S: Simd>(simd: S, lanes: &mut Lanes, limit: SpeedLimit, h: f32) {
    let Lanes { position, previous, velocity, inverse_mass, .. } = lanes;
    let around = Vec3x8::splat(simd, limit.around.to_array());
    let (duration, rate) = (f32x8::splat(simd, h), f32x8::splat(simd, 1.0 / h));
    let most = f32x8::splat(simd, limit.most);
    let all = position.0.iter().zip(&previous.0).zip(&mut velocity.0).zip(inverse_mass);
    for (((position, previous), velocity), w) in all {
        let before = Vec3x8::load(simd, velocity);
        let predicted = Vec3x8::load(simd, previous) + before * duration;
        let mut after = before + (Vec3x8::load(simd, position) - predicted) * rate;
        let relative = after - around;
        let squared = relative.dot(relative);
        let too_fast = lane(simd, w).simd_gt(f32x8::splat(simd, 0.0)) & squared.simd_gt(most * most);
        if too_fast.any_true() {
            after = (around + relative * (most / squared.sqrt())).or(too_fast, after);
        }
        after.store(velocity);
    }
}
