//! Points of a cloth, between its particles.

use bevy::{math::Vec3A, prelude::*};

use crate::state::ClothState;

/// A point of a cloth, by the triangle that it lies on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[reflect(Default, Debug, Clone, PartialEq)]
pub struct ClothPoint {
    /// Index into [`ClothState::triangles`].
    pub triangle: u32,
    /// Barycentric weights of the triangle's three particles: 0 or more, 1 in sum.
    pub weights: Vec3,
}

impl ClothPoint {
    /// Whether the weights are those of a point of the triangle, but for rounding.
    pub(super) fn is_on_triangle(&self) -> bool {
        self.weights.min_element() >= -1e-3 && (self.weights.element_sum() - 1.0).abs() < 1e-3
    }
}

impl ClothState {
    /// The point of the cloth that is nearest to a world position, m. None until the cloth is ready, and for a position
    /// that isn't finite.
    pub fn nearest_point(&self, position: Vec3) -> Option<ClothPoint> {
        if !position.is_finite() {
            return None;
        }
        let place = Vec3A::from(position - self.origin);
        let near = |triangle: &[u32; 3]| {
            let corners = triangle.map(|i| self.particles.position[i as usize]);
            let weights = nearest_weights(place, corners);
            (blend(corners, weights).distance_squared(place), weights)
        };
        let nearest = (0..).zip(self.topology.triangles.iter().map(near));
        let (triangle, (_, weights)) = nearest.min_by(|(_, (a, _)), (_, (b, _))| a.total_cmp(b))?;
        Some(ClothPoint { triangle, weights })
    }

    /// World position of a point of the cloth after the latest step, m. None for a triangle that the cloth doesn't have.
    pub fn point_position(&self, point: ClothPoint) -> Option<Vec3> {
        let triangle = self.topology.triangles.get(point.triangle as usize)?;
        let corners = triangle.map(|i| self.particles.position[i as usize]);
        Some(self.origin + Vec3::from(blend(corners, point.weights)))
    }
}

/// The point with these barycentric weights.
pub(crate) fn blend([a, b, c]: [Vec3A; 3], weights: Vec3) -> Vec3A {
    a * weights.x + b * weights.y + c * weights.z
}

/// Weights of the point of a triangle that is nearest to `p`: on its face, else on one of its sides. Ericson, "Real-Time
/// Collision Detection" (2005), section 5.1.5.
fn nearest_weights(p: Vec3A, [a, b, c]: [Vec3A; 3]) -> Vec3 {
    let (ab, ac, normal) = (b - a, c - a, (b - a).cross(c - a));
    let area = normal.length_squared();
    let on_face = Vec3::new((b - p).cross(c - p).dot(normal), (c - p).cross(a - p).dot(normal), 0.0) / area;
    let on_face = on_face.with_z(1.0 - on_face.x - on_face.y);
    if area > 0.0 && on_face.cmpge(Vec3::ZERO).all() {
        return on_face;
    }
    let along = |from: Vec3A, side: Vec3A| {
        ((p - from).dot(side) / side.length_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0)
    };
    let (u, v, w) = (along(a, ab), along(b, c - b), along(a, ac));
    let sides = [Vec3::new(1.0 - u, u, 0.0), Vec3::new(0.0, 1.0 - v, v), Vec3::new(1.0 - w, 0.0, w)];
    let distance = |weights: &Vec3| blend([a, b, c], *weights).distance_squared(p);
    let [first, second, third] = sides;
    [second, third].into_iter().fold(first, |best, next| if distance(&next) < distance(&best) { next } else { best })
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [Vec3A; 3] = [Vec3A::ZERO, Vec3A::X, Vec3A::Y];

    #[test]
    fn the_nearest_point_is_on_the_face_a_side_or_a_corner() {
        for (p, expected) in [
            (Vec3A::new(0.25, 0.5, 3.0), Vec3::new(0.25, 0.25, 0.5)),
            (Vec3A::new(0.25, -1.0, 2.0), Vec3::new(0.75, 0.25, 0.0)),
            (Vec3A::new(2.0, 2.0, 0.0), Vec3::new(0.0, 0.5, 0.5)),
            (Vec3A::new(-1.0, -1.0, 1.0), Vec3::X),
            (Vec3A::new(3.0, -1.0, 1.0), Vec3::Y),
        ] {
            assert!(nearest_weights(p, CORNERS).abs_diff_eq(expected, 1e-6), "{p}");
        }
    }

    #[test]
    fn a_triangle_of_no_area_has_a_nearest_point() {
        let needle = [Vec3A::ZERO, Vec3A::X, Vec3A::X * 0.5];
        assert_eq!(blend(needle, nearest_weights(Vec3A::new(0.25, 1.0, 0.0), needle)), Vec3A::X * 0.25);
        assert!(nearest_weights(Vec3A::ONE, [Vec3A::ZERO; 3]).is_finite());
    }
}
