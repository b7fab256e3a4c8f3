//! The geometry that a cloth is built from.

use bevy_math::{UVec2, Vec2, Vec3, Vec4};

use super::MeshError;

/// The geometry of a triangle mesh that is to be cloth.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SourceMesh {
    /// Position of each vertex in the mesh's own space.
    pub positions: Vec<Vec3>,
    /// Vertices of each triangle.
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
    /// A rectangle of `size` (m, width and height) with as many vertices along each side as `vertices` says, 2 at least.
    ///
    /// It stands in the XY plane, centred, facing +Z with its top at +Y, or lies in the XZ plane, facing up with its top at
    /// -Z. Vertices go row by row from the top left; UVs from (0, 0) there to (1, 1) at the bottom right. The diagonals
    /// alternate from cell to cell, so that no direction is drawn differently from another.
    pub fn grid(size: Vec2, vertices: UVec2, is_lying: bool) -> Self {
        let counts = vertices.max(UVec2::splat(2));
        let [columns, rows] = counts.to_array();
        let places = (0..rows).flat_map(|row| (0..columns).map(move |column| UVec2::new(column, row)));
        let uvs: Vec<Vec2> = places.map(|place| place.as_vec2() / (counts - 1).as_vec2()).collect();
        let position = |&uv: &Vec2| {
            let across = (uv - 0.5) * size;
            if is_lying { Vec3::new(across.x, 0.0, across.y) } else { Vec3::new(across.x, -across.y, 0.0) }
        };
        let positions: Vec<Vec3> = uvs.iter().map(position).collect();
        let normals = vec![if is_lying { Vec3::Y } else { Vec3::Z }; positions.len()];
        let cells = (0..rows - 1).flat_map(|row| (0..columns - 1).map(move |column| (column, row)));
        let triangles = cells.flat_map(|(column, row)| {
            let a = row * columns + column;
            let [b, c, d] = [a + 1, a + columns, a + columns + 1];
            if (row + column) % 2 == 0 { [[a, c, b], [b, c, d]] } else { [[a, c, d], [a, d, b]] }
        });
        Self { triangles: triangles.collect(), positions, normals: Some(normals), uvs: Some(uvs), ..Self::default() }
    }

    /// Checks that all positions are finite, all triangles between vertices that exist, and each attribute has a value for
    /// each vertex.
    ///
    /// # Errors
    ///
    /// A [`MeshError`] with what is wrong first.
    pub fn check(&self) -> Result<(), MeshError> {
        let count = self.positions.len() as u32;
        if let Some(vertex) = self.positions.iter().position(|position| !position.is_finite()) {
            return Err(MeshError::PositionNotFinite { vertex: vertex as u32 });
        }
        if let Some(&vertex) = self.triangles.as_flattened().iter().find(|&&vertex| vertex >= count) {
            return Err(MeshError::IndexOutOfRange { vertex, count });
        }
        let lengths = [
            self.normals.as_ref().map(Vec::len),
            self.uvs.as_ref().map(Vec::len),
            self.warp.as_ref().map(Vec::len),
            self.tangents.as_ref().map(Vec::len),
        ];
        match lengths.into_iter().flatten().find(|&length| length != self.positions.len()) {
            Some(values) => Err(MeshError::AttributeLength { values: values as u32, count }),
            None => Ok(()),
        }
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
