//! Towels, a sheet and a scarf fall one after the other into a basket: cloth meets itself, other cloth, and a mesh.
//!
//! ```text
//! cargo run --all-features --example pile
//! cargo run --all-features --example pile -- --capture captures --frames 420 --every 420
//! ```

mod common;

use std::time::Duration;

use bevy::{math::primitives::InfinitePlane3d, prelude::*, time::common_conditions::on_timer};
use bevy_drape::prelude::*;

/// Radius and height in m, from the axis at the bottom, up on the outside and down again to the bottom inside.
const BASKET: [(f32, f32); 10] = [
    (0.0, 0.0),
    (0.24, 0.0),
    (0.26, 0.015),
    (0.30, 0.13),
    (0.335, 0.245),
    (0.33, 0.265),
    (0.31, 0.26),
    (0.275, 0.13),
    (0.235, 0.035),
    (0.0, 0.03),
];

/// What falls: size in m, colour, fabric.
fn laundry() -> [(Vec2, Color, Fabric); 9] {
    [
        (Vec2::new(0.40, 0.60), Color::srgb(0.86, 0.82, 0.74), Fabric::COTTON_WOVEN),
        (Vec2::new(0.45, 0.70), Color::srgb(0.25, 0.45, 0.55), Fabric::WOOL_FLANNEL),
        (Vec2::new(0.40, 0.60), Color::srgb(0.80, 0.42, 0.30), Fabric::COTTON_WOVEN),
        (Vec2::new(0.45, 0.45), Color::srgb(0.20, 0.25, 0.42), Fabric::DENIM),
        (Vec2::new(0.45, 0.70), Color::srgb(0.55, 0.62, 0.48), Fabric::WOOL_FLANNEL),
        (Vec2::new(0.40, 0.60), Color::srgb(0.62, 0.25, 0.36), Fabric::COTTON_WOVEN),
        (Vec2::new(0.45, 0.70), Color::srgb(0.45, 0.40, 0.58), Fabric::COTTON_JERSEY),
        (Vec2::new(0.40, 0.60), Color::srgb(0.30, 0.55, 0.50), Fabric::COTTON_WOVEN),
        (Vec2::new(0.18, 1.20), Color::srgb(0.85, 0.68, 0.25), Fabric::SILK),
    ]
}

fn main() -> AppExit {
    common::app("Pile", "Cloth meets itself and other cloth")
        .add_plugins(ClothPlugin::default())
        .add_systems(Startup, (common::spawn_scenery, setup))
        .add_systems(FixedUpdate, drop_next.run_if(on_timer(Duration::from_millis(700))))
        .run()
}

fn setup(mut commands: Commands, mut studio: common::Studio) {
    common::spawn_camera(&mut commands, Vec3::new(0.2, 0.85, 0.95), Vec3::new(0.0, 0.17, 0.0));
    commands.spawn(ClothCollider::from(InfinitePlane3d::default()));
    commands.spawn((studio.cloth(common::turned(&BASKET), Color::srgb(0.66, 0.50, 0.31)), ClothCollider::mesh()));
}

fn drop_next(mut commands: Commands, mut studio: common::Studio, mut dropped: Local<usize>) {
    /// Distance between particles, m.
    const CELL: f32 = 0.02;
    let Some((size, color, fabric)) = laundry().into_iter().nth(*dropped) else { return };
    *dropped += 1;
    let particles = (size / CELL).as_uvec2() + 2;
    // None of them falls flat, and none as another one.
    let number = *dropped as f32;
    let turn = Quat::from_euler(EulerRot::YXZ, 2.4 * number, 1.1, 0.5);
    let aside = Quat::from_rotation_y(1.9 * number) * Vec3::X * 0.07;
    commands.spawn((
        studio.cloth(ClothGrid::new(size.x, size.y, particles.x, particles.y).lying(), color),
        Cloth { self_collision: true, self_distance: 0.006, collision_margin: 0.006, ..default() },
        fabric,
        Transform::from_translation(aside + Vec3::Y * 0.85).with_rotation(turn),
    ));
}
