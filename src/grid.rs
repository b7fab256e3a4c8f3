//! A helper that makes the mesh of a flag, a curtain or a tablecloth.

use bevy::{
    asset::RenderAssetUsages,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};

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

    /// The same, lying in the XZ plane and facing up.
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
        let UVec2 { x: columns, y: rows } = grid.particles.max(UVec2::splat(2));
        let grid = ClothGrid { particles: UVec2::new(columns, rows), ..grid };
        let mut positions = Vec::new();
        let mut uvs = Vec::new();
        for row in 0..rows {
            for column in 0..columns {
                let uv = UVec2::new(column, row).as_vec2() / (grid.particles - 1).as_vec2();
                let across = (uv - 0.5) * grid.size;
                positions.push(if grid.lying { [across.x, 0.0, across.y] } else { [across.x, -across.y, 0.0] });
                uvs.push(uv.to_array());
            }
        }
        let normal = if grid.lying { Vec3::Y } else { Vec3::Z };
        let normals = vec![normal.to_array(); positions.len()];
        Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
            .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
            .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs)
            .with_inserted_indices(Indices::U32(indices(&grid)))
    }
}

/// Corners of all triangles of a grid.
pub(crate) fn indices(grid: &ClothGrid) -> Vec<u32> {
    let mut indices = Vec::new();
    for row in 0..grid.particles.y - 1 {
        for column in 0..grid.particles.x - 1 {
            let a = grid.vertex(column, row);
            let b = grid.vertex(column + 1, row);
            let c = grid.vertex(column, row + 1);
            let d = grid.vertex(column + 1, row + 1);
            indices.extend(if (row + column) % 2 == 0 { [a, c, b, b, c, d] } else { [a, c, d, a, d, b] });
        }
    }
    indices
}
