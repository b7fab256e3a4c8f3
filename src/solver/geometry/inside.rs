//! Which places are inside of a closed mesh, and what of it is nearest to them.

use bevy::math::Vec3A;

use crate::solver::{
    contact::feature::tangle,
    geometry::{
        bvh::{
            TriangleBvh,
            bounds::{Bounds, BvhBounds},
        },
        closest_point,
    },
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
            crossings += usize::from(tangle::pierces([place, place + way], corners).is_some());
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
    use super::*;
    use crate::solver::shape::TriangleMesh;

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
