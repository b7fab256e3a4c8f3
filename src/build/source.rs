//! Reads what cloth needs out of a `Mesh`, or says why that can't be done.

use bevy::{
    mesh::{Indices, MeshAccessError, MeshVertexAttribute, PrimitiveTopology, VertexAttributeValues},
    prelude::*,
};

use super::grain::ATTRIBUTE_WARP;
use crate::error::ClothError;

/// The geometry of a mesh, checked.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct SourceMesh {
    /// Position of each vertex in the mesh's own space; all finite.
    pub positions: Vec<Vec3>,
    /// Vertices of each triangle; all in range.
    pub triangles: Vec<[u32; 3]>,
    /// Normal of each vertex, where the mesh has them.
    pub normals: Option<Vec<Vec3>>,
    /// First UV of each vertex, where the mesh has them.
    pub uvs: Option<Vec<Vec2>>,
    /// Direction of the warp at each vertex, where the mesh has it.
    pub warp: Option<Vec<Vec3>>,
    /// Tangent of each vertex with its handedness, where the mesh has them.
    pub tangents: Option<Vec<Vec4>>,
}

impl SourceMesh {
    /// Reads and checks `mesh`.
    pub fn read(mesh: &Mesh) -> Result<Self, ClothError> {
        let positions = read_positions(mesh)?;
        let triangles = read_triangles(mesh, positions.len())?;
        let directions = |attribute| match per_vertex(mesh, attribute) {
            Some(VertexAttributeValues::Float32x3(values)) => Some(values.iter().copied().map(Vec3::from).collect()),
            _ => None,
        };
        let tangents = match per_vertex(mesh, Mesh::ATTRIBUTE_TANGENT) {
            Some(VertexAttributeValues::Float32x4(values)) => Some(values.iter().copied().map(Vec4::from).collect()),
            _ => None,
        };
        let (normals, warp) = (directions(Mesh::ATTRIBUTE_NORMAL), directions(ATTRIBUTE_WARP));
        Ok(Self { positions, triangles, normals, uvs: read_uvs(mesh), warp, tangents })
    }

    /// Winds each triangle so that it faces the side that the normals of its corners face, by their sum.
    ///
    /// A mesh is shown by its own normals, however its triangles are wound: some exporters turn single ones over, or write
    /// each twice, once from either side. What is worked out from triangles would cancel out there.
    pub fn wound_by_normals(mut self) -> Self {
        let Some(normals) = &self.normals else { return self };
        for triangle in &mut self.triangles {
            let [a, b, c] = triangle.map(|i| self.positions[i as usize]);
            let faced: Vec3 = triangle.iter().map(|&i| normals[i as usize].normalize_or_zero()).sum();
            if (b - a).cross(c - a).dot(faced) < 0.0 {
                triangle.swap(1, 2);
            }
        }
        self
    }
}

/// The first UV of each vertex, where the mesh has them.
pub(crate) fn read_uvs(mesh: &Mesh) -> Option<Vec<Vec2>> {
    match per_vertex(mesh, Mesh::ATTRIBUTE_UV_0) {
        Some(VertexAttributeValues::Float32x2(values)) => Some(values.iter().copied().map(Vec2::from).collect()),
        _ => None,
    }
}

/// The values of an attribute that has one for each position: Bevy doesn't check that.
fn per_vertex(mesh: &Mesh, attribute: MeshVertexAttribute) -> Option<&VertexAttributeValues> {
    let count = mesh.try_attribute(Mesh::ATTRIBUTE_POSITION).ok()?.len();
    mesh.try_attribute(attribute).ok().filter(|values| values.len() == count)
}

fn read_positions(mesh: &Mesh) -> Result<Vec<Vec3>, ClothError> {
    let positions: Vec<Vec3> = match mesh.try_attribute(Mesh::ATTRIBUTE_POSITION) {
        Ok(VertexAttributeValues::Float32x3(values)) => values.iter().copied().map(Vec3::from).collect(),
        Err(MeshAccessError::ExtractedToRenderWorld) => return Err(ClothError::NotInMainWorld),
        _ => return Err(ClothError::NoPositions),
    };
    match positions.iter().position(|p| !p.is_finite()) {
        Some(vertex) => Err(ClothError::PositionNotFinite { vertex: vertex as u32 }),
        None => Ok(positions),
    }
}

fn read_triangles(mesh: &Mesh, vertex_count: usize) -> Result<Vec<[u32; 3]>, ClothError> {
    let indices: Vec<u32> = match mesh.try_indices() {
        Ok(Indices::U16(indices)) => indices.iter().map(|&i| i.into()).collect(),
        Ok(Indices::U32(indices)) => indices.clone(),
        Err(MeshAccessError::ExtractedToRenderWorld) => return Err(ClothError::NotInMainWorld),
        Err(MeshAccessError::NotFound) => (0..vertex_count as u32).collect(),
    };
    if let Some(&vertex) = indices.iter().find(|&&i| i as usize >= vertex_count) {
        return Err(ClothError::IndexOutOfRange { vertex, count: vertex_count as u32 });
    }
    match mesh.primitive_topology() {
        PrimitiveTopology::TriangleList => Ok(indices.as_chunks().0.to_vec()),
        PrimitiveTopology::TriangleStrip => Ok(indices
            .array_windows()
            .enumerate()
            // Every other triangle of a strip is wound the other way.
            .map(|(i, &[a, b, c])| if i % 2 == 0 { [a, b, c] } else { [a, c, b] })
            .collect()),
        other => Err(ClothError::NotTriangles { topology: format!("{other:?}") }),
    }
}
