//! Marks on a cloth: pins, grabs, normals and bounds.

use bevy::{math::Vec3A, prelude::*};

use super::{Lines, Shown, palette};

pub(super) fn draw_pins(lines: &mut Lines, shown: &Shown, size: f32) {
    for pin in &shown.state.pins {
        lines.cross(shown.places[pin.particle as usize], size, palette::pin(pin.target));
    }
}

/// Draws where the cloth is held, and where to.
pub(super) fn draw_grabs(lines: &mut Lines, shown: &Shown, size: f32) {
    for (_, point, target) in shown.state.grabs() {
        let Some(triangle) = shown.state.triangles().get(point.triangle as usize) else { continue };
        let [a, b, c] = triangle.map(|i| shown.drawn.particles[i as usize]);
        let held = a * point.weights.x + b * point.weights.y + c * point.weights.z;
        let held = Vec3::from(shown.to_world.transform_point3a(held));
        lines.sphere(held, size, palette::GRAB).resolution(12);
        lines.line(held, target, palette::GRAB);
    }
}

pub(super) fn draw_normals(lines: &mut Lines, shown: &Shown, length: f32) {
    for (&place, normal) in shown.places.iter().zip(normals(shown)) {
        lines.ray(place, normal * length, palette::NORMAL);
    }
}

/// World normals of the particles as drawn, on the side that the mesh's triangles face.
fn normals(shown: &Shown) -> impl Iterator<Item = Vec3> {
    let to_world = shown.to_world.matrix3;
    let mut sums = vec![Vec3A::ZERO; shown.places.len()];
    for triangle in shown.state.triangles() {
        let [a, b, c] = triangle.map(|i| to_world * shown.drawn.particles[i as usize]);
        let doubled_area = (b - a).cross(c - a);
        for &particle in triangle {
            sums[particle as usize] += doubled_area;
        }
    }
    // A mirrored mesh shows its back where its triangles, in the world, seem to face.
    let side = 1.0_f32.copysign(to_world.determinant());
    sums.into_iter().map(move |sum| (sum.normalize_or_zero() * side).into())
}

pub(super) fn draw_bounds(lines: &mut Lines, shown: &Shown) {
    if let Some(bounds) = shown.drawn.bounds {
        lines.aabb_3d(bounds, shown.to_world, palette::BOUNDS);
    }
}
