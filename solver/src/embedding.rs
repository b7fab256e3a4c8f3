//! Embeds a fine mesh in a coarse one: its points follow the coarse triangles, smoothly, and are where they were while these are.
//!
//! Each point goes with its closest triangle: by barycentric weights, on the surface that Phong tessellation rounds the triangle to (Boubekeur
//! and Alexa, "Phong Tessellation", 2008), by its height along the interpolated normal, and by what is left in the triangle's own frame.

use core::array;

use bevy_math::{Mat3A, Vec3, Vec3A};

use crate::geometry::{
    bvh::{
        TriangleBvh,
        bounds::{Bounds, BvhBounds},
    },
    closest_point::on_triangle,
};

/// By how much triangles are rounded, 0..=1: as that paper has it.
const ROUNDNESS: f32 = 0.75;

/// Points that follow a coarse mesh. Immutable.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Embedding {
    triangles: Vec<[u32; 3]>,
    /// Area of each triangle where the points were embedded, m².
    areas: Vec<f32>,
    points: Vec<Embedded>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Embedded {
    /// Among the triangles.
    triangle: u32,
    /// Of its corners.
    weights: Vec3,
    /// Along the interpolated normal, m.
    height: f32,
    /// What is left, in the triangle's frame, m.
    rest: Vec3,
}

/// Buffers of [`Embedding::place`].
#[derive(Clone, Debug, Default)]
pub struct EmbeddingScratch {
    /// Of each coarse point, of length 1.
    normals: Vec<Vec3A>,
    /// Of each triangle: its axes, and how many times larger it is than where points were embedded, in length.
    frames: Vec<(Mat3A, f32)>,
}

