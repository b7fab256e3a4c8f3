//! Reads what cloth needs out of a `Mesh`, or says why that can't be done.

use bevy::{
    mesh::{Indices, MeshAccessError, MeshVertexAttribute, PrimitiveTopology, VertexAttributeValues, VertexFormat},
    prelude::*,
};

use crate::{error::ClothError, solver::SourceMesh};

/// The vertex attribute that says which way the warp of a model runs: a direction in the mesh's own space, of any length.
///
/// In glTF files its name is `_WARP`, a vector in any format. Without the feature `gltf`, register it with Bevy's plugin, which drops
/// the underscore: `GltfPlugin::default().add_custom_vertex_attribute("WARP", ATTRIBUTE_WARP)`.
pub const ATTRIBUTE_WARP: MeshVertexAttribute =
    MeshVertexAttribute::new("Warp", 0x6472_6170_6557, VertexFormat::Float32x3);

/// Reads and checks the geometry of `mesh`.
pub(crate) fn read(mesh: &Mesh) -> Result<SourceMesh, ClothError> {
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
    let source = SourceMesh { positions, triangles, normals, uvs: read_uvs(mesh), warp, tangents };
    source.check()?;
    Ok(source)
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

pub(super) fn read_positions(mesh: &Mesh) -> Result<Vec<Vec3>, ClothError> {
    match mesh.try_attribute(Mesh::ATTRIBUTE_POSITION) {
        Ok(VertexAttributeValues::Float32x3(values)) => Ok(values.iter().copied().map(Vec3::from).collect()),
        Err(MeshAccessError::ExtractedToRenderWorld) => Err(ClothError::NotInMainWorld),
        _ => Err(ClothError::NoPositions),
    }
}

pub(super) fn read_triangles(mesh: &Mesh, vertex_count: usize) -> Result<Vec<[u32; 3]>, ClothError> {
    let indices: Vec<u32> = match mesh.try_indices() {
        Ok(Indices::U16(indices)) => indices.iter().map(|&i| i.into()).collect(),
        Ok(Indices::U32(indices)) => indices.clone(),
        Err(MeshAccessError::ExtractedToRenderWorld) => return Err(ClothError::NotInMainWorld),
        Err(MeshAccessError::NotFound) => (0..vertex_count as u32).collect(),
    };
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
