//! How render vertices hang on particles, and which of them share a normal or a tangent. Immutable, shared.

use std::sync::Arc;

use bevy::{platform::collections::HashMap, prelude::*};

use crate::solver::{SourceMesh, Welded};

/// Normals that round to the same multiples of this are one: a smooth surface rather than a hard edge.
const SAME_NORMAL: f32 = 0.02;

/// From particles to the vertices of a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Binding {
    /// Particle of each vertex, or [`NO_PARTICLE`](crate::solver::build::weld::NO_PARTICLE).
    pub particle_of_vertex: Arc<[u32]>,
    /// The mesh's own triangles, as vertices.
    pub triangles: Vec<[u32; 3]>,
    /// For a mesh that has normals: which of them each vertex shows.
    pub normals: Option<Groups>,
    /// For a mesh that has tangents: which of them each vertex shows, and how they follow from the triangles.
    pub tangents: Option<Tangents>,
}

/// Vertices that show one and the same direction.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Groups {
    /// Group of each vertex.
    pub of_vertex: Vec<u32>,
    /// Number of groups.
    pub count: usize,
}

/// Tangents and how they follow.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Tangents {
    /// Which tangent each vertex shows.
    pub groups: Groups,
    /// Handedness of each vertex, 1 or -1.
    pub sign: Vec<f32>,
    /// The direction of growing u in each triangle is `x` times its first side plus `y` times its second.
    pub along: Vec<Vec2>,
}

impl Binding {
    /// Binds the vertices of `source` to the particles of `welded`.
    ///
    /// Vertices of one particle share a normal where the mesh gave them the same one: shading stays smooth across UV
    /// seams and hard across hard edges.
    pub fn new(source: &SourceMesh, welded: &Welded) -> Self {
        let particles = &welded.particle_of_vertex;
        let normals = source
            .normals
            .as_ref()
            .map(|normals| group(particles, |vertex| (normals[vertex] / SAME_NORMAL).round().as_ivec3().to_array()));
        let tangents = match (&normals, &source.tangents, &source.uvs) {
            (Some(normals), Some(tangents), Some(uvs)) => Some(Tangents {
                // Mirrored halves of a texture meet in vertices that differ in handedness only.
                groups: group(&normals.of_vertex, |vertex| [(tangents[vertex].w < 0.0) as i32, 0, 0]),
                sign: tangents.iter().map(|tangent| 1.0_f32.copysign(tangent.w)).collect(),
                along: source.triangles.iter().map(|&triangle| along_u(uvs, triangle)).collect(),
            }),
            _ => None,
        };
        Self { particle_of_vertex: particles.as_slice().into(), triangles: source.triangles.clone(), normals, tangents }
    }
}

/// Numbers the distinct pairs of `class` and `key` of all vertices.
fn group(class: &[u32], key: impl Fn(usize) -> [i32; 3]) -> Groups {
    let mut numbers = HashMap::new();
    let of_vertex = (0..class.len())
        .map(|vertex| {
            let next = numbers.len() as u32;
            *numbers.entry((class[vertex], key(vertex))).or_insert(next)
        })
        .collect();
    Groups { of_vertex, count: numbers.len() }
}

/// Direction of growing u in terms of a triangle's sides: solves du = x du1 + y du2 = 1, dv = x dv1 + y dv2 = 0.
fn along_u(uvs: &[Vec2], triangle: [u32; 3]) -> Vec2 {
    let [a, b, c] = triangle.map(|i| uvs[i as usize]);
    let (first, second) = (b - a, c - a);
    let area = first.perp_dot(second);
    if area == 0.0 { Vec2::ZERO } else { Vec2::new(second.y, -first.y) / area }
}
