//! A cloth that stands on its edge in waves falls down on the ground and lays itself in folds.

use std::io;

use bevy::{
    math::{Vec3A, ops},
    prelude::*,
};

use super::{Scene, Settings, drape::GROUND, wave::wave};

/// How high the lower edge is at first, m.
const HEIGHT: f32 = 0.05;

/// How far the waves lean, rad.
const LEAN: f32 = 1.0;

/// Waves over the height.
const WAVES: f32 = 3.0;

/// A square metre.
pub fn fold(settings: &Settings) -> io::Result<Scene> {
    let cloth = settings.cloth(&settings.grid(1.0, 1.0).into())?.placed(|rest| {
        let Vec2 { x: aside, y: height } = wave(rest.y + 0.5, LEAN, WAVES);
        // A little different all along, or it would fall as a strip does.
        let ripple = 0.003 * ops::sin(core::f32::consts::TAU * 1.5 * rest.x);
        Vec3A::new(rest.x, HEIGHT + height, aside + ripple)
    });
    Ok(Scene::new(settings, [cloth]).with(GROUND, Vec3::ZERO))
}
