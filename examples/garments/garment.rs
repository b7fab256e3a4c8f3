//! Pieces of cloth, cut out along outlines and sewn together to a mesh of irregular triangles.

use core::iter::zip;

use bevy::{
    asset::RenderAssetUsages,
    math::{DVec2, DVec3},
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};
use drape_lab::laboratory::mesh::poisson;

/// Least distance of two points over the mean length of the edges between them, as such meshes turn out.
const DISTANCE: f64 = 0.74;

/// Distance of points along an outline over the least distance of two points. Below √2 no point inside comes near enough to an
/// outline's edge for Delaunay's triangulation to leave that out.
const OUTLINE: f64 = 1.25;

/// Twice the area, over the least distance squared, of a triangle between points that are next to each other on a straight
/// outline, or nearly so. No other has as little.
const FLAT: f64 = 0.1;

/// UVs for each metre: threads look as fine as those of clothes.
const TILES: f32 = 2.5;

/// Pieces of cloth that are sewn together: cloth welds the points that two pieces have at one place.
pub struct Garment {
    /// Least distance of two points of a piece, m.
    distance: f64,
    positions: Vec<Vec3>,
    uvs: Vec<Vec2>,
    triangles: Vec<[u32; 3]>,
}

impl Garment {
    /// Nothing yet, with edges of about `edge`, m.
    pub fn new(edge: f64) -> Self {
        Self { distance: DISTANCE * edge, positions: Vec::new(), uvs: Vec::new(), triangles: Vec::new() }
    }

    /// How far points along an outline may be from each other, m.
    pub fn step(&self) -> f64 {
        OUTLINE * self.distance
    }

    /// Adds a piece, whose outlines (the outer one and those of holes, m, X right and Y down) are drawn on the side that faces
    /// outwards; the warp runs along Y. `place` is where its points are in the garment.
    pub fn sew(mut self, outlines: &[Vec<DVec2>], place: impl Fn(DVec2) -> DVec3) -> Self {
        let border: Vec<DVec2> = outlines.concat();
        let low = border.iter().copied().reduce(DVec2::min).unwrap_or_default();
        let high = border.iter().copied().reduce(DVec2::max).unwrap_or_default();
        let is_inside = |point: DVec2| outlines.iter().filter(|outline| surrounds(outline, point)).count() % 2 == 1;
        let first = border.iter().map(|&point| point - low).collect();
        let points = poisson::sample(high - low, self.distance, first, |point| is_inside(point + low));
        let begin = self.positions.len() as u32;
        for triangle in poisson::triangles(&points) {
            let [a, b, c] = triangle.map(|corner| points[corner as usize]);
            let has_area = (b - a).perp_dot(c - a).abs() > FLAT * self.distance * self.distance;
            if has_area && is_inside(low + (a + b + c) / 3.0) {
                self.triangles.push(triangle.map(|corner| begin + corner));
            }
        }
        for point in points {
            self.positions.push(place(point + low).as_vec3());
            self.uvs.push(TILES * (point + low).as_vec2());
        }
        self
    }

    /// The mesh.
    pub fn mesh(self) -> Mesh {
        Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, self.positions)
            .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, self.uvs)
            .with_inserted_indices(Indices::U32(self.triangles.into_flattened()))
            .with_computed_smooth_normals()
    }
}

/// Whether a closed outline goes around a point: by the number of its edges to the right of that.
fn surrounds(outline: &[DVec2], point: DVec2) -> bool {
    let ends = zip(outline, outline.iter().cycle().skip(1));
    let to_the_right = ends.filter(|&(a, b)| {
        let is_across = (a.y > point.y) != (b.y > point.y);
        is_across && point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x)
    });
    to_the_right.count() % 2 == 1
}

/// An outline of which `right` is the half at X > 0, from the axis to the axis again.
pub fn symmetric(right: Vec<DVec2>) -> Vec<DVec2> {
    let left: Vec<DVec2> = right[1..right.len() - 1].iter().rev().map(|p| DVec2::new(-p.x, p.y)).collect();
    [right, left].concat()
}

/// The other side of a garment that is the same on both.
pub fn turned_around(place: DVec3) -> DVec3 {
    DVec3::new(-place.x, place.y, -place.z)
}