impl Embedding {
    /// Embeds `points` (m) in `triangles` between `corners` (m). Nothing is embedded where there is no triangle.
    pub fn new(points: &[Vec3A], corners: &[Vec3A], triangles: &[[u32; 3]]) -> Self {
        let places: Vec<Vec3> = corners.iter().copied().map(Vec3::from).collect();
        let tree = TriangleBvh::new(&places, triangles);
        let mut bounds = BvhBounds::default();
        let at = |triangle: [u32; 3]| triangle.map(|corner| corners[corner as usize]);
        bounds.follow(&tree, |triangle| Bounds::around(at(triangle)), None::<fn(_) -> _>);
        let mut embedding = Self { triangles: tree.triangles.clone(), ..Self::default() };
        embedding.areas = embedding.triangles.iter().map(|&triangle| cross(at(triangle)).length()).collect();
        let mut scratch = EmbeddingScratch::default();
        embedding.prepare(corners, &mut scratch);
        if triangles.is_empty() {
            return embedding;
        }
        let embed = |&point: &Vec3A| {
            let (triangle, weights) = closest(point, &tree, &bounds, corners);
            let mut embedded = Embedded { triangle, weights: weights.into(), ..Embedded::default() };
            let normal = embedding.normal(&embedded, &scratch);
            embedded.height = (point - embedding.follow(&embedded, corners, &scratch)).dot(normal);
            let left = point - embedding.follow(&embedded, corners, &scratch);
            embedded.rest = (scratch.frames[triangle as usize].0.transpose() * left).into();
            embedded
        };
        embedding.points = points.iter().map(embed).collect();
        embedding
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether nothing is embedded.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// The coarse points that a point follows, each with its weight, greater than 0.
    pub fn corners(&self, point: usize) -> impl Iterator<Item = (u32, f32)> {
        let Embedded { triangle, weights, .. } = self.points[point];
        let corners = self.triangles[triangle as usize].into_iter().zip(weights.to_array());
        corners.filter(|&(_, weight)| weight > 0.0)
    }

    /// How far each point was from the coarse mesh when it was embedded, m, but for how round that is.
    pub fn distances(&self) -> impl Iterator<Item = f32> {
        self.points.iter().map(|point| point.height.hypot(point.rest.length()))
    }

    /// Writes where the points are with the coarse ones at `corners` (m), of which there have to be as many as they were embedded in.
    pub fn place(&self, corners: &[Vec3A], scratch: &mut EmbeddingScratch, points: &mut Vec<Vec3A>) {
        self.prepare(corners, scratch);
        points.clear();
        points.extend(self.points.iter().map(|point| self.follow(point, corners, scratch)));
    }

    /// Finds normals and frames of the coarse mesh.
    fn prepare(&self, corners: &[Vec3A], scratch: &mut EmbeddingScratch) {
        let EmbeddingScratch { normals, frames } = scratch;
        normals.clear();
        normals.resize(corners.len(), Vec3A::ZERO);
        frames.clear();
        for (&triangle, &area) in self.triangles.iter().zip(&self.areas) {
            let [a, b, c] = triangle.map(|corner| corners[corner as usize]);
            let across = cross([a, b, c]);
            triangle.iter().for_each(|&corner| normals[corner as usize] += across);
            let normal = across.normalize_or_zero();
            let along = (b - a).normalize_or_zero();
            // One that has no area, or hadn't any, keeps lengths.
            let grown = across.length() / area;
            let scale = if grown.is_finite() && grown > 0.0 { grown.sqrt() } else { 1.0 };
            frames.push((Mat3A::from_cols(along, normal.cross(along), normal), scale));
        }
        normals.iter_mut().for_each(|normal| *normal = normal.normalize_or_zero());
    }

    /// Where a point is that follows the coarse mesh.
    #[inline]
    fn follow(&self, point: &Embedded, corners: &[Vec3A], scratch: &EmbeddingScratch) -> Vec3A {
        let triangle = self.triangles[point.triangle as usize];
        let (frame, scale) = scratch.frames[point.triangle as usize];
        let weights = point.weights.to_array();
        let flat = sum(array::from_fn(|i| corners[triangle[i] as usize] * weights[i]));
        let bulge = sum(array::from_fn(|i| {
            let normal = scratch.normals[triangle[i] as usize];
            normal * (normal.dot(flat - corners[triangle[i] as usize]) * weights[i])
        }));
        let normal = self.normal(point, scratch);
        flat - bulge * ROUNDNESS + normal * (point.height * scale) + frame * (Vec3A::from(point.rest) * scale)
    }

    /// The normal at a point, interpolated.
    #[inline]
    fn normal(&self, point: &Embedded, scratch: &EmbeddingScratch) -> Vec3A {
        let (triangle, weights) = (self.triangles[point.triangle as usize], point.weights.to_array());
        sum(array::from_fn(|i| scratch.normals[triangle[i] as usize] * weights[i])).normalize_or_zero()
    }
}

fn sum([a, b, c]: [Vec3A; 3]) -> Vec3A {
    a + b + c
}

/// Twice a triangle's area, m², along its normal.
fn cross([a, b, c]: [Vec3A; 3]) -> Vec3A {
    (b - a).cross(c - a)
}

/// The triangle that is closest to a point, the first of several, with the weights of its corners there. There has to be one.
fn closest(point: Vec3A, tree: &TriangleBvh, bounds: &BvhBounds, corners: &[Vec3A]) -> (u32, Vec3A) {
    let distance = |node: u32| {
        let Bounds { low, high } = bounds.of_nodes[node as usize];
        point.distance_squared(point.clamp(low, high.max(low)))
    };
    let (mut best, mut found) = (f32::INFINITY, (0, Vec3A::X));
    let mut next = vec![(1, distance(1))];
    while let Some((node, near)) = next.pop() {
        if near > best {
            continue;
        }
        if tree.is_leaf(node) {
            for number in tree.of_leaf(node) {
                let triangle = tree.triangles[number].map(|corner| corners[corner as usize]);
                let weights = on_triangle(point, triangle);
                let place = triangle[0] * weights.x + triangle[1] * weights.y + triangle[2] * weights.z;
                let near = point.distance_squared(place);
                if near < best {
                    (best, found) = (near, (number as u32, weights));
                }
            }
        } else {
            let mut below = [2 * node, 2 * node + 1].map(|node| (node, distance(node)));
            // The nearer one is looked at first: it comes off the stack last in.
            below.sort_by(|one, other| other.1.total_cmp(&one.1));
            next.extend(below);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use core::f32::consts::{PI, TAU};

    use bevy_math::{Affine3A, Quat, ops};

    use super::*;

    /// A sheet of 1 m x 1 m of n x n cells, whose inner points are off their grid, bent by `place`.
    fn sheet(n: usize, place: impl Fn(f32, f32) -> Vec3A) -> (Vec<Vec3A>, Vec<[u32; 3]>) {
        let mut points = Vec::new();
        for i in 0..=n {
            for j in 0..=n {
                let inside = (1..n).contains(&i) && (1..n).contains(&j);
                let off = if inside { 0.3 / n as f32 } else { 0.0 };
                let k = (i * (n + 1) + j) as f32;
                points.push(place(
                    i as f32 / n as f32 + off * ops::sin(12.9 * k),
                    j as f32 / n as f32 + off * ops::sin(78.2 * k),
                ));
            }
        }
        let at = |i: usize, j: usize| (i * (n + 1) + j) as u32;
        let cell = |k: usize| {
            let (i, j) = (k / n, k % n);
            [[at(i, j), at(i + 1, j), at(i, j + 1)], [at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]]
        };
        (points, (0..n * n).flat_map(cell).collect())
    }

    fn wavy(u: f32, v: f32) -> Vec3A {
        Vec3A::new(u, v, 0.05 * ops::sin(5.0 * u) + 0.03 * ops::cos(7.0 * v))
    }

    fn placed(embedding: &Embedding, corners: &[Vec3A]) -> Vec<Vec3A> {
        let mut points = Vec::new();
        embedding.place(corners, &mut EmbeddingScratch::default(), &mut points);
        points
    }

    #[test]
    fn points_are_exactly_where_they_were_embedded_and_go_with_any_motion_and_scale() {
        let (coarse, triangles) = sheet(7, wavy);
        // Above, below, and beyond the border.
        let (fine, _) = sheet(31, |u, v| wavy(1.1 * u - 0.05, v) + Vec3A::Z * 0.02 * ops::sin(40.0 * u));
        let embedding = Embedding::new(&fine, &coarse, &triangles);
        assert_eq!(embedding.len(), fine.len());
        let apart =
            |one: &[Vec3A], other: &[Vec3A]| one.iter().zip(other).map(|(p, q)| p.distance(*q)).fold(0.0, f32::max);
        let at_rest = apart(&placed(&embedding, &coarse), &fine);
        assert!(at_rest < 1e-6, "{at_rest}");
        let turn = Affine3A::from_scale_rotation_translation(Vec3::splat(2.0), Quat::from_rotation_y(1.0), Vec3::ONE);
        let moved = |points: &[Vec3A]| -> Vec<Vec3A> { points.iter().map(|p| turn.transform_point3a(*p)).collect() };
        let rigid = apart(&placed(&embedding, &moved(&coarse)), &moved(&fine));
        assert!(rigid < 5e-6, "{rigid}");
    }

    #[test]
    fn a_bent_sheet_is_round_where_its_triangles_are_flat() {
        let flat = |u: f32, v: f32| Vec3A::new(u, v, 0.0);
        let radius = 1.0 / PI;
        let bent = |u: f32, v: f32| Vec3A::new(radius * ops::sin(PI * u), v, radius * (1.0 - ops::cos(PI * u)));
        let ((coarse, triangles), (fine, _)) = (sheet(8, flat), sheet(32, flat));
        let embedding = Embedding::new(&fine, &coarse, &triangles);
        let (bent_coarse, axis) = (sheet(8, bent).0, Vec3A::new(0.0, 0.0, radius));
        // Borders aside, whose normals have triangles on one side only.
        let inside: Vec<usize> =
            (0..fine.len()).filter(|&i| (0.2..0.8).contains(&fine[i].x) && (0.2..0.8).contains(&fine[i].y)).collect();
        let off = |points: &[Vec3A]| {
            let off = |&i: &usize| ((points[i] - axis) * Vec3A::new(1.0, 0.0, 1.0)).length() - radius;
            let squares: f32 = inside.iter().map(off).map(|off| off * off).sum();
            (squares / inside.len() as f32).sqrt()
        };
        let flat: Vec<Vec3A> = embedding
            .points
            .iter()
            .map(|point| {
                let corners = embedding.triangles[point.triangle as usize].map(|corner| bent_coarse[corner as usize]);
                corners[0] * point.weights.x + corners[1] * point.weights.y + corners[2] * point.weights.z
            })
            .collect();
        let (seen, flat) = (off(&placed(&embedding, &bent_coarse)), off(&flat));
        assert!(seen < 0.6 * flat, "{seen} m off the cylinder, where flat triangles are by {flat}");
    }

    #[test]
    fn no_point_and_no_triangle_are_well() {
        let (coarse, triangles) = sheet(3, wavy);
        assert!(Embedding::new(&[], &coarse, &triangles).is_empty());
        assert!(Embedding::new(&coarse, &coarse, &[]).is_empty());
        // Triangles that lose their area leave everything finite.
        let (fine, _) = sheet(9, |u, v| wavy(u, v) + Vec3A::Z * 0.01);
        let embedding = Embedding::new(&fine, &coarse, &triangles);
        let collapsed = vec![Vec3A::ONE; coarse.len()];
        assert!(placed(&embedding, &collapsed).iter().all(|point| point.is_finite()));
    }

    #[test]
    fn each_point_follows_its_closest_triangle() {
        let ring = |u: f32, v: f32| Vec3A::new(ops::cos(TAU * 0.9 * u), v, ops::sin(TAU * 0.9 * u));
        let ((coarse, triangles), (fine, _)) =
            (sheet(9, ring), sheet(40, |u, v| ring(u, v) * Vec3A::new(1.02, 1.0, 1.02)));
        let embedding = Embedding::new(&fine, &coarse, &triangles);
        for (number, &point) in fine.iter().enumerate() {
            let distance = |triangle: [u32; 3]| {
                let [a, b, c] = triangle.map(|corner| coarse[corner as usize]);
                let weights = on_triangle(point, [a, b, c]);
                point.distance(a * weights.x + b * weights.y + c * weights.z)
            };
            let least = triangles.iter().map(|&triangle| distance(triangle)).fold(f32::INFINITY, f32::min);
            assert!(distance(embedding.triangles[embedding.points[number].triangle as usize]) <= least + 1e-6);
        }
    }
}
