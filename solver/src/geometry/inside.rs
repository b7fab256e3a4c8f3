//! Tells whether a place is inside of a closed mesh, and finds the nearest point of the mesh.

use bevy_math::Vec3A;

use crate::geometry::{
    bvh::{
        TriangleBvh,
        bounds::{Bounds, BvhBounds},
    },
    closest_point,
    intersection::pierces,
};

/// Whether a place is inside of a closed mesh: a way out of it goes through an odd number of triangles.
pub fn is_inside(place: Vec3A, surface: &TriangleBvh, places: &BvhBounds, points: &[Vec3A]) -> bool {
    let whole = places.whole();
    if !whole.meets(&Bounds::around([place])) {
        return false;
    }
    // In no direction that meshes have edges along.
    let way = Vec3A::new(0.3712, 0.8519, 0.3691) * (whole.high - whole.low).length();
    let mut crossings = 0;
    surface.for_each_near(
        places,
        |bounds| bounds.is_met_by([place, place + way]),
        |triangle| {
            let corners = surface.triangles[triangle].map(|i| points[i as usize]);
            crossings += usize::from(pierces([place, place + way], corners).is_some());
        },
    );
    crossings % 2 == 1
}

/// The triangle of a mesh that is nearest to a place, and its distance, m, if that is less than `farthest`.
pub fn nearest(
    place: Vec3A,
    farthest: f32,
    surface: &TriangleBvh,
    places: &BvhBounds,
    points: &[Vec3A],
) -> Option<(usize, f32)> {
    let mut best = None;
    let least = core::cell::Cell::new(farthest * farthest);
    let beyond = |bounds: &Bounds| {
        let beyond = (bounds.low - place).max(place - bounds.high).max(Vec3A::ZERO);
        beyond.length_squared()
    };
    let mut visit = |triangle: usize| {
        let corners = surface.triangles[triangle].map(|i| points[i as usize]);
        let squared = closest_point::place_on_triangle(place, corners).distance_squared(place);
        if squared < least.get() {
            least.set(squared);
            best = Some((triangle, squared.sqrt()));
        }
    };
    // One that is rather near tells most others apart at once.
    let likely = surface.leaf_by(|one, other| beyond(&places.of_nodes[other]) < beyond(&places.of_nodes[one]));
    surface.of_leaf(likely).for_each(&mut visit);
    surface.for_each_near(places, |bounds| beyond(bounds) < least.get(), visit);
    best
}

#[cfg(test)]
mod tests {
    use bevy_math::DVec3;
    use proptest::prelude::*;

    use super::*;
    use crate::shape::TriangleMesh;

    /// A closed mesh around the origin whose points are as far away from it as `radii` say, m: an octahedron, each side of
    /// which is cut into four.
    fn star(radii: &[f32]) -> TriangleMesh {
        let ends = [Vec3A::X, Vec3A::Y, Vec3A::NEG_X, Vec3A::NEG_Y, Vec3A::Z, Vec3A::NEG_Z];
        let mut points = ends.to_vec();
        let mut middles = Vec::new();
        let mut triangles = Vec::new();
        for (i, top) in (0..4_u32).flat_map(|i| [(i, 4_u32), (i, 5)]) {
            let next = (i + 1) % 4;
            let corners = if top == 4 { [i, next, top] } else { [next, i, top] };
            let mut middle = |p: u32, q: u32| {
                let key = (p.min(q), p.max(q));
                middles.iter().position(|known| *known == key).map_or_else(
                    || {
                        middles.push(key);
                        points.push((ends[p as usize] + ends[q as usize]).normalize());
                        points.len() as u32 - 1
                    },
                    |at| at as u32 + 6,
                )
            };
            let [a, b, c] = corners;
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        let points = points.into_iter().zip(radii).map(|(point, &radius)| point * radius).collect();
        TriangleMesh::new(points, &triangles, true)
    }

    /// How often a mesh goes around a place: the sum of the solid angles of its triangles, by van Oosterom and Strackee, "The
    /// Solid Angle of a Plane Triangle" (1983).
    fn windings(place: Vec3A, mesh: &TriangleMesh) -> f64 {
        let angle = |triangle: &[u32; 3]| {
            let [a, b, c]: [DVec3; 3] = triangle.map(|i| (mesh.points[i as usize] - place).as_dvec3());
            let (l, m, n) = (a.length(), b.length(), c.length());
            let below = l * m * n + a.dot(b) * n + a.dot(c) * m + b.dot(c) * l;
            2.0 * a.dot(b.cross(c)).atan2(below)
        };
        mesh.triangles().iter().map(angle).sum::<f64>() / (4.0 * core::f64::consts::PI)
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn what_a_mesh_goes_around_is_inside(
            radii in prop::collection::vec(0.3_f32..1.0, 18),
            places in prop::collection::vec(prop::array::uniform3(-1.0_f32..1.0).prop_map(Vec3A::from), 20),
        ) {
            let mesh = star(&radii);
            for place in places {
                let windings = windings(place, &mesh);
                let found = is_inside(place, &mesh.surface, &mesh.places, &mesh.points);
                prop_assert_eq!(found, windings > 0.5, "{}: {}", place, windings);
            }
        }

        #[test]
        fn no_triangle_is_nearer(
            radii in prop::collection::vec(0.3_f32..1.0, 18),
            places in prop::collection::vec(prop::array::uniform3(-1.5_f32..1.5).prop_map(Vec3A::from), 20),
            farthest in prop_oneof![Just(f32::INFINITY), 0.05_f32..1.0],
        ) {
            let mesh = star(&radii);
            for place in places {
                let distance = |triangle: &[u32; 3]| {
                    let corners = triangle.map(|i| mesh.points[i as usize]);
                    closest_point::place_on_triangle(place, corners).distance(place)
                };
                let least = mesh.triangles().iter().map(distance).fold(f32::INFINITY, f32::min);
                let found = nearest(place, farthest, &mesh.surface, &mesh.places, &mesh.points);
                prop_assert!(found.is_some() || least > farthest - 1e-5, "{place}: {least} within {farthest}");
                if let Some((triangle, found)) = found {
                    prop_assert!((found - least).abs() < 1e-5 && found <= farthest, "{place}: {found} for {least}");
                    prop_assert!((distance(&mesh.triangles()[triangle]) - found).abs() < 1e-5);
                }
            }
        }
    }

    /// A cube of 1 m around the origin.
    fn cube() -> TriangleMesh {
        let points = (0..8).map(|i| Vec3A::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) - 0.5).collect();
        let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles: Vec<[u32; 3]> = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        TriangleMesh::new(points, &triangles, true)
    }

    #[test]
    fn the_inside_of_a_cube_is_inside() {
        let TriangleMesh { points, surface, places, .. } = &cube();
        for i in 0..1000 {
            let place = Vec3A::new((i % 10) as f32, (i / 10 % 10) as f32, (i / 100) as f32) / 6.0 - 0.75;
            let expected = place.abs().max_element() < 0.5;
            assert_eq!(is_inside(place, surface, places, points), expected, "{place}");
            let (_, distance) = nearest(place, f32::INFINITY, surface, places, points).expect("there are triangles");
            let beyond = (place.abs() - 0.5).max(Vec3A::ZERO).length();
            let truth = if expected { 0.5 - place.abs().max_element() } else { beyond };
            assert!((distance - truth).abs() < 1e-5, "{place}: {distance} for {truth}");
        }
    }
}
