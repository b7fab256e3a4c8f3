//! What surrounds cloths: colliders and wind.

use core::f32::consts::FRAC_PI_2;

use bevy::{
    math::{Vec3A, bounding::Aabb3d},
    prelude::*,
};

use super::{ClothDebugConfig, Lines, Shown, palette, wires::Wires};
use crate::{
    solver::{Ellipsoid, MeshShape, Obstacle, Shape, Solid, TaperedCapsule, force::wind::add_air_velocity},
    surroundings::{collider::Obstacles, wind::Winds},
};

/// Cells along each side of what is drawn of a plane, and their size, m.
const PLANE: (u32, f32) = (20, 0.5);

/// Draws obstacles as the latest step saw them at its end.
pub(super) fn draw_colliders(lines: &mut Lines, obstacles: &Obstacles, wires: &mut Wires) {
    for (_, _, Obstacle { shape, end, .. }) in &obstacles.list {
        match shape {
            Shape::Solid(solid) => draw_solid(lines, *solid, *end),
            Shape::Mesh(MeshShape { mesh, deformed }) => {
                let points = deformed.as_ref().map_or(mesh.points.as_slice(), |points| &points.ends()[1]);
                for ends in wires.of(mesh) {
                    let [from, to] = ends.map(|i| Vec3::from(*end * points[i as usize]));
                    lines.line(from, to, palette::COLLIDER);
                }
            }
        }
    }
}

fn draw_solid(lines: &mut Lines, solid: Solid, pose: Isometry3d) {
    match solid {
        Solid::Sphere(sphere) => drop(lines.primitive_3d(&sphere, pose, palette::COLLIDER)),
        Solid::Ellipsoid(Ellipsoid { half_size }) => {
            let faces = [
                (Quat::IDENTITY, half_size.xy()),
                (Quat::from_rotation_x(FRAC_PI_2), half_size.xz()),
                (Quat::from_rotation_y(FRAC_PI_2), half_size.zy()),
            ];
            for (turn, half_size) in faces {
                lines.ellipse(pose * Isometry3d::from_rotation(turn), half_size, palette::COLLIDER);
            }
        }
        Solid::Cuboid(cuboid) => lines.primitive_3d(&cuboid, pose, palette::COLLIDER),
        Solid::Capsule(capsule) => {
            lines.primitive_3d(&capsule, pose, palette::COLLIDER).resolution(12);
        }
        Solid::Cylinder(cylinder) => {
            lines.primitive_3d(&cylinder, pose, palette::COLLIDER).resolution(24);
        }
        Solid::TaperedCapsule(TaperedCapsule { radius_top, radius_bottom, half_length }) => {
            for (height, radius) in [(half_length, radius_top), (-half_length, radius_bottom)] {
                lines.sphere(pose * Isometry3d::from_translation(Vec3::Y * height), radius, palette::COLLIDER);
            }
            let side = ConicalFrustum { radius_top, radius_bottom, height: 2.0 * half_length };
            lines.primitive_3d(&side, pose, palette::COLLIDER);
        }
        Solid::Cone(cone) => {
            lines.primitive_3d(&cone, pose, palette::COLLIDER);
        }
        Solid::HalfSpace(plane) => {
            let (cells, spacing) = PLANE;
            let plane = Plane3d { normal: plane.normal, ..default() };
            let drawn = lines.primitive_3d(&plane, pose, palette::COLLIDER);
            drawn.cell_count(UVec2::splat(cells)).spacing(Vec2::splat(spacing));
        }
    }
}

/// Draws the velocity of the air in a cloth's box.
pub(super) fn draw_wind(lines: &mut Lines, shown: &Shown, winds: &Winds, config: &ClothDebugConfig) {
    let Some(bounds) = shown.drawn.bounds else { return };
    let state = shown.state;
    let mut felt = Vec::new();
    winds.around(state.origin, &mut felt);
    // Differences first: far from the world's origin, only they have precision left.
    let from_origin = shown.to_world.translation - Vec3A::from(state.origin);
    let places: Vec<Vec3A> =
        cells(bounds, config.wind_cells).map(|place| shown.to_world.matrix3 * place + from_origin).collect();
    let mut air = vec![Vec3A::ZERO; places.len()];
    add_air_velocity(&felt, &state.particles.position, &places, &mut air);
    for (place, velocity) in places.into_iter().zip(air) {
        let start = state.origin + Vec3::from(place);
        let end = start + Vec3::from(velocity) * config.wind_scale;
        // An arrow of no length has no direction for its tip.
        if let Some(length) = (end - start).try_normalize().map(|_| start.distance(end)) {
            lines.arrow(start, end, palette::WIND).with_tip_length(0.2 * length);
        }
    }
}

/// Middles of near-cubic cells that fill a box, with `most` of them along its longest side.
fn cells(bounds: Aabb3d, most: u32) -> impl Iterator<Item = Vec3A> {
    let size = bounds.max - bounds.min;
    let spacing = size.max_element() / most.clamp(1, 16) as f32;
    // Rounded, since a side of just as many cells as the longest mustn't get one more.
    let [x, y, z] = size.to_array().map(|side| (side / spacing).round().max(1.0) as u32);
    (0..x * y * z).map(move |i| {
        let cell = UVec3::new(i % x, i / x % y, i / (x * y)).as_vec3a() + 0.5;
        bounds.min + size * cell / UVec3::new(x, y, z).as_vec3a()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places(size: Vec3, most: u32) -> Vec<Vec3A> {
        cells(Aabb3d::new(Vec3::ONE, size / 2.0), most).collect()
    }

    #[test]
    fn cells_fill_the_box_from_its_middle() {
        assert_eq!(places(Vec3::new(3.0, 2.0, 0.0), 3).len(), 6, "a flat box has one layer");
        assert_eq!(places(Vec3::new(0.1, 0.1, 0.1), 3).len(), 27);
        for size in [Vec3::new(3.0, 2.0, 0.0), Vec3::new(0.0, 4.0, 1.1), Vec3::ZERO] {
            let places = places(size, 4);
            let middle = places.iter().sum::<Vec3A>() / places.len() as f32;
            assert!(middle.abs_diff_eq(Vec3A::ONE, 1e-6), "{size}: {middle}");
        }
    }

    #[test]
    fn a_number_of_cells_out_of_its_range_counts_as_the_nearest_one_within() {
        assert_eq!(places(Vec3::X, 0).len(), 1);
        assert_eq!(places(Vec3::X, u32::MAX).len(), 16);
    }
}
