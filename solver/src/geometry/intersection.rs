//! Finds where edges pierce triangles.

use bevy_math::Vec3A;

/// Whether two triangles without a common corner pass through each other: an edge of one pierces the other.
pub fn intersect(first: [Vec3A; 3], other: [Vec3A; 3]) -> bool {
    (0..3).any(|i| pierces([first[i], first[(i + 1) % 3]], other).is_some())
        || (0..3).any(|i| pierces([other[i], other[(i + 1) % 3]], first).is_some())
}

/// How far along an edge it pierces a triangle, 0..=1. Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle
/// Intersection" (1997). One that lies in the triangle's plane doesn't.
#[inline]
pub fn pierces([from, to]: [Vec3A; 2], [a, b, c]: [Vec3A; 3]) -> Option<f32> {
    let (ab, ac, way) = (b - a, c - a, to - from);
    let normal = ab.cross(ac);
    let (start, end) = (normal.dot(from - a), normal.dot(to - a));
    if (start > 0.0) == (end > 0.0) {
        return None;
    }
    let share = start / (start - end);
    let place = from + way * share;
    let inside = |p: Vec3A, q: Vec3A| normal.dot((q - p).cross(place - p)) >= 0.0;
    (inside(a, b) && inside(b, c) && inside(c, a)).then_some(share)
}
