//! Looks inside: springs by their strain, pins, tethers, normals, colliders, wind, as gizmos, and diagnostics in the log.

mod common;

use bevy::{diagnostic::LogDiagnosticsPlugin, prelude::*};
use bevy_drape::{
    debug::{ClothDebugConfig, ClothDebugPlugin, ClothDebugView, ClothDiagnosticsPlugin},
    prelude::*,
};

fn main() -> AppExit {
    common::app(
        "Inside",
        "Left: springs by strain   Middle: tethers, pins, wind   Right: normals, collider   G: all off and on",
    )
    .add_plugins((ClothPlugin::default(), ClothDebugPlugin, ClothDiagnosticsPlugin, LogDiagnosticsPlugin::default()))
    // For all cloths. What only one shows, its own view says.
    .insert_resource(ClothDebugConfig {
        view: ClothDebugView { pins: true, ..default() },
        colliders: true,
        wind: true,
        ..default()
    })
    .add_systems(Startup, (common::spawn_scenery, setup))
    .add_systems(Update, switch)
    .run()
}

fn setup(mut commands: Commands, mut studio: common::Studio) {
    common::spawn_camera(&mut commands, Vec3::new(0.4, 1.35, 2.9), Vec3::new(0.0, 0.95, 0.0));
    let linen = Color::srgb(0.55, 0.53, 0.50);
    let grid = ClothGrid::new(1.0, 1.0, 36, 36);
    let hanging = Pins::edge_corners(ClothEdge::Top);

    let springs = ClothDebugView { full_strain: 0.05, ..ClothDebugView::springs() };
    commands.spawn((
        // Soft enough to see the strain, and nothing that holds it back. It is limper than the others.
        studio.cloth(ClothGrid::new(1.0, 1.0, 49, 49), linen),
        Cloth { tether_slack: None, ..default() },
        Fabric::COTTON_JERSEY,
        hanging.clone(),
        springs,
        Transform::from_xyz(-1.15, 1.1, 0.0),
    ));
    commands.spawn((
        studio.cloth(grid, linen),
        Cloth::default(),
        Fabric::POLYESTER_TABLECLOTH,
        hanging,
        ClothDebugView { tethers: true, bounds: true, ..default() },
        Transform::from_xyz(0.0, 1.1, 0.0),
    ));
    commands.spawn((
        studio.cloth(grid.lying(), linen),
        Cloth { collision_margin: 0.01, ..default() },
        Fabric::default(),
        ClothDebugView { normals: true, ..default() },
        Transform::from_xyz(1.15, 1.1, 0.0),
    ));
    commands.spawn((ClothCollider::from(Sphere::new(0.3)), Transform::from_xyz(1.15, 0.6, 0.0)));
    let region = WindShape::Cuboid(Cuboid::new(1.1, 2.0, 2.0));
    commands
        .spawn((Wind { velocity: Vec3::Z * 3.0, region, gusts: 0.5, ..default() }, Transform::from_xyz(0.0, 1.0, 0.0)));
}

/// Switches all gizmos of cloths off and on, as any other group of gizmos.
fn switch(keys: Res<ButtonInput<KeyCode>>, mut store: ResMut<GizmoConfigStore>) {
    if keys.just_pressed(KeyCode::KeyG) {
        store.config_mut::<bevy_drape::debug::ClothGizmos>().0.enabled ^= true;
    }
}
