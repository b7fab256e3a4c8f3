//! Crates of Rapier's come down on parachutes: the corners of each canopy are pinned to rings, and ropes hold the crate by
//! those. On the ground the canopy falls over its crate.
//!
//! ```text
//! cargo run --all-features --example parachute
//! cargo run --all-features --example parachute -- --capture captures --frames 240 --every 60
//! ```

mod common;

use bevy::prelude::*;
use bevy_drape::prelude::*;
use bevy_rapier3d::prelude::*;

/// Side of a canopy, length of its ropes and side of a crate, m.
const CANOPY: f32 = 2.0;
const ROPE: f32 = 1.5;
const CRATE: f32 = 0.4;

fn main() -> AppExit {
    common::app("Parachutes", "The air holds the canopy, the canopy the crate: the heavier, the faster")
        // Both in the same schedule, at one rate.
        .insert_resource(Time::<Fixed>::from_hz(60.0))
        .insert_resource(TimestepMode::Fixed { dt: 1.0 / 60.0, substeps: 1 })
        .add_plugins(RapierPhysicsPlugin::<NoUserData>::default().in_fixed_schedule())
        .add_plugins((ClothPlugin::default(), ClothRapierPlugin))
        .add_systems(Startup, (common::spawn_scenery, setup))
        .add_systems(Update, draw_ropes)
        .run()
}

fn setup(mut commands: Commands, mut studio: common::Studio) {
    common::spawn_camera(&mut commands, Vec3::new(-1.2, 1.0, 7.4), Vec3::new(0.2, 2.5, 0.0));
    // Rapier's colliders are obstacles as they are.
    commands.spawn((RigidBody::Fixed, Collider::halfspace(Vec3::Y).unwrap_or_default()));
    for (x, z, mass, color) in [
        (-2.5, 0.0, 0.3, Color::srgb(0.86, 0.55, 0.22)),
        (0.0, -0.6, 1.0, Color::srgb(0.72, 0.20, 0.18)),
        (2.5, 0.2, 3.0, Color::srgb(0.20, 0.42, 0.60)),
    ] {
        spawn_parachute(&mut commands, &mut studio, Vec3::new(x, 4.2, z), mass, color);
    }
    commands.spawn(Wind { velocity: Vec3::new(0.25, 0.0, 0.0), gusts: 0.5, ..default() });
}

/// A ring between a corner of the canopy and the crate.
#[derive(Component)]
struct Ring {
    load: Entity,
    corner: Vec3,
}

fn spawn_parachute(commands: &mut Commands, studio: &mut common::Studio, place: Vec3, mass: f32, color: Color) {
    let load = commands
        .spawn((
            studio.solid(Cuboid::from_length(CRATE), Color::srgb(0.58, 0.43, 0.27)),
            RigidBody::Dynamic,
            Collider::cuboid(CRATE / 2.0, CRATE / 2.0, CRATE / 2.0),
            ColliderMassProperties::Mass(mass),
            Velocity::default(),
            Transform::from_translation(place),
        ))
        .id();
    let grid = ClothGrid::new(CANOPY, CANOPY, 40, 40).lying();
    let canopy = place + Vec3::Y * 1.2;
    let mut pins = Pins::none();
    for (column, row) in [(0, 0), (39, 0), (0, 39), (39, 39)] {
        let side = Vec3::new(column as f32 / 39.0 - 0.5, 0.0, row as f32 / 39.0 - 0.5);
        let corner = Vec3::new(side.x, 0.5, side.z) * CRATE;
        let rope = RopeJointBuilder::new(ROPE).local_anchor1(corner);
        let ring = commands.spawn((
            studio.solid(Sphere::new(0.02), Color::srgb(0.75, 0.72, 0.66)),
            RigidBody::Dynamic,
            Collider::ball(0.02),
            ColliderMassProperties::Mass(0.02),
            Velocity::default(),
            // The cloth is fixed to it, and so shouldn't be pushed away by it.
            NotClothCollider,
            ImpulseJoint::new(load, rope),
            Ring { load, corner },
            Transform::from_translation(canopy + side * CANOPY),
        ));
        pins = pins.and(Pins::indices([grid.vertex(column, row)]).to_entity(ring.id()));
    }
    commands.spawn((
        studio.cloth(grid, color),
        Cloth { self_collision: true, ..default() },
        // Stiff enough for cells of 5 cm to show its folds.
        Fabric { density: 0.05, bending_rigidity: 60e-6, drag: 1.4, ..Fabric::SILK },
        pins,
        Transform::from_translation(canopy),
    ));
}

fn draw_ropes(rings: Query<(&Ring, &GlobalTransform)>, crates: Query<&GlobalTransform>, mut gizmos: Gizmos) {
    for (ring, place) in &rings {
        if let Ok(load) = crates.get(ring.load) {
            gizmos.line(load.transform_point(ring.corner), place.translation(), Color::srgb(0.85, 0.82, 0.75));
        }
    }
}
