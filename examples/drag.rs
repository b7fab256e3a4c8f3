//! Cloth that mouse and fingers drag, and a scarf that is waved by code, as a hand in virtual reality would.
//!
//! Press on the cloth and move; the wheel brings what is held nearer or farther; with Shift it stays where it is let go.

mod common;

use bevy::{math::ops, prelude::*};
use bevy_drape::prelude::*;

fn main() -> AppExit {
    common::app("Drag", "Drag the cloth   Wheel while dragging: nearer, farther   Shift while letting go: pin it there")
        .add_plugins((ClothPlugin::default(), ClothPickingPlugin))
        .add_systems(Startup, (common::spawn_scenery, setup))
        .add_systems(Update, common::rest_camera_while_dragging)
        .add_systems(FixedUpdate, wave)
        .add_observer(mark)
        .add_observer(unmark)
        .run()
}

/// The scarf that is waved, and the hold on it once there is one.
#[derive(Component, Default)]
struct Waved(Option<GrabId>);

fn setup(mut commands: Commands, mut studio: common::Studio) {
    common::spawn_camera(&mut commands, Vec3::new(0.3, 1.5, 3.6), Vec3::new(0.3, 0.95, 0.0));
    commands.spawn(ClothCollider::from(bevy::math::primitives::InfinitePlane3d::default()));

    let (left, right) = (Vec3::new(-1.1, 1.75, 0.0), Vec3::new(0.3, 1.75, 0.0));
    studio.spawn_rod(&mut commands, left, right, 0.015);
    commands.spawn((
        studio.cloth(ClothGrid::new(1.2, 1.2, 40, 40), Color::srgb(0.70, 0.22, 0.18)),
        Cloth::default(),
        Fabric::COTTON_WOVEN,
        Pins::edge_corners(ClothEdge::Top),
        Transform::from_xyz(-0.4, 1.15, 0.0),
    ));
    commands.spawn((
        studio.cloth(ClothGrid::new(0.25, 1.1, 12, 52), Color::srgb(0.24, 0.50, 0.46)),
        Cloth::default(),
        Fabric::SILK,
        Transform::from_xyz(1.2, 1.1, 0.0),
        Waved::default(),
    ));
    commands.spawn(Wind { velocity: Vec3::new(0.3, 0.0, 1.5), gusts: 0.8, turbulence: 0.4, ..default() });
}

/// Holds the scarf by the middle of its upper edge, and leads that along an eight.
fn wave(time: Res<Time>, mut scarves: Query<(&ClothState, &mut ClothGrabs, &mut Waved)>) {
    let t = 3.0 * time.elapsed_secs();
    let hand = Vec3::new(1.2 + 0.35 * ops::sin(t), 1.6, 0.2 * ops::sin(2.0 * t));
    for (scarf, mut grabs, mut waved) in &mut scarves {
        if waved.0.is_none() {
            // None until the cloth is ready.
            waved.0 = scarf.nearest_point(hand).and_then(|point| grabs.grab(scarf, point, ClothGrip::default()));
        }
        if let Some(hold) = waved.0
            && !grabs.move_grab(hold, hand)
        {
            // Put back, as by a reset: take hold of it again.
            waved.0 = None;
        }
    }
}

/// A cloth glows a little while somebody holds it.
fn mark(grabbed: On<ClothGrabbed>, cloths: Query<&MeshMaterial3d<StandardMaterial>>, studio: common::Studio) {
    glow(grabbed.entity, 0.08, cloths, studio);
}

fn unmark(released: On<ClothReleased>, cloths: Query<&MeshMaterial3d<StandardMaterial>>, studio: common::Studio) {
    glow(released.entity, 0.0, cloths, studio);
}

fn glow(cloth: Entity, strength: f32, cloths: Query<&MeshMaterial3d<StandardMaterial>>, mut studio: common::Studio) {
    if let Ok(material) = cloths.get(cloth)
        && let Some(material) = studio.materials.get_mut(&material.0)
    {
        let material = material.into_inner();
        material.emissive = material.base_color.to_linear() * strength;
    }
}
