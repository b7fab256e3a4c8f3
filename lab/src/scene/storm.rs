//! A flag in gusts of 15 to 25 m/s that come from all sides, until the wind dies down.

use std::io;

use bevy::{
    math::{DVec3, Vec3A},
    prelude::*,
};
use bevy_drape::solver::{Gusts, WindRegion, WindSource};

use super::{Scene, Settings};

/// Mean speed of the wind, m/s.
const SPEED: f32 = 20.0;

/// Density of the air, kg/m³.
const AIR: f32 = 1.225;

/// How far the wind turns to either side, rad, and how long it takes to and fro, s.
const TURN: f32 = 2.4;
const PERIOD: f32 = 2.5;

/// Share of the time after which it is calm.
const CALM: f32 = 0.6;

/// A square metre, held by one side.
pub fn storm(settings: &Settings) -> io::Result<Scene> {
    let gusts = Gusts { strength: 0.25, period: 1.0, turbulence: 0.3, eddy_size: 0.5, seed: 7 };
    let wind = WindSource {
        velocity: Vec3A::X * SPEED,
        gusts,
        region: WindRegion::Everywhere,
        origin: Vec3A::ZERO,
        travelled: DVec3::ZERO,
        gusts_passed: 0.0,
    };
    let cloth = settings.cloth(&settings.grid(1.0, 1.0).into())?.held(|rest| rest.x < -0.4999);
    let duration = settings.duration();
    let mut scene = Scene::new(settings, [cloth]).led_by(move |scene, seconds| {
        let turn = TURN * bevy::math::ops::sin(core::f32::consts::TAU * seconds / PERIOD);
        let speed = if seconds < CALM * duration { SPEED } else { 0.0 };
        scene.surroundings.winds[0].velocity = Quat::from_rotation_y(turn) * Vec3A::X * speed;
    });
    scene.surroundings.winds.push(wind);
    scene.surroundings.fluid_density = AIR;
    (scene.surroundings.settings.material.drag, scene.surroundings.settings.material.lift) = (1.2, 0.4);
    Ok(scene)
}
