//! Obstacles of triangles: meshes, convex hulls and height fields.

use std::sync::Arc;

use bevy_math::{Vec3, Vec3A};
use bevy_platform::collections::HashMap;

use crate::geometry::bvh::{
    Representative, TriangleBvh,
    bounds::{Bounds, BvhBounds},
    edges_of,
};

/// Triangles that cloth can't pass, prepared for contact. Built once and shared.
#[derive(Clone, Debug, PartialEq)]
pub struct TriangleMesh {
    /// Points, m, in the obstacle's own frame.
    pub points: Vec<Vec3A>,
    /// Whether the triangles enclose a volume and all face out of it: cloth is then kept outside. Else they are thin, and
    /// cloth stays on the side that it comes from.
    pub is_closed: bool,
    pub(crate) surface: TriangleBvh,
    /// Boxes around the triangles where the points are.
    pub(crate) places: BvhBounds,
}

/// A triangle mesh as an obstacle within one step.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshShape {
    /// The mesh.
    pub mesh: Arc<TriangleMesh>,
    /// Where its points are instead if they move within the obstacle's frame: of a skinned mesh.
    pub deformed: Option<DeformedPoints>,
}

/// Points of a mesh that move within the obstacle's frame during a step.
#[derive(Clone, Debug, PartialEq)]
pub struct DeformedPoints {
    /// At the start and at the end of the step, m.
    pub(crate) ends: [Arc<[Vec3A]>; 2],
    /// Radius of a ball around the frame's origin that holds all of them, m.
    pub(crate) reach: f32,
}

impl DeformedPoints {
    /// As many points as the mesh has, at the start and at the end of the step, m.
    pub fn new(ends: [Arc<[Vec3A]>; 2]) -> Self {
        let squares = ends.iter().flat_map(|points| points.iter()).map(|point| point.length_squared());
        let reach = squares.fold(0.0, f32::max).sqrt();
        Self { ends, reach }
    }

    /// The points at the start and at the end of the step, m.
    pub fn ends(&self) -> &[Arc<[Vec3A]>; 2] {
        &self.ends
    }
}

impl TriangleMesh {
    /// Triangles with their corners among `points` (m), all of them with an area, none of them twice. They are
    /// `is_closed` if each edge has two that face the same side, and that is outside.
    pub fn new(points: Vec<Vec3A>, triangles: &[[u32; 3]], is_closed: bool) -> Self {
        let rest: Vec<Vec3> = points.iter().copied().map(Vec3::from).collect();
        let mut surface = TriangleBvh::new(&rest, triangles);
        sharpen(&mut surface, &points, is_closed);
        let mut places = BvhBounds::default();
        places.follow(&surface, |triangle| Bounds::around(triangle.map(|i| points[i as usize])), None::<fn(_) -> _>);
        Self { points, is_closed, surface, places }
    }

    /// Corners of each triangle.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.surface.triangles
    }

    /// Box around it: its least and greatest coordinates, m.
    pub fn bounds(&self) -> [Vec3A; 2] {
        let Bounds { low, high } = self.places.whole();
        [low, high]
    }
}

/// Finds how far each corner and edge stands out, as a share of the distance to what is next to it: the sine of the angle
/// under which an edge falls off to both sides, and of that under which a corner falls off to all.
fn sharpen(surface: &mut TriangleBvh, points: &[Vec3A], is_closed: bool) {
    let at = |i: u32| points[i as usize];
    let normals: Vec<Vec3A> = surface
        .triangles
        .iter()
        .map(|triangle| {
            let [a, b, c] = triangle.map(at);
            (b - a).cross(c - a).normalize_or_zero()
        })
        .collect();
    let mut sides: HashMap<[u32; 2], Vec<usize>> = HashMap::default();
    let mut normal_at = vec![Vec3A::ZERO; points.len()];
    for (number, &triangle) in surface.triangles.iter().enumerate() {
        for [a, b] in edges_of(triangle) {
            sides.entry([a.min(b), a.max(b)]).or_default().push(number);
        }
        for i in 0..3 {
            let [a, b, c] = [0, 1, 2].map(|k| at(triangle[(i + k) % 3]));
            normal_at[triangle[i] as usize] += normals[number] * (b - a).angle_between(c - a);
        }
    }
    // The least that an edge rises from each corner, and falls, as a sine.
    let mut rise = vec![f32::INFINITY; points.len()];
    let mut fall = vec![f32::INFINITY; points.len()];
    let mut is_border = vec![false; points.len()];
    for (&[a, b], sides) in &sides {
        for (from, to) in [(a, b), (b, a)] {
            let steep = (at(to) - at(from)).normalize_or_zero().dot(normal_at[from as usize].normalize_or_zero());
            rise[from as usize] = rise[from as usize].min(steep);
            fall[from as usize] = fall[from as usize].min(-steep);
            is_border[from as usize] |= sides.len() != 2;
        }
    }
    let sharp_corner = |i: usize| match (is_border[i], is_closed) {
        (true, _) => 1.0,
        (false, true) => fall[i].max(0.0),
        (false, false) => fall[i].max(rise[i]).max(0.0),
    };
    let sharp_edge = |[a, b]: [u32; 2]| {
        let &[one, other] = sides[&[a.min(b), a.max(b)]].as_slice() else { return 1.0 };
        let sine = ((1.0 - normals[one].dot(normals[other])) / 2.0).max(0.0).sqrt();
        let beyond = surface.triangles[other].into_iter().find(|&i| i != a && i != b);
        let falls_off = beyond.is_some_and(|i| (at(i) - at(a)).dot(normals[one]) < 0.0);
        if falls_off || !is_closed { sine } else { 0.0 }
    };
    let sharp: Vec<Representative> = surface
        .triangles
        .iter()
        .map(|&triangle| Representative {
            corners: triangle.map(|i| sharp_corner(i as usize)),
            edges: edges_of(triangle).map(sharp_edge),
        })
        .collect();
    surface.blunt(&sharp);
}
