//! A cloth bent into waves without being stretched.

use bevy::math::{Vec2, ops};

/// Steps of the sum along a wave, a metre.
const STEPS: f32 = 1000.0;

/// Where what is `along` metres from the start of a thread lies that goes up in waves: how far to the side, and how far up,
/// m. The thread leans by up to `lean` rad to both sides, `waves` times a metre.
pub fn wave(along: f32, lean: f32, waves: f32) -> Vec2 {
    let steps = (along * STEPS).ceil().max(1.0);
    let step = along / steps;
    let direction = |s: f32| Vec2::from(ops::sin_cos(lean * ops::sin(core::f32::consts::TAU * waves * s)));
    (0..steps as u32).map(|i| direction((i as f32 + 0.5) * step) * step).sum()
}
