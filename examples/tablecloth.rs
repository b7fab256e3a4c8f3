//! A tablecloth falls on a round table, and a ball rolls underneath it.

mod common;

use bevy::{math::ops, math::primitives::InfinitePlane3d, prelude::*};
use bevy_drape::prelude::*;

fn main() -> AppExit {
    common::app("Tablecloth", "Obstacles move with their transforms; the cloth follows")
        .add_plugins(ClothPlugin::default())
        .add_systems(Startup, (common::spawn_scenery, setup))
        .add_systems(FixedUpdate, roll)
        .run()
}

/// The ball that goes around on the table.
#[derive(Component)]
struct Rolling;

fn setup(mut commands: Commands, mut studio: common::Studio) {
    common::spawn_camera(&mut commands, Vec3::new(0.0, 1.7, 3.0), Vec3::new(0.0, 0.55, 0.0));
    commands.spawn(ClothCollider::from(InfinitePlane3d::default()));
    let wood = Color::srgb(0.45, 0.30, 0.19);
    for (solid, height) in
        [(Cylinder::new(0.7, 0.05), 0.725), (Cylinder::new(0.06, 0.7), 0.35), (Cylinder::new(0.35, 0.03), 0.015)]
    {
        commands.spawn((studio.solid(solid, wood), ClothCollider::from(solid), Transform::from_xyz(0.0, height, 0.0)));
    }
    let ball = Sphere::new(0.12);
    commands.spawn((
        studio.solid(ball, Color::srgb(0.85, 0.45, 0.20)),
        ClothCollider { friction: 0.2, ..ball.into() },
        Transform::from_xyz(0.4, 0.87, 0.0),
        Rolling,
    ));
    commands.spawn((
        studio.cloth(ClothGrid::new(2.0, 2.0, 72, 72).lying(), Color::srgb(0.90, 0.88, 0.82)),
        Cloth { substeps: Some(16), collision_margin: 0.012, ..default() },
        Fabric::POLYESTER_TABLECLOTH,
        Transform::from_xyz(0.0, 1.1, 0.0),
    ));
}

fn roll(time: Res<Time>, mut balls: Query<&mut Transform, With<Rolling>>) {
    let angle = 0.6 * time.elapsed_secs();
    for mut ball in &mut balls {
        ball.translation.x = 0.4 * ops::cos(angle);
        ball.translation.z = 0.4 * ops::sin(angle);
    }
}
