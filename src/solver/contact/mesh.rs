//! Obstacles of triangles: meshes, convex hulls and height fields.

use std::sync::Arc;

use bevy::math::Vec3A;

/// Triangles that cloth can't pass, prepared for contact. Built once and shared.
#[derive(Clone, Debug, PartialEq)]
pub struct TriangleMesh {
    /// Points, m, in the obstacle's own frame.
    pub points: Vec<Vec3A>,
    /// Corners of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Whether the triangles enclose a volume and all face out of it: cloth is then kept outside. Else they are thin, and
    /// cloth stays on the side that it comes from.
    pub is_closed: bool,
}

/// A triangle mesh as an obstacle within one step.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshShape {
    /// The mesh.
    pub mesh: Arc<TriangleMesh>,
    /// Its points at the start and at the end of the step, where they move within the obstacle's frame: of a skinned
    /// mesh.
    pub deformed: Option<[Arc<[Vec3A]>; 2]>,
}
