//! A ribbon falls end first on the ground, into a pile.

use std::io;

use bevy::{math::Vec3A, prelude::*};

use super::{Scene, Settings, drape::GROUND, wave::wave};

/// Its sides, m.
const WIDTH: f32 = 0.05;
const LENGTH: f32 = 2.0;

/// How high the lower end is at first, m.
const HEIGHT: f32 = 0.02;

/// Nearly straight.
pub fn ribbon(settings: &Settings) -> io::Result<Scene> {
    let cloth = settings.cloth(&settings.grid(WIDTH, LENGTH).into())?.placed(|rest| {
        let Vec2 { x: aside, y: height } = wave(rest.y + LENGTH / 2.0, 0.1, 1.7);
        Vec3A::new(rest.x, HEIGHT + height, aside)
    });
    Ok(Scene::new(settings, [cloth]).with(GROUND, Vec3::ZERO))
}
