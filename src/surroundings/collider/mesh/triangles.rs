//! From any triangles, or points, to those that cloth can collide with. Knows neither meshes nor entities.

use bevy::{
    math::{DVec3, Mat3A, Vec3A},
    platform::collections::HashMap,
    prelude::*,
};
use parry3d::shape::{TriMesh, TriMeshFlags};

use crate::{
    solver::{
        MeshError, TriangleMesh,
        build::{is_near_enough, weld::weld},
    },
    surroundings::collider::error::ColliderError,
};

/// A closed surface whose volume is less than this share of its area times its size is two sheets, one on the other.
pub(super) const THINNEST: f64 = 1e-5;

/// A triangle whose height is less than this share of its longest edge has no side that rounding leaves sure.
const SLIMMEST: f32 = 1e-6;

/// Triangles as an obstacle, and where they come from.
#[derive(Debug)]
pub(crate) struct Made {
    pub mesh: TriangleMesh,
    /// For each of its points, the number of the first of the given ones that it stands for.
    pub origin: Vec<u32>,
}

impl Made {
    /// The same, where the points that it was made of were themselves made of others, which are at `origin`.
    pub(super) fn made_of(mut self, origin: &[u32]) -> Self {
        self.origin.iter_mut().for_each(|i| *i = origin[*i as usize]);
        self
    }
}

/// The surface that `triangles` between `points` (m) make, after `scale`: solid if they enclose a volume, else thin.
///
/// Points that share a place become one. Triangles without an area are dropped, and all but one of those with the same
/// corners; what is closed and inside out is turned around.
pub(crate) fn surface(points: &[Vec3], triangles: &[[u32; 3]], scale: Mat3A) -> Result<Made, ColliderError> {
    let welded = weld(points, triangles);
    let corner = |vertex: u32| welded.particle_of_vertex[vertex as usize];
    let triangles = triangles.iter().map(|triangle| triangle.map(corner)).collect();
    let places = places(points, &welded.vertex_of_particle, scale)?;
    Ok(clean(places, triangles)?.made_of(&welded.vertex_of_particle))
}

/// Triangles that are as they should be already and enclose nothing, after `scale`.
pub(crate) fn sheet(points: &[Vec3], triangles: &[[u32; 3]], scale: Mat3A) -> Result<Made, ColliderError> {
    let origin: Vec<u32> = (0..points.len() as u32).collect();
    let points = places(points, &origin, scale)?;
    Ok(Made { mesh: with_area(&points, triangles, false)?, origin })
}

/// A coordinate of less than this, m, is 0: the reciprocal of what is much smaller doesn't fit into an f32, and parry's trees
/// take it.
const SMALLEST: f32 = 1e-20;

/// The places of the points with these `numbers`, all of them finite and near enough to compute with.
pub(super) fn places(points: &[Vec3], numbers: &[u32], scale: Mat3A) -> Result<Vec<Vec3>, ColliderError> {
    let place = |&i: &u32| {
        let place = scale * points[i as usize];
        // It also makes -0 the same as 0.
        Vec3::select(place.abs().cmplt(Vec3::splat(SMALLEST)), Vec3::ZERO, place)
    };
    let places: Vec<Vec3> = numbers.iter().map(place).collect();
    let Some(far) = places.iter().position(|place| !is_near_enough(place)) else { return Ok(places) };
    if !places[far].is_finite() {
        return Err(ColliderError::NoSize);
    }
    let distance = places[far].abs().max_element();
    Err(MeshError::PositionTooFar { vertex: numbers[far], distance }.into())
}

