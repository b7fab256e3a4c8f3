//! A cloth falls on a table that is laid: plates, glasses, a carafe, a candle and a bowl, which are met triangle by triangle,
//! and pears, of which each is met as its convex hull.
//!
//! ```text
//! cargo run --all-features --example tablecloth
//! cargo run --all-features --example tablecloth -- --capture captures --frames 200 --every 200
//! ```

mod common;

use core::f32::consts::{FRAC_PI_2, TAU};

use bevy::{
    math::{ops, primitives::InfinitePlane3d},
    prelude::*,
};
use bevy_drape::prelude::*;

/// Where things stand, m above the ground.
const TOP: f32 = 0.75;

// Profiles to be turned: radius and height in m, from the axis at the bottom, up on the outside, down on the inside.
const PLATE: [(f32, f32); 9] = [
    (0.0, 0.0),
    (0.07, 0.0),
    (0.085, 0.006),
    (0.125, 0.02),
    (0.13, 0.0235),
    (0.125, 0.027),
    (0.085, 0.013),
    (0.07, 0.008),
    (0.0, 0.008),
];
const BOWL: [(f32, f32); 11] = [
    (0.0, 0.0),
    (0.06, 0.0),
    (0.068, 0.01),
    (0.12, 0.035),
    (0.155, 0.08),
    (0.155, 0.088),
    (0.149, 0.092),
    (0.142, 0.087),
    (0.105, 0.047),
    (0.06, 0.026),
    (0.0, 0.022),
];
const GLASS: [(f32, f32); 13] = [
    (0.0, 0.0),
    (0.035, 0.0),
    (0.034, 0.004),
    (0.006, 0.012),
    (0.005, 0.07),
    (0.02, 0.085),
    (0.04, 0.12),
    (0.036, 0.165),
    (0.034, 0.168),
    (0.032, 0.165),
    (0.036, 0.12),
    (0.018, 0.09),
    (0.0, 0.083),
];
const CARAFE: [(f32, f32); 10] = [
    (0.0, 0.0),
    (0.05, 0.0),
    (0.058, 0.01),
    (0.062, 0.07),
    (0.04, 0.14),
    (0.028, 0.2),
    (0.04, 0.255),
    (0.034, 0.262),
    (0.02, 0.24),
    (0.0, 0.235),
];
const CANDLE: [(f32, f32); 10] = [
    (0.0, 0.0),
    (0.06, 0.0),
    (0.06, 0.008),
    (0.015, 0.02),
    (0.012, 0.06),
    (0.035, 0.075),
    (0.03, 0.085),
    (0.029, 0.2),
    (0.024, 0.208),
    (0.0, 0.206),
];
const PEAR: [(f32, f32); 7] =
    [(0.0, 0.0), (0.025, 0.002), (0.036, 0.02), (0.034, 0.042), (0.02, 0.068), (0.013, 0.085), (0.0, 0.092)];

fn main() -> AppExit {
    common::app("Tablecloth", "A cloth falls on a table that is laid")
        .add_plugins(ClothPlugin::default())
        .add_systems(Startup, (common::spawn_scenery, spawn_table, lay_table, spawn_cloth))
        .run()
}

/// Primitives need no mesh to be met.
fn spawn_table(mut commands: Commands, mut studio: common::Studio) {
    common::spawn_camera(&mut commands, Vec3::new(0.4, 1.35, 1.55), Vec3::new(0.0, 0.7, 0.0));
    commands.spawn(ClothCollider::from(InfinitePlane3d::default()));
    let wood = Color::srgb(0.40, 0.26, 0.16);
    for (solid, height) in [
        (Cylinder::new(0.75, 0.035), TOP - 0.0175),
        (Cylinder::new(0.06, 0.7), 0.37),
        (Cylinder::new(0.35, 0.03), 0.015),
    ] {
        commands.spawn((studio.solid(solid, wood), ClothCollider::from(solid), Transform::from_xyz(0.0, height, 0.0)));
    }
}

fn lay_table(mut commands: Commands, mut studio: common::Studio) {
    let porcelain = glaze(Color::srgb(0.93, 0.93, 0.90));
    let glass = StandardMaterial { alpha_mode: AlphaMode::Blend, ..glaze(Color::srgba(0.80, 0.88, 0.90, 0.28)) };
    let wax = StandardMaterial { perceptual_roughness: 0.6, ..glaze(Color::srgb(0.86, 0.80, 0.66)) };
    let mut put = |profile: &[(f32, f32)], material: &StandardMaterial, collider: ClothCollider, place: Transform| {
        commands.spawn((
            Mesh3d(studio.meshes.add(common::turned(profile))),
            MeshMaterial3d(studio.materials.add(material.clone())),
            collider,
            place.with_translation(place.translation + Vec3::Y * TOP),
        ));
    };
    for seat in 0..4 {
        let angle = (seat as f32 + 0.35) * FRAC_PI_2;
        put(&PLATE, &porcelain, ClothCollider::mesh(), around(angle, 0.52));
        put(&GLASS, &glass, ClothCollider::mesh(), around(angle - 0.4, 0.42));
    }
    put(&BOWL, &porcelain, ClothCollider::mesh(), Transform::from_xyz(-0.1, 0.0, 0.0));
    put(&CARAFE, &glass, ClothCollider::mesh(), Transform::from_xyz(0.16, 0.0, -0.18));
    put(&CANDLE, &wax, ClothCollider::mesh(), Transform::from_xyz(0.19, 0.0, 0.1));
    let skin = StandardMaterial { perceptual_roughness: 0.5, ..glaze(Color::srgb(0.72, 0.66, 0.22)) };
    for pear in 0..4 {
        let aside = around(pear as f32 * TAU / 3.0, if pear < 3 { 0.06 } else { 0.0 }).translation;
        let height = if pear < 3 { 0.025 } else { 0.07 };
        let lean = Quat::from_rotation_x(0.5) * Quat::from_rotation_y(pear as f32);
        let place = Transform::from_translation(aside + Vec3::new(-0.1, height, 0.0)).with_rotation(lean);
        put(&PEAR, &skin, ClothCollider::convex_hull(), place);
    }
}

fn spawn_cloth(mut commands: Commands, mut studio: common::Studio) {
    commands.spawn((
        studio.cloth(ClothGrid::new(1.8, 1.8, 100, 100).lying(), Color::srgb(0.17, 0.38, 0.42)),
        Cloth { collision_margin: 0.004, ..default() },
        Fabric::POLYESTER_TABLECLOTH,
        // Not over all of it: a place in front is to be seen.
        Transform::from_xyz(-0.25, 1.15, -0.4).with_rotation(Quat::from_rotation_y(0.2)),
    ));
}

/// A place on the table, by the angle from +X on and the distance from its middle.
fn around(angle: f32, distance: f32) -> Transform {
    Transform::from_xyz(distance * ops::cos(angle), 0.0, distance * ops::sin(angle))
}

fn glaze(color: Color) -> StandardMaterial {
    StandardMaterial { base_color: color, perceptual_roughness: 0.18, reflectance: 0.6, ..default() }
}
