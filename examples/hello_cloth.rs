//! The smallest scene: a plugin, a mesh, a component.

mod common;

use bevy::prelude::*;
use bevy_drape::prelude::*;

fn main() -> AppExit {
    // In a game: `App::new().add_plugins((DefaultPlugins, ClothPlugin::default()))`.
    common::app("Hello cloth", "Left drag: turn   Wheel: zoom")
        .add_plugins(ClothPlugin::default())
        .add_systems(Startup, (common::spawn_scenery, setup))
        .run()
}

fn setup(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>, mut materials: ResMut<Assets<StandardMaterial>>) {
    commands.spawn((
        Mesh3d(meshes.add(ClothGrid::new(1.2, 1.2, 40, 40).lying())),
        MeshMaterial3d(materials.add(StandardMaterial {
            base_color: Color::srgb(0.75, 0.22, 0.17),
            perceptual_roughness: 0.9,
            double_sided: true,
            cull_mode: None,
            ..default()
        })),
        Cloth::default(),
        Fabric::default(),
        Pins::edge_corners(ClothEdge::Top),
        Transform::from_xyz(0.0, 1.3, 0.0),
    ));
    commands.spawn((
        Mesh3d(meshes.add(Sphere::new(0.3))),
        MeshMaterial3d(materials.add(Color::srgb(0.85, 0.82, 0.76))),
        ClothCollider::from(Sphere::new(0.3)),
        Transform::from_xyz(0.0, 0.8, 0.0),
    ));
    commands.spawn(Wind { velocity: Vec3::X * 1.5, ..default() });
    common::spawn_camera(&mut commands, Vec3::new(1.9, 1.7, 2.3), Vec3::new(0.0, 0.85, 0.0));
}
