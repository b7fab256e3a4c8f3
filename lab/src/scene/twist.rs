//! A strip that is held at both ends is turned three times, and back.

use std::io;

use bevy::{math::Vec3A, prelude::*};

use super::{Scene, Settings};

/// Its sides, m.
const WIDTH: f32 = 0.2;
const LENGTH: f32 = 1.0;

/// Turns of one end against the other.
const TURNS: f32 = 3.0;

/// By how much the ends come together meanwhile, m: a rope is shorter than the strip that it is made of.
const SHORTENING: f32 = 0.3;

/// Shares of the time that it takes to turn, and to turn back after a rest.
const TURN: f32 = 0.35;
const REST: f32 = 0.1;

/// Upright. What it counts is how far the particle that is farthest off is from where it was at first, m.
pub fn twist(settings: &Settings) -> io::Result<Scene> {
    let edge = 0.4999 * LENGTH;
    let cloth = settings.cloth(&settings.grid(WIDTH, LENGTH).into())?.held(|rest| rest.y.abs() > edge);
    let duration = settings.duration();
    let scene = Scene::new(settings, [cloth]).led_by(move |scene, seconds| {
        let share = twisted(seconds / duration);
        scene.cloths[0].lead(|rest| {
            let end = rest.y.signum();
            let turn = Quat::from_rotation_y(end * share * TURNS * core::f32::consts::PI);
            Vec3A::from(turn * rest) - Vec3A::Y * (end * share * SHORTENING / 2.0)
        });
    });
    Ok(scene.judged_by("off_m", |scene| {
        let cloth = &scene.cloths[0];
        let off = cloth.particles.position.iter().zip(&cloth.topology.rest).map(|(p, &rest)| p.distance(rest.into()));
        off.fold(0.0, f32::max)
    }))
}

/// How far it is turned, 0..=1, when the share `now` of the time is over. The hands start and stop gently.
fn twisted(now: f32) -> f32 {
    let back = 1.0 - (now - TURN - REST).max(0.0) / TURN;
    let along = (now / TURN).min(back).clamp(0.0, 1.0);
    along * along * (3.0 - 2.0 * along)
}