/// Drops what is no triangle or there already, and finds out whether the others enclose a volume.
pub(super) fn clean(points: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Result<Made, ColliderError> {
    let numbers = numbers(&points);
    let flags = TriMeshFlags::DELETE_DEGENERATE_TRIANGLES
        | TriMeshFlags::DELETE_DUPLICATE_TRIANGLES
        | TriMeshFlags::HALF_EDGE_TOPOLOGY;
    let mesh = TriMesh::with_flags(points, triangles, flags).map_err(|_| MeshError::Empty)?;
    // Without a topology, an edge has too many triangles, or two that face differently.
    let has_no_border = mesh.topology().is_some_and(|topology| {
        let mut sides = topology.half_edges.iter();
        sides.all(|side| side.twin != u32::MAX)
    });
    let thickness = thickness(mesh.vertices(), mesh.indices());
    let is_closed = has_no_border && thickness.abs() > THINNEST;
    let mut triangles = mesh.indices().to_vec();
    if is_closed && thickness < 0.0 {
        triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    }
    let origin = numbers_of(mesh.vertices(), &numbers)?;
    Ok(Made { mesh: with_area(mesh.vertices(), &triangles, is_closed)?, origin })
}

/// What is left of `triangles` that rounding hasn't made lines of. Closed or not is what they were with those.
fn with_area(points: &[Vec3], triangles: &[[u32; 3]], is_closed: bool) -> Result<TriangleMesh, ColliderError> {
    let has_area = |triangle: &&[u32; 3]| {
        let [a, b, c] = triangle.map(|i| points[i as usize]);
        let longest = [b - a, c - b, a - c].into_iter().map(Vec3::length_squared).fold(0.0, f32::max);
        let area = (b - a).cross(c - a).length();
        area.is_finite() && area > SLIMMEST * longest
    };
    let triangles: Vec<[u32; 3]> = triangles.iter().filter(has_area).copied().collect();
    if triangles.is_empty() {
        return Err(MeshError::Empty.into());
    }
    Ok(TriangleMesh::new(points.iter().copied().map(Vec3A::from).collect(), &triangles, is_closed))
}

/// Volume that a closed surface encloses, as a share of its area times its size; negative if it is inside out.
pub(super) fn thickness(points: &[Vec3], triangles: &[[u32; 3]]) -> f64 {
    let low = points.iter().copied().reduce(Vec3::min).unwrap_or_default();
    let high = points.iter().copied().reduce(Vec3::max).unwrap_or_default();
    let (mut volume, mut area) = (0.0, 0.0);
    for triangle in triangles {
        let [a, b, c] = triangle.map(|i| DVec3::from(points[i as usize]) - DVec3::from(low));
        volume += a.dot(b.cross(c)) / 6.0;
        area += (b - a).cross(c - a).length() / 2.0;
    }
    let whole = area * f64::from(low.distance(high));
    if whole > 0.0 { volume / whole } else { 0.0 }
}

/// The first point at each place.
pub(super) fn numbers(points: &[Vec3]) -> HashMap<[u32; 3], u32> {
    let mut numbers = HashMap::default();
    for (number, &point) in (0..).zip(points) {
        numbers.entry(key(point)).or_insert(number);
    }
    numbers
}

/// The numbers of these `points`, each of which is one of those that were numbered.
pub(super) fn numbers_of(points: &[Vec3], numbers: &HashMap<[u32; 3], u32>) -> Result<Vec<u32>, ColliderError> {
    let number = |&point: &Vec3| numbers.get(&key(point)).copied();
    points.iter().map(number).collect::<Option<_>>().ok_or(ColliderError::NoSize)
}

/// A key that is the same for points at one place only.
pub(super) fn key(point: Vec3) -> [u32; 3] {
    point.to_array().map(f32::to_bits)
}

#[cfg(test)]
pub(super) mod tests {
    use super::{super::hull::hull_of, *};

    const PLAIN: Mat3A = Mat3A::IDENTITY;

    /// The twelve triangles of a box of these half sizes, with a point of its own for each corner of each.
    fn block(half: Vec3) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
        let corner = |i: u32| half * (UVec3::new(i >> 2, i >> 1 & 1, i & 1).as_vec3() * 2.0 - 1.0);
        let corners = quads.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d]).map(corner).collect();
        (corners, (0..12).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
    }

    /// Volume that the triangles enclose, m³, facing out of it.
    pub fn volume(mesh: &TriangleMesh) -> f32 {
        let corners = |triangle: &[u32; 3]| triangle.map(|i| mesh.points[i as usize]);
        mesh.triangles().iter().map(corners).map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
    }

    pub fn refusal(made: Result<Made, ColliderError>) -> ColliderError {
        made.map(|made| made.mesh).expect_err("it is refused")
    }

    #[test]
    fn a_box_is_closed_and_faces_out_however_it_came() {
        let (points, triangles) = block(Vec3::new(0.5, 1.0, 2.0));
        let turned: Vec<[u32; 3]> = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        for triangles in [triangles, turned] {
            for scale in [Vec3::ONE, Vec3::new(-1.0, 1.0, 1.0), Vec3::new(3.0, -0.5, 2.0)] {
                let mesh = surface(&points, &triangles, Mat3A::from_diagonal(scale)).unwrap().mesh;
                assert_eq!((mesh.points.len(), mesh.triangles().len(), mesh.is_closed), (8, 12, true));
                assert!((volume(&mesh) - 8.0 * scale.abs().element_product()).abs() < 1e-4, "{scale}");
            }
        }
    }

    #[test]
    fn points_know_where_they_come_from() {
        let (mut points, triangles) = block(Vec3::ONE);
        // One that no triangle has.
        points.insert(0, Vec3::splat(9.0));
        let triangles: Vec<[u32; 3]> = triangles.iter().map(|triangle| triangle.map(|i| i + 1)).collect();
        for make in [surface, hull_of] {
            let made = make(&points, &triangles, PLAIN).unwrap();
            assert_eq!(made.mesh.points.len(), 8);
            for (&point, &origin) in made.mesh.points.iter().zip(&made.origin) {
                let first = points.iter().position(|&other| other == Vec3::from(point));
                assert_eq!(first, Some(origin as usize));
            }
        }
    }

    #[test]
    fn what_has_a_border_or_faces_both_ways_is_thin() {
        let (points, triangles) = block(Vec3::ONE);
        let is_closed = |triangles: &[[u32; 3]]| surface(&points, triangles, PLAIN).unwrap().mesh.is_closed;
        assert!(is_closed(&triangles));
        assert!(!is_closed(&triangles[1..]), "a hole");
        let mut one_turned = triangles.clone();
        one_turned[5].swap(0, 1);
        assert!(!is_closed(&one_turned));
        let fin = [triangles.as_slice(), &[[0, 1, 8]]].concat();
        assert!(!is_closed(&fin), "three triangles on an edge");
    }

    #[test]
    fn two_sheets_on_each_other_are_one() {
        let square = [Vec3::ZERO, Vec3::X, Vec3::ONE.with_y(0.0), Vec3::Z];
        // The same triangles from behind, and others.
        for back in [[[0, 2, 1], [0, 3, 2]], [[0, 3, 1], [1, 3, 2]]] {
            let triangles = [[[0, 1, 2], [0, 2, 3]], back].concat();
            assert!(!surface(&square, &triangles, PLAIN).unwrap().mesh.is_closed);
        }
    }

    #[test]
    fn triangles_that_are_none_are_dropped() {
        let (points, triangles) = block(Vec3::ONE);
        let points = [points.as_slice(), &[Vec3::new(1.0, 1.0, 0.3)]].concat();
        let odd = [[0, 0, 1], [2, 2, 2], [0, 1, 2], [1, 2, 0]];
        let made = surface(&points, &[odd.as_slice(), &triangles].concat(), PLAIN).unwrap();
        assert_eq!((made.mesh.triangles().len(), made.mesh.is_closed), (12, true));
        let slim = [[Vec3::ZERO, Vec3::X * 2.0, Vec3::X], [Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y * 2e-7]];
        for points in slim {
            assert_eq!(refusal(surface(&points, &[[0, 1, 2]], PLAIN)), MeshError::Empty.into());
        }
        assert_eq!(refusal(surface(&points, &odd[..2], PLAIN)), MeshError::Empty.into());
        assert_eq!(refusal(surface(&[], &[], PLAIN)), MeshError::Empty.into());
    }

    #[test]
    fn a_seam_with_a_point_more_on_one_side_leaves_a_box_closed() {
        let (mut points, mut triangles) = block(Vec3::ONE);
        // The first edge has a point in its middle, and a triangle without an area fills the gap.
        let [a, b, c] = triangles.remove(0);
        let middle = points.len() as u32;
        points.push((points[a as usize] + points[b as usize]) / 2.0);
        triangles.extend([[a, middle, c], [middle, b, c], [a, b, middle]]);
        let mesh = surface(&points, &triangles, PLAIN).unwrap().mesh;
        assert_eq!((mesh.triangles().len(), mesh.is_closed), (13, true));
    }

    #[test]
    fn what_is_not_finite_or_too_large_to_compute_with_is_refused() {
        let (points, triangles) = block(Vec3::ONE);
        for scale in [f32::NAN, f32::INFINITY, 1e38] {
            let scale = Mat3A::from_diagonal(Vec3::splat(scale));
            refusal(surface(&points, &triangles, scale));
            refusal(hull_of(&points, &triangles, scale));
            refusal(sheet(&points, &triangles, scale));
        }
    }

    #[test]
    fn a_sheet_keeps_its_points() {
        let made =
            sheet(&[Vec3::ZERO, Vec3::Z, Vec3::X], &[[0, 1, 2]], Mat3A::from_diagonal(Vec3::splat(2.0))).unwrap();
        assert_eq!(made.mesh.points, [Vec3A::ZERO, Vec3A::Z * 2.0, Vec3A::X * 2.0]);
        assert_eq!((made.origin, made.mesh.is_closed), (vec![0, 1, 2], false));
    }
}
