//! From velocities to positions and back.

use bevy_math::{Vec3A, ops};
use fearless_simd::{dispatch, f32x8, prelude::*};

use crate::{
    input::StepContext,
    layout::{
        points::Points,
        simd::{SimdLevel, Vec3x8, lane},
    },
    particles::lanes::Run,
};

/// What moves particles freely during a substep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion<'a> {
    /// Gravity, m/s².
    pub gravity: Vec3A,
    /// Force on each particle, N; none where nothing but gravity acts.
    pub force: Option<&'a Points>,
    /// What is left of a velocity after the substep, 0..=1.
    pub decay: f32,
    /// Duration of the substep, s.
    pub h: f32,
    /// The speed limit, where no later stage keeps it.
    pub limit: Option<SpeedLimit>,
}

/// Symplectic Euler: velocities from forces (N) and gravity (m/s²), then positions from the new velocities.
pub(crate) fn predict(run: &mut Run, motion: Motion, simd_level: SimdLevel) {
    dispatch!(simd_level.level(), simd => predict_eights(simd, run, motion));
}

#[inline(always)]
fn predict_eights<S: Simd>(simd: S, run: &mut Run, motion: Motion) {
    let all = run.position.iter_mut().zip(&mut *run.previous).zip(&mut *run.velocity).zip(&*run.inverse_mass);
    for (i, (((position, previous), velocity), w)) in all.enumerate() {
        let (place, before) = (Vec3x8::load(simd, position), Vec3x8::load(simd, velocity));
        place.store(previous);
        let (place, after) = motion.of(simd, run.first + i, place, before, lane(simd, w));
        place.store(position);
        after.store(velocity);
    }
}

impl Motion<'_> {
    /// Gravity and damping for `h` seconds.
    pub fn free(ctx: &StepContext, h: f32) -> Self {
        Self { gravity: ctx.gravity, force: None, decay: ops::exp(-ctx.material.damping * h), h, limit: None }
    }

    /// Where the particles of a block come, and how fast they are then. Fixed ones stay.
    #[inline(always)]
    fn of<S: Simd>(
        &self,
        simd: S,
        block: usize,
        place: Vec3x8<S>,
        before: Vec3x8<S>,
        w: f32x8<S>,
    ) -> (Vec3x8<S>, Vec3x8<S>) {
        let pull = Vec3x8::splat(simd, (self.gravity * self.h).to_array());
        let (decay, duration) = (f32x8::splat(simd, self.decay), f32x8::splat(simd, self.h));
        let mut after = before * decay + pull;
        if let Some(force) = self.force {
            after = after + Vec3x8::load(simd, &force.0[block]) * (w * duration);
        }
        let is_free = w.simd_gt(f32x8::splat(simd, 0.0));
        if let Some(limit) = self.limit {
            after = limit.keep(simd, after);
        }
        ((place + after * duration).or(is_free, place), after.or(is_free, before))
    }
}

/// Limits the speed of particles relative to what holds the cloth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpeedLimit {
    /// Mean velocity of what holds the cloth, m/s.
    pub around: Vec3A,
    /// Largest speed relative to that, m/s.
    pub most: f32,
}

impl SpeedLimit {
    /// Velocities within the limit.
    #[inline(always)]
    fn keep<S: Simd>(&self, simd: S, velocity: Vec3x8<S>) -> Vec3x8<S> {
        let around = Vec3x8::splat(simd, self.around.to_array());
        let most = f32x8::splat(simd, self.most);
        let relative = velocity - around;
        let squared = relative.dot(relative);
        let too_fast = squared.simd_gt(most * most);
        if too_fast.any_true() {
            (around + relative * (most / squared.sqrt())).or(too_fast, velocity)
        } else {
            velocity
        }
    }
}

/// What comes after the constraints of a substep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Finish<'a> {
    pub limit: SpeedLimit,
    /// Duration of the substep, s.
    pub h: f32,
    /// The free motion of the next substep, where it can follow at once: each particle is then loaded once for both.
    pub next: Option<Motion<'a>>,
}

/// Velocities from the way that the particles went within a substep, and the motion that follows.
///
/// That is (position - previous) / h, written as what the constraints have added to the integrated velocity: a way of
/// g h² is lost to rounding when h is small, a change of speed of g h isn't.
pub(crate) fn finish(run: &mut Run, finish: Finish, simd_level: SimdLevel) {
    dispatch!(simd_level.level(), simd => finish_eights(simd, run, finish));
}

#[inline(always)]
fn finish_eights<S: Simd>(simd: S, run: &mut Run, Finish { limit, h, next }: Finish) {
    let (duration, rate) = (f32x8::splat(simd, h), f32x8::splat(simd, 1.0 / h));
    let all = run.position.iter_mut().zip(&mut *run.previous).zip(&mut *run.velocity).zip(&*run.inverse_mass);
    for (i, (((position, previous), velocity), w)) in all.enumerate() {
        let (place, w) = (Vec3x8::load(simd, position), lane(simd, w));
        let before = Vec3x8::load(simd, velocity);
        let predicted = Vec3x8::load(simd, previous) + before * duration;
        let after = before + (place - predicted) * rate;
        let is_free = w.simd_gt(f32x8::splat(simd, 0.0));
        let mut after = limit.keep(simd, after).or(is_free, after);
        if let Some(motion) = next {
            place.store(previous);
            let (next_place, next_velocity) = motion.of(simd, run.first + i, place, after, w);
            next_place.store(position);
            after = next_velocity;
        }
        after.store(velocity);
    }
}
