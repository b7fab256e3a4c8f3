//! What garments hang by: a hanger, a hoop, pegs.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use super::{common::Studio, flat, shirt};

const WOOD: Color = Color::srgb(0.62, 0.45, 0.29);

/// Radius of wires and cords, m.
const WIRE: f32 = 0.0025;

/// Radius of the hanger's arms, how far they reach, and how far below the shoulders they are before the shirt falls on them, m.
const ARM: f32 = 0.012;
const REACH: f32 = 0.18;
const BELOW: f32 = 0.045;

/// Ends of the hanger's arms in the space of the shirt, m: the one in the middle, the left one and the right one.
pub fn arms() -> [Vec3; 3] {
    [0.0, -REACH, REACH].map(|x| Vec3::new(x, shirt::shoulder(x.into()) as f32 - BELOW, 0.0))
}

/// An arm between two places, to be seen and to be met.
pub fn arm(from: Vec3, to: Vec3) -> (Capsule3d, Transform) {
    let (way, length) = (to - from).normalize_and_length();
    let turn = Quat::from_rotation_arc(Vec3::Y, way);
    (Capsule3d::new(ARM, length), Transform::from_translation((from + to) / 2.0).with_rotation(turn))
}

/// A hanger for a shirt at `place`, which hangs from a rod so high, m.
pub fn spawn_hanger(commands: &mut Commands, studio: &mut Studio, place: Transform, rod: f32) {
    let [middle, left, right] = arms().map(|end| place.transform_point(end));
    for end in [left, right] {
        let (capsule, transform) = arm(middle, end);
        commands.spawn((studio.solid(capsule, WOOD), ClothCollider::from(capsule), transform));
    }
    studio.spawn_rod(commands, middle, middle.with_y(rod), WIRE);
}

/// A hoop for a skirt at `place`, which hangs from a rod so high, m.
pub fn spawn_hoop(commands: &mut Commands, studio: &mut Studio, place: Transform, rod: f32) {
    let radius = flat::WAIST as f32;
    let hoop = Torus { minor_radius: 2.0 * WIRE, major_radius: radius };
    commands.spawn((studio.solid(hoop, WOOD), place));
    for side in [-1.0, 1.0] {
        let end = place.transform_point(Vec3::X * side * radius);
        studio.spawn_rod(commands, end, Vec3::new(place.translation.x, rod, place.translation.z), WIRE);
    }
}

/// A peg that holds cloth at `place` to the rod.
pub fn spawn_peg(commands: &mut Commands, studio: &mut Studio, place: Transform) {
    commands.spawn((studio.solid(Cuboid::new(0.014, 0.07, 0.034), WOOD), place));
}
