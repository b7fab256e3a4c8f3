//! Impacts at 30 m/s.

use std::io;

use bevy::{
    math::{Isometry3d, Vec3A},
    prelude::*,
};
use bevy_drape::solver::Solid;

use super::{Cloth, Scene, Settings, crossing, drape::GROUND};

/// m/s
const SPEED: f32 = 30.0;

/// A ball of `radius` metres meets a grid of a square metre.
pub fn ball(settings: &Settings, radius: f32) -> io::Result<Scene> {
    Ok(ball_against(settings, settings.cloth(&settings.grid(1.0, 1.0).lying().into())?, radius))
}

/// A ball of `radius` metres meets a square metre that is held all around, from below, and stops 0.15 m above it. What it
/// counts is whether the ball has passed.
pub fn ball_against(settings: &Settings, cloth: Cloth, radius: f32) -> Scene {
    const START: f32 = -1.0;
    const STOP: f32 = 0.15;
    /// Until the cloth has come to rest, s.
    const WAIT: f32 = 0.5;
    let is_border = |rest: Vec3| rest.x.abs().max(rest.z.abs()) > 0.4999;
    let cloth = cloth.held(is_border);
    let aside = Vec3::new(0.3, 0.0, 0.2) * settings.cell();
    let place = move |seconds: f32| aside + Vec3::Y * (START + SPEED * (seconds - WAIT).max(0.0)).min(STOP);
    let scene = Scene::new(settings, [cloth]).with(Solid::Sphere(Sphere::new(radius)), place(0.0));
    let scene = scene.led_by(move |scene, seconds| {
        scene.lead_obstacle(0, Isometry3d::from_translation(place(seconds)));
    });
    scene.judged_by("passed", |scene| {
        let centre = scene.surroundings.obstacles[0].end.translation;
        let above = crossing::crossings(scene.triangles(), [centre, centre + Vec3A::Y * 10.0]).count();
        (above % 2 == 0) as u32 as f32
    })
}

/// A square metre that flies, and falls, meets a wall of 4 mm, aslant. What it counts are particles on the other side: under its
/// foot, between wall and ground, there may be one.
pub fn wall(settings: &Settings) -> io::Result<Scene> {
    const THICKNESS: f32 = 0.004;
    let wall = Solid::Cuboid(Cuboid::new(6.0, 4.0, THICKNESS));
    let scene = thrown(settings, 0.3)?.with(wall, Vec3::Y * 2.0).with(GROUND, Vec3::ZERO);
    Ok(scene.judged_by("passed", |scene| {
        scene.cloths[0].particles.position.iter().filter(|p| p.z > THICKNESS / 2.0 && p.x.abs() < 3.0).count() as f32
    }))
}

/// The same meets a ball of `radius` metres.
pub fn post(settings: &Settings, radius: f32) -> io::Result<Scene> {
    let ball = Solid::Sphere(Sphere::new(radius));
    Ok(thrown(settings, 0.0)?.with(ball, Vec3::new(0.01, 1.5, 0.0)).with(GROUND, Vec3::ZERO))
}

/// An upright square metre that is turned by `turn` rad and flies at what is at (0, 1.5, 0).
fn thrown(settings: &Settings, turn: f32) -> io::Result<Scene> {
    let turn = Quat::from_rotation_y(turn);
    let mut cloth = settings
        .cloth(&settings.grid(1.0, 1.0).into())?
        .placed(|rest| Vec3A::from(turn * rest) + Vec3A::new(0.0, 1.5, -1.3));
    cloth.particles.velocity.fill(Vec3A::Z * SPEED);
    Ok(Scene::new(settings, [cloth]))
}
