//! What straight ways cross.

use bevy::math::Vec3A;

/// Triangles that the way from `from` to `to` crosses, each as a share of the way, 0..=1.
pub fn crossings(triangles: impl Iterator<Item = [Vec3A; 3]>, [from, to]: [Vec3A; 2]) -> impl Iterator<Item = f32> {
    triangles.filter_map(move |[a, b, c]| {
        let normal = (b - a).cross(c - a);
        let (start, end) = (normal.dot(from - a), normal.dot(to - a));
        if (start > 0.0) == (end > 0.0) {
            return None;
        }
        let share = start / (start - end);
        let place = from.lerp(to, share);
        let is_inside = |p: Vec3A, q: Vec3A| normal.dot((q - p).cross(place - p)) >= 0.0;
        (is_inside(a, b) && is_inside(b, c) && is_inside(c, a)).then_some(share)
    })
}
