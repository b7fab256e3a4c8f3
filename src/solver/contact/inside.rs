//! Which particles are inside of a closed mesh, far from its surface: those of a cloth that began there.

use bevy::math::Vec3A;

use super::{
    closest,
    surface::{Bounds, Places, Surface},
    tangle,
};

/// Where a particle is to a closed mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Whereabouts {
    #[default]
    Unknown,
    Outside,
    Inside,
}

/// Finds out where the particles of a cloth are whose whereabouts are unknown, from those that are known: neighbours are on one
/// side, for none of them is near the mesh. Where no neighbour knows, the mesh is asked.
pub fn find_out(
    whereabouts: &mut [Whereabouts],
    position: &[Vec3A],
    cloth: &Surface,
    (surface, places, points): (&Surface, &Places, &[Vec3A]),
) {
    spread(whereabouts, cloth);
    while let Some(particle) = whereabouts.iter().position(|&place| place == Whereabouts::Unknown) {
        let is_inside = is_inside(position[particle], surface, places, points);
        whereabouts[particle] = if is_inside { Whereabouts::Inside } else { Whereabouts::Outside };
        spread(whereabouts, cloth);
    }
}

/// Lets those who know tell their neighbours.
fn spread(whereabouts: &mut [Whereabouts], cloth: &Surface) {
    let mut tell = |triangle: &[u32; 3]| {
        let known = triangle.map(|i| whereabouts[i as usize]).into_iter().find(|&place| place != Whereabouts::Unknown);
        let mut is_news = false;
        for &corner in triangle {
            if let (Some(known), place @ Whereabouts::Unknown) = (known, &mut whereabouts[corner as usize]) {
                *place = known;
                is_news = true;
            }
        }
        is_news
    };
    // To and fro: news travels far in either direction of the list.
    loop {
        let forth = cloth.triangles.iter().fold(false, |is_news, triangle| tell(triangle) | is_news);
        let back = cloth.triangles.iter().rev().fold(false, |is_news, triangle| tell(triangle) | is_news);
        if !forth && !back {
            return;
        }
    }
}

/// Whether a place is inside of a closed mesh: a way out of it goes through an odd number of triangles.
fn is_inside(place: Vec3A, surface: &Surface, places: &Places, points: &[Vec3A]) -> bool {
    let whole = places.whole();
    if !whole.meets(&Bounds::around([place])) {
        return false;
    }
    // In no direction that meshes have edges along.
    let way = Vec3A::new(0.3712, 0.8519, 0.3691) * (whole.high - whole.low).length();
    let ray = Bounds::around([place, place + way]);
    let mut crossings = 0;
    for_each_near(
        surface,
        places,
        |bounds| bounds.meets(&ray),
        |triangle| {
            let corners = surface.triangles[triangle].map(|i| points[i as usize]);
            crossings += usize::from(tangle::pierces([place, place + way], corners).is_some());
        },
    );
    crossings % 2 == 1
}

/// The triangle of a mesh that is nearest to a place, and the weights of its corners at the nearest place of it.
pub fn nearest(place: Vec3A, surface: &Surface, places: &Places, points: &[Vec3A]) -> Option<(usize, Vec3A)> {
    let mut best: Option<(usize, Vec3A)> = None;
    let least = core::cell::Cell::new(f32::INFINITY);
    let is_nearer = |bounds: &Bounds| {
        let beyond = (bounds.low - place).max(place - bounds.high).max(Vec3A::ZERO);
        beyond.length_squared() < least.get()
    };
    for_each_near(surface, places, is_nearer, |triangle| {
        let corners = surface.triangles[triangle].map(|i| points[i as usize]);
        let weights = closest::on_triangle(place, corners);
        let at = corners[0] * weights.x + corners[1] * weights.y + corners[2] * weights.z;
        if at.distance_squared(place) < least.get() {
            least.set(at.distance_squared(place));
            best = Some((triangle, weights));
        }
    });
    best
}

/// Visits the triangles whose boxes, and those of the patches that they are in, are near.
fn for_each_near(surface: &Surface, places: &Places, is_near: impl Fn(&Bounds) -> bool, mut visit: impl FnMut(usize)) {
    // Down to the next leaf, then on to the next branch: without a list of what is left.
    let last = surface.node_count() as u32;
    let mut node = 1;
    loop {
        let goes_in = is_near(&places.of_nodes[node as usize]);
        if goes_in && surface.is_leaf(node) {
            surface.of_leaf(node).for_each(&mut visit);
        }
        if goes_in && !surface.is_leaf(node) {
            node *= 2;
            continue;
        }
        // Up from every second branch.
        while node % 2 == 1 && node > 1 {
            node /= 2;
        }
        if node <= 1 || node >= last {
            return;
        }
        node += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::TriangleMesh;

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
            let (triangle, weights) = nearest(place, surface, places, points).expect("there are triangles");
            let [a, b, c] = surface.triangles[triangle].map(|i| points[i as usize]);
            let distance = place.distance(a * weights.x + b * weights.y + c * weights.z);
            let beyond = (place.abs() - 0.5).max(Vec3A::ZERO).length();
            let truth = if expected { 0.5 - place.abs().max_element() } else { beyond };
            assert!((distance - truth).abs() < 1e-5, "{place}: {distance} for {truth}");
        }
    }
}
