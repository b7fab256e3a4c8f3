//! Flags in winds of three strengths: the pole holds an edge, the wind does the rest.

mod common;

use bevy::prelude::*;
use bevy_drape::prelude::*;

fn main() -> AppExit {
    common::app("Flags", "A light breeze, a fresh one, half a gale")
        .add_plugins(ClothPlugin::default())
        .add_systems(Startup, (common::spawn_scenery, setup))
        .run()
}

fn setup(mut commands: Commands, mut studio: common::Studio) {
    common::spawn_camera(&mut commands, Vec3::new(0.8, 1.7, 6.5), Vec3::new(0.5, 1.4, 0.0));
    let winds = [
        (2.0, Color::srgb(0.90, 0.75, 0.30)),
        (7.0, Color::srgb(0.20, 0.45, 0.65)),
        (18.0, Color::srgb(0.75, 0.20, 0.18)),
    ];
    for (i, (speed, color)) in winds.into_iter().enumerate() {
        let foot = Vec3::new(2.0 * i as f32 - 2.3, 0.0, 0.0);
        let pole = studio.spawn_rod(&mut commands, foot, foot + Vec3::Y * 2.4, 0.025);
        commands.spawn((
            studio.cloth(ClothGrid::new(1.4, 0.9, 50, 33), color),
            Cloth::default(),
            Fabric { lift: 0.8, ..Fabric::POLYESTER_TABLECLOTH },
            // Pinned to the pole, the flag follows wherever that goes.
            Pins::edge(ClothEdge::Left).to_entity(pole),
            Transform::from_translation(foot + Vec3::new(0.73, 1.9, 0.0)),
        ));
        // Each wind blows in a box of its own.
        commands.spawn((
            Wind {
                velocity: Vec3::new(speed, 0.0, 0.15 * speed),
                region: WindShape::Cuboid(Cuboid::new(2.0, 3.0, 3.0)),
                edge: 0.05,
                seed: i as u32,
                ..default()
            },
            Transform::from_translation(foot + Vec3::new(0.9, 1.5, 0.0)),
        ));
    }
}
