//! A hundred flags, stepped side by side.

mod common;

use bevy::prelude::*;
use bevy_drape::prelude::*;

fn main() -> AppExit {
    common::app("A hundred flags", "A hundred cloths of 32 x 20 particles in one wind")
        .add_plugins(ClothPlugin::default())
        .add_systems(Startup, (common::spawn_scenery, setup))
        .run()
}

fn setup(mut commands: Commands, mut studio: common::Studio) {
    common::spawn_camera(&mut commands, Vec3::new(-3.0, 5.0, 14.0), Vec3::new(0.0, 1.2, 0.0));
    // One mesh for all: each cloth draws a copy of its own, and what the mesh's springs are is worked out once.
    let (mesh, _) = studio.cloth(ClothGrid::new(1.0, 0.62, 32, 20), Color::WHITE);
    let materials: Vec<_> =
        (0..5).map(|i| studio.cloth(Rectangle::default(), Color::hsl(20.0 + 75.0 * i as f32, 0.55, 0.50)).1).collect();
    let (pole, wood) = studio.solid(Cylinder::new(0.015, 1.8), Color::srgb(0.42, 0.30, 0.20));
    for i in 0..100 {
        let foot = Vec3::new(1.5 * (i % 10) as f32 - 7.0, 0.0, 1.5 * (i / 10) as f32 - 8.0);
        commands.spawn((pole.clone(), wood.clone(), Transform::from_translation(foot + Vec3::Y * 0.9)));
        commands.spawn((
            mesh.clone(),
            materials[(i * 7 + i / 10 * 3) % materials.len()].clone(),
            Cloth::default(),
            Fabric::COTTON_WOVEN,
            Pins::edge(ClothEdge::Left),
            Transform::from_translation(foot + Vec3::new(0.515, 1.48, 0.0)),
        ));
    }
    commands.spawn(Wind { velocity: Vec3::new(5.0, 0.0, 1.0), gusts: 0.6, turbulence: 0.25, ..default() });
}
