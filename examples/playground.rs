//! A stand-in for the playground: flat panels where cloths will hang.

mod common;

use std::f32::consts::FRAC_PI_2;

use bevy::prelude::*;

fn main() -> AppExit {
    common::app("Playground", "Left drag: turn   Right drag: shift   Wheel: zoom")
        .add_systems(Startup, (common::spawn_scenery, setup))
        .add_systems(Update, turn)
        .run()
}

#[derive(Component)]
struct Panel;

fn setup(
    mut commands: Commands,
    server: Res<AssetServer>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut images: ResMut<Assets<Image>>,
) {
    common::spawn_camera(&mut commands, Vec3::new(0.0, 1.7, 6.5), Vec3::new(0.0, 1.1, 0.0));
    let panel = meshes.add(
        Plane3d::new(Vec3::Z, Vec2::splat(0.7))
            .mesh()
            .build()
            .with_generated_tangents()
            .unwrap_or_else(|_| Plane3d::new(Vec3::Z, Vec2::splat(0.7)).into()),
    );
    for (x, colour) in [(-1.8, Color::srgb(0.72, 0.16, 0.14)), (0.0, Color::srgb(0.14, 0.36, 0.62))] {
        commands.spawn((
            Mesh3d(panel.clone()),
            MeshMaterial3d(materials.add(common::fabric_material(&mut images, colour, Vec2::splat(6.0)))),
            Transform::from_xyz(x, 1.2, 0.0).with_rotation(Quat::from_rotation_y(0.4 * x)),
            Panel,
        ));
    }
    commands.spawn((
        Mesh3d(meshes.add(Sphere::new(0.35))),
        MeshMaterial3d(materials.add(Color::srgb(0.85, 0.62, 0.18))),
        Transform::from_xyz(-0.8, 0.35, 1.4),
    ));
    commands.spawn((
        Mesh3d(panel),
        MeshMaterial3d(materials.add(common::fabric_material(
            &mut images,
            Color::srgb(0.90, 0.86, 0.78),
            Vec2::splat(6.0),
        ))),
        Transform::from_xyz(0.9, 0.4, 1.3).with_rotation(Quat::from_rotation_x(-0.9 * FRAC_PI_2)),
    ));
    commands.spawn((
        WorldAssetRoot(server.load(GltfAssetLabel::Scene(0).from_asset("flag.glb"))),
        Transform::from_xyz(1.3, 2.2, 0.0),
    ));
}

fn turn(time: Res<Time>, mut panels: Query<&mut Transform, With<Panel>>) {
    for mut panel in &mut panels {
        panel.rotate_y(0.3 * time.delta_secs());
    }
}
