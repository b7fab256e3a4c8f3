//! Cloth in the world inspector of bevy-inspector-egui: every component can be looked at and edited there.
//!
//! Open an entity on the left, such as `Flag` or `Breeze`, and change what is in it.
//!
//! ```text
//! cargo run --example inspector
//! ```

mod common;

use bevy::{math::primitives::InfinitePlane3d, prelude::*};
use bevy_drape::prelude::*;
use bevy_inspector_egui::quick::WorldInspectorPlugin;

fn main() -> AppExit {
    common::app("Cloth in the inspector", "Left drag: turn   Wheel: zoom   Edit components on the left")
        // The inspector needs `EguiPlugin` before it, and so would `ClothPanelPlugin`: it comes with the help.
        .add_plugins((WorldInspectorPlugin::new(), ClothPlugin::default()))
        .add_systems(Startup, (common::spawn_scenery, setup))
        .run()
}

fn setup(mut commands: Commands, mut studio: common::Studio) {
    common::spawn_camera(&mut commands, Vec3::new(-0.6, 1.5, 3.8), Vec3::new(-0.5, 1.0, 0.0));
    let foot = Vec3::new(-0.4, 0.0, 0.0);
    let pole = studio.spawn_rod(&mut commands, foot, foot + Vec3::Y * 2.0, 0.02);
    commands.entity(pole).insert(Name::new("Pole"));
    commands.spawn((
        Name::new("Flag"),
        studio.cloth(ClothGrid::new(1.0, 0.66, 37, 25), Color::srgb(0.62, 0.16, 0.14)),
        Cloth::default(),
        Fabric::POLYESTER_TABLECLOTH,
        Pins::edge(ClothEdge::Left).to_entity(pole),
        Transform::from_translation(foot + Vec3::new(0.52, 1.65, 0.0)),
    ));
    commands.spawn((
        Name::new("Ball"),
        studio.solid(Sphere::new(0.3), Color::srgb(0.82, 0.80, 0.76)),
        ClothCollider::from(Sphere::new(0.3)),
        Transform::from_xyz(0.5, 0.3, 0.6),
    ));
    commands.spawn((
        Name::new("Cloth on the ball"),
        studio.cloth(ClothGrid::new(1.0, 1.0, 47, 47).lying(), Color::srgb(0.16, 0.38, 0.62)),
        Cloth { collision_margin: 0.008, ..default() },
        Fabric::SILK,
        Transform::from_xyz(0.5, 0.8, 0.6),
    ));
    commands.spawn((Name::new("Ground"), ClothCollider::from(InfinitePlane3d::default())));
    // It leaves the cloth on the ball alone.
    let region = WindShape::Cuboid(Cuboid::new(2.5, 2.0, 1.0));
    commands.spawn((
        Name::new("Breeze"),
        Wind { velocity: Vec3::new(5.0, 0.0, 1.0), region, edge: 0.2, ..default() },
        Transform::from_xyz(0.3, 2.2, 0.0),
    ));
}
