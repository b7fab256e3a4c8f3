//! How deep triangles are inside of solids, and not their corners alone.

use bevy::math::Vec3A;
use bevy_drape::solver::Solid;

/// What is found is this exact, m.
const EXACT: f32 = 1e-6;

/// The deeper of `so_far` and the deepest place of a triangle below the surface of `solid`, m.
///
/// The signed distance of a convex solid is a convex function, so no place of the triangle is below the plane that touches
/// it at the middle. Where that could be deeper than what is known, the triangle is cut into four.
pub fn deepest(solid: &Solid, triangle: [Vec3A; 3], so_far: f32) -> f32 {
    let [a, b, c] = triangle;
    let middle = (a + b + c) / 3.0;
    let surface = solid.surface(middle);
    let so_far = so_far.max(-surface.distance);
    let lowest = triangle.map(|corner| surface.normal.dot(corner - middle)).into_iter().fold(0.0, f32::min);
    let size = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
    if -(surface.distance + lowest) <= so_far + EXACT || size < EXACT * EXACT {
        return so_far;
    }
    let [ab, bc, ca] = [a.midpoint(b), b.midpoint(c), c.midpoint(a)];
    [[ab, bc, ca], [a, ab, ca], [b, bc, ab], [c, ca, bc]]
        .into_iter()
        .fold(so_far, |so_far, part| deepest(solid, part, so_far))
}
