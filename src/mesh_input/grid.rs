//! A helper that makes the mesh of a flag, a curtain or a tablecloth.

use bevy::{
    asset::RenderAssetUsages,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};

use crate::solver::SourceMesh;

/// A rectangle of particles, a mesh to put cloth on.
///
/// It lies in the XY plane, centred, facing +Z, with the top edge at +Y: a curtain or a flag. [`lying`](Self::lying)
/// turns it into the XZ plane, facing up, with the top edge at -Z: a tablecloth. Vertices go row by row from the top
/// left; UVs from (0, 0) there to (1, 1) at the bottom right. The diagonals alternate from cell to cell, so that no
/// direction is drawn differently from another.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Debug, Clone, PartialEq)]
pub struct ClothGrid {
    /// Width and height, m.
    pub size: Vec2,
    /// Particles along the width and the height, at least 2 each.
    pub particles: UVec2,
    /// In the XZ plane instead of the XY plane.
    pub lying: bool,
}

impl ClothGrid {
    /// An upright rectangle of `width` x `height` metres with `columns` x `rows` particles.
    pub fn new(width: f32, height: f32, columns: u32, rows: u32) -> Self {
        Self { size: Vec2::new(width, height), particles: UVec2::new(columns, rows), lying: false }
    }

    /// Lays the rectangle into the XZ plane, facing up.
    pub fn lying(mut self) -> Self {
        self.lying = true;
        self
    }

    /// Index of the vertex, and of the particle, at a place in the grid.
    pub fn vertex(&self, column: u32, row: u32) -> u32 {
        row * self.particles.x.max(2) + column
    }
}

impl From<ClothGrid> for Mesh {
    fn from(grid: ClothGrid) -> Self {
        let SourceMesh { positions, triangles, normals, uvs, .. } =
            SourceMesh::grid(grid.size, grid.particles, grid.lying);
        let vectors = |values: Vec<Vec3>| -> Vec<[f32; 3]> { values.iter().map(Vec3::to_array).collect() };
        let uvs: Vec<[f32; 2]> = uvs.iter().flatten().map(Vec2::to_array).collect();
        Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, vectors(positions))
            .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vectors(normals.unwrap_or_default()))
            .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs)
            .with_inserted_indices(Indices::U32(triangles.into_flattened()))
    }
}
