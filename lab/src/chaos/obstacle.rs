//! Obstacles of every kind.

use bevy::{math::primitives::InfinitePlane3d, prelude::*};
use bevy_drape::prelude::*;

use super::{dice::Dice, mesh};

/// A collider, and the mesh that it needs on its entity.
pub fn collider(dice: &mut Dice, meshes: &mut Assets<Mesh>) -> (ClothCollider, Option<Handle<Mesh>>) {
    let (shape, own) = match dice.count(0..=9) {
        0 => (ColliderShape::HeightField(height_field(dice)), None),
        1 | 2 => of_triangles(dice, meshes),
        _ => (ColliderShape::Solid(solid(dice)), None),
    };
    let friction = dice.setting(0.0, 1.0);
    (ClothCollider { shape, friction, layers: dice.one_of([1, 1, 1, 3, 0]) }, own)
}

fn solid(dice: &mut Dice) -> Solid {
    let mut size = || dice.setting(0.02, 0.5);
    let (a, b, c) = (size(), size(), size());
    match dice.count(0..=6) {
        0 => Solid::Sphere(Sphere { radius: a }),
        1 => Solid::Cuboid(Cuboid { half_size: Vec3::new(a, b, c) }),
        2 => Solid::Capsule(Capsule3d { radius: a, half_length: b }),
        3 => Solid::TaperedCapsule(TaperedCapsule { radius_top: a, radius_bottom: b, half_length: c }),
        4 => Solid::Cylinder(Cylinder { radius: a, half_height: b }),
        5 => Solid::Cone(Cone { radius: a, height: b }),
        _ => Solid::HalfSpace(InfinitePlane3d::new(if dice.chance(0.7) { Vec3::Y } else { dice.direction() })),
    }
}

/// Its own triangles or another's, as they are or as a hull.
fn of_triangles(dice: &mut Dice, meshes: &mut Assets<Mesh>) -> (ColliderShape, Option<Handle<Mesh>>) {
    let (_, mesh) = mesh::roll(dice, 100);
    let mesh = meshes.add(mesh);
    match dice.count(0..=3) {
        0 => (ColliderShape::Mesh(None), Some(mesh)),
        1 => (ColliderShape::Mesh(Some(mesh)), None),
        2 => (ColliderShape::ConvexHull(None), Some(mesh)),
        _ => (ColliderShape::ConvexHull(Some(mesh)), None),
    }
}

fn height_field(dice: &mut Dice) -> HeightField {
    let size = Vec2::new(dice.setting(0.5, 10.0), dice.setting(0.5, 10.0));
    let (columns, rows) = (dice.count(2..=12), dice.count(2..=12));
    let most = dice.spread(0.001, 1.0);
    let mut field = HeightField::new(size, columns, rows, |_, _| dice.within(-most, most));
    if dice.wild(0.1) {
        field.columns = dice.count(0..=13);
    }
    if dice.wild(0.1)
        && let Some(height) = field.heights.first_mut()
    {
        *height = dice.anything();
    }
    field
}
