//! Points of a cloth, between its particles.

use bevy::{math::Vec3A, prelude::*};

use crate::{solver::geometry::closest_point, state::ClothState};

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
            // Of triangles with next to no area, some may be below zero.
            let weights = Vec3::from(closest_point::on_triangle(place, corners).max(Vec3A::ZERO));
            let weights = weights / weights.element_sum();
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
