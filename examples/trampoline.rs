//! Balls and boxes of Avian's fall on a sheet, which carries them and throws them off.
//!
//! ```text
//! cargo run --all-features --example trampoline
//! cargo run --all-features --example trampoline -- --capture captures --frames 360 --every 120
//! ```

mod common;

use std::time::Duration;

use avian3d::prelude::*;
use bevy::{prelude::*, time::common_conditions::on_timer};
use bevy_drape::prelude::*;

/// The trampoline's side and height, m, and how far it is tilted, rad.
const SIDE: f32 = 2.4;
const HEIGHT: f32 = 0.9;
const TILT: f32 = 0.15;

/// So many bodies are there at a time.
const MOST: usize = 24;

fn main() -> AppExit {
    common::app("Trampoline", "Avian's bodies press the cloth down, and it throws them back")
        .add_plugins((PhysicsPlugins::default(), ClothPlugin::default(), ClothAvianPlugin))
        .add_systems(Startup, (common::spawn_scenery, setup))
        .add_systems(FixedUpdate, drop_next.run_if(on_timer(Duration::from_millis(600))))
        .run()
}

fn setup(mut commands: Commands, mut studio: common::Studio) {
    common::spawn_camera(&mut commands, Vec3::new(-1.9, 2.3, 3.7), Vec3::new(0.35, 0.8, 0.0));
    // Avian's colliders are obstacles as they are.
    commands.spawn((RigidBody::Static, Collider::half_space(Vec3::Y), Restitution::new(0.4)));

    let place = Transform::from_xyz(0.0, HEIGHT, 0.0).with_rotation(Quat::from_rotation_z(-TILT));
    let sheet = ClothGrid::new(SIDE, SIDE, 48, 48).lying();
    commands.spawn((
        studio.cloth(sheet, Color::srgb(0.16, 0.32, 0.52)),
        // A sheet that is meant to stretch has no tethers.
        Cloth { tether_slack: None, ..default() },
        Fabric {
            warp_stiffness: 900.0,
            weft_stiffness: 900.0,
            bending_rigidity: 500e-6,
            damping: 0.1,
            ..Fabric::RUBBER
        },
        Pins::predicate(|vertex| vertex.position.abs().max_element() > 0.4999 * SIDE),
        place,
    ));

    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(x, z)| place.transform_point(Vec3::new(x, 0.0, z) * (SIDE / 2.0 + 0.02)));
    for (i, corner) in corners.into_iter().enumerate() {
        spawn_bar(&mut commands, &mut studio, corner, corners[(i + 1) % 4]);
        spawn_bar(&mut commands, &mut studio, corner, corner * Vec3::new(1.1, 0.0, 1.1));
    }
}

/// A part of the frame. The sheet is fixed along it, and so shouldn't be pushed away by it.
fn spawn_bar(commands: &mut Commands, studio: &mut common::Studio, from: Vec3, to: Vec3) {
    const RADIUS: f32 = 0.025;
    let bar = studio.spawn_rod(commands, from, to, RADIUS);
    commands.entity(bar).insert((RigidBody::Static, Collider::capsule(RADIUS, from.distance(to)), NotClothCollider));
}

/// Drops a ball or a box, and takes the oldest away when there are too many.
fn drop_next(
    mut commands: Commands,
    mut studio: common::Studio,
    mut dropped: Local<Vec<Entity>>,
    mut number: Local<usize>,
) {
    *number += 1;
    let color = Color::hsl(*number as f32 * 47.0 % 360.0, 0.6, 0.55);
    let size = 0.13 + 0.03 * (*number % 3) as f32;
    let is_ball = !number.is_multiple_of(3);
    let (looks, collider) = if is_ball {
        (studio.solid(Sphere::new(size), color), Collider::sphere(size))
    } else {
        let side = 1.7 * size;
        (studio.solid(Cuboid::from_length(side), color), Collider::cuboid(side, side, side))
    };
    let aside = Vec3::new(-0.5 + 0.2 * (*number % 4) as f32, 2.6, 0.35 * (*number % 5) as f32 - 0.7);
    let body = commands.spawn((
        looks,
        RigidBody::Dynamic,
        collider,
        Mass(1.5 * size / 0.15),
        Restitution::new(0.3),
        // Drawn between steps as the cloth is.
        TransformInterpolation,
        Transform::from_translation(aside).with_rotation(Quat::from_rotation_x(*number as f32)),
    ));
    dropped.push(body.id());
    if dropped.len() > MOST {
        commands.entity(dropped.remove(0)).despawn();
    }
}
