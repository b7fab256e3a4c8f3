//! Where cloth has passed through cloth, and the way back.

use bevy::math::Vec3A;

use crate::solver::contact::feature::pair::{FeaturePoints, give};

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

/// An edge that pierces a face of cloth, and the way out.
///
/// The two are moved against each other along the direction in which the line where the surfaces cross gets shorter (Volino
/// and Magnenat-Thalmann, "Resolving Surface Collisions through Intersection Contour Minimization", 2006, equation 6).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tangle {
    /// The edge, then the face.
    points: [u32; 5],
    /// Weights of the points at the place where they cross: of the edge, then of the face.
    weights: [f32; 5],
    /// Unit vector along which the edge is to go.
    way: Vec3A,
}

/// Finds where the edges of two triangles pierce the other one. `numbers` are those of their corners, `places` are where
/// these are.
pub fn find(numbers: [[u32; 3]; 2], places: &[Vec3A], tangles: &mut Vec<Tangle>) {
    let corners = numbers.map(|triangle| triangle.map(|i| places[i as usize]));
    let normals = corners.map(|[a, b, c]| (b - a).cross(c - a));
    // Mostly all of one is on one side of the other.
    for (i, j) in [(0, 1), (1, 0)] {
        let [p, q, r] = corners[j].map(|corner| normals[i].dot(corner - corners[i][0]) > 0.0);
        if p == q && q == r {
            return;
        }
    }
    for (i, j) in [(0, 1), (1, 0)] {
        for k in 0..3 {
            let [from, to, apex] = [k, (k + 1) % 3, (k + 2) % 3];
            let edge = [corners[i][from], corners[i][to]];
            let Some(share) = pierces(edge, corners[j]) else { continue };
            let place = edge[0].lerp(edge[1], share);
            let along = (edge[1] - edge[0]).normalize_or_zero();
            let normal = normals[j].normalize_or_zero();
            let crossing = normals[i].cross(normals[j]).normalize_or_zero();
            // The part of the crossing that lies within the edge's triangle.
            let inward = corners[i][apex] - edge[0];
            let inward = inward - along * inward.dot(along);
            let crossing = if crossing.dot(inward) < 0.0 { -crossing } else { crossing };
            let across = along.dot(normal);
            if across.abs() < 1e-4 {
                continue;
            }
            let way = crossing - normal * (2.0 * along.dot(crossing) / across);
            let on = crate::solver::geometry::closest_point::on_triangle(place, corners[j]);
            tangles.push(Tangle {
                points: [numbers[i][from], numbers[i][to], numbers[j][0], numbers[j][1], numbers[j][2]],
                weights: [1.0 - share, share, on.x, on.y, on.z],
                way: way.normalize_or_zero(),
            });
        }
    }
}

impl Tangle {
    /// Moves edge and face against each other by `far` (m).
    pub fn solve(&self, points: &mut FeaturePoints, far: f32) {
        let all = self.points.map(|i| i as usize);
        let masses = all.map(|i| points.inverse_mass[i]);
        let give = give(self.weights, masses);
        if give <= 0.0 {
            return;
        }
        for (k, (&i, w)) in all.iter().zip(masses).enumerate() {
            let towards = if k < 2 { far } else { -far };
            points.position[i] += self.way * (towards * self.weights[k] * w / give);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_intersect_where_an_edge_pierces() {
        let flat = [Vec3A::ZERO, Vec3A::X, Vec3A::Z];
        let through = [Vec3A::new(0.2, -1.0, 0.2), Vec3A::new(0.2, 1.0, 0.2), Vec3A::new(5.0, 1.0, 5.0)];
        let beside = through.map(|p| p + Vec3A::X);
        assert!(intersect(flat, through) && intersect(through, flat));
        assert!(!intersect(flat, beside) && !intersect(beside, flat));
        assert!(!intersect(flat, flat.map(|p| p + Vec3A::Y * 1e-4)));
    }
}
