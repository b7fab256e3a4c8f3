//! Where cloth has passed through cloth, and the way back.

use bevy_math::Vec3A;

use crate::{
    contact::{feature::pair::FeaturePoints, friction::effective_inverse_mass},
    geometry::{closest_point, intersection::pierces},
};

/// Acceleration at which edge and face go apart at most, m/s²: two hundred times that of gravity. Where they can't part, more would put
/// energy into the cloth for ever.
const PULL: f32 = 2000.0;

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
            let on = closest_point::on_triangle(place, corners[j]);
            tangles.push(Tangle {
                points: [numbers[i][from], numbers[i][to], numbers[j][0], numbers[j][1], numbers[j][2]],
                weights: [1.0 - share, share, on.x, on.y, on.z],
                way: way.normalize_or_zero(),
            });
        }
    }
}

impl Tangle {
    /// Moves edge and face against each other within a substep of `h` seconds: by `far` (m) from where they were before it at most.
    pub fn solve(&self, points: &mut FeaturePoints, far: f32, h: f32) {
        let all = self.points.map(|i| i as usize);
        let masses = all.map(|i| points.inverse_mass[i]);
        let inverse_mass = effective_inverse_mass(self.weights, masses);
        if inverse_mass <= 0.0 {
            return;
        }
        let of_edge = |k: usize| if k < 2 { 1.0 } else { -1.0 };
        let moved = |k: usize| (points.position[all[k]] - points.previous[all[k]]) * (of_edge(k) * self.weights[k]);
        let apart = self.way.dot((0..5).map(moved).sum());
        let push = (far - apart).clamp(0.0, PULL * h * h) / inverse_mass;
        for (k, (&i, w)) in all.iter().zip(masses).enumerate() {
            points.position[i] += self.way * (of_edge(k) * push * self.weights[k] * w);
        }
    }
}

#[cfg(test)]
mod tests {
    use bevy_math::{DMat3, DVec3};
    use proptest::prelude::*;

    use super::*;
    use crate::geometry::intersection::intersect;

    fn point() -> impl Strategy<Value = Vec3A> {
        prop::array::uniform3(-1.0_f32..1.0).prop_map(Vec3A::from)
    }

    /// Where an edge and a triangle's plane meet, in double precision: how far along the edge, and the weights of the
    /// triangle's corners.
    fn meeting([from, to]: [Vec3A; 2], corners: [Vec3A; 3]) -> [f64; 4] {
        let [from, to, a, b, c] = [from, to, corners[0], corners[1], corners[2]].map(|p| p.as_dvec3());
        let DVec3 { x: v, y: w, z: share } = DMat3::from_cols(b - a, c - a, from - to).inverse() * (from - a);
        [share, 1.0 - v - w, v, w]
    }

    /// How far inside of edge and triangle that is, and none where it can't be told from their borders.
    fn inside(meeting: [f64; 4]) -> Option<bool> {
        let least = meeting.into_iter().chain([1.0 - meeting[0]]).fold(f64::INFINITY, f64::min);
        (least.abs() > 1e-4).then_some(least > 0.0)
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn an_edge_pierces_what_it_meets_inside(
            edge in prop::array::uniform2(point()),
            corners in prop::array::uniform3(point()),
        ) {
            let expected = meeting(edge, corners);
            if let Some(is_inside) = inside(expected) {
                let share = pierces(edge, corners);
                prop_assert_eq!(share.is_some(), is_inside, "{:?} of {:?}", share, expected);
                prop_assert!(share.is_none_or(|share| (f64::from(share) - expected[0]).abs() < 1e-3));
            }
        }

        #[test]
        fn each_edge_that_pierces_is_a_tangle_that_parts_at_the_place(
            first in prop::array::uniform3(point()),
            other in prop::array::uniform3(point()),
            masses in prop::array::uniform6(0.5_f32..2.0),
        ) {
            let places = [first, other].concat();
            let edges = [([0, 1], [3, 4, 5]), ([1, 2], [3, 4, 5]), ([2, 0], [3, 4, 5])];
            let edges = edges.into_iter().chain([([3, 4], [0, 1, 2]), ([4, 5], [0, 1, 2]), ([5, 3], [0, 1, 2])]);
            let mut expected = Vec::new();
            for (edge, face) in edges {
                let at = meeting(edge.map(|i| places[i]), face.map(|i| places[i]));
                let is_inside = inside(at);
                prop_assume!(is_inside.is_some());
                if is_inside == Some(true) {
                    expected.push(([edge[0], edge[1], face[0], face[1], face[2]].map(|i| i as u32), at));
                }
            }
            prop_assert_eq!(intersect(first, other), !expected.is_empty());
            let mut tangles = Vec::new();
            find([[0, 1, 2], [3, 4, 5]], &places, &mut tangles);
            prop_assert_eq!(tangles.iter().map(|t| t.points).collect::<Vec<_>>(), expected.iter().map(|e| e.0).collect::<Vec<_>>());
            for (tangle, (numbers, [share, u, v, w])) in tangles.iter().zip(expected) {
                for (weight, truth) in tangle.weights.into_iter().zip([1.0 - share, share, u, v, w]) {
                    prop_assert!((f64::from(weight) - truth).abs() < 2e-3, "{tangle:?} for {share}, {u}, {v}, {w}");
                }
                prop_assert!((tangle.way.length() - 1.0).abs() < 1e-4);
                let mut points = FeaturePoints { position: places.clone(), previous: places.clone(), ..FeaturePoints::default() };
                points.inverse_mass = masses.to_vec();
                tangle.solve(&mut points, 0.01, 1.0);
                let moved = |i: u32| points.position[i as usize] - places[i as usize];
                // Edge and face go apart by as much at the place, and as a whole nothing moves.
                let sum: Vec3A = numbers.iter().map(|&i| moved(i) / masses[i as usize]).sum();
                prop_assert!(sum.length() < 1e-5, "{sum}");
                let weights = tangle.weights;
                let edge: Vec3A = (0..2).map(|k| moved(numbers[k]) * weights[k]).sum();
                let face: Vec3A = (2..5).map(|k| moved(numbers[k]) * weights[k]).sum();
                let apart = (edge - face).dot(tangle.way);
                prop_assert!(apart > 0.0 && apart < 0.0101, "{apart}");
                prop_assert!((edge - face - tangle.way * apart).length() < 1e-5);
            }
        }
    }

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
