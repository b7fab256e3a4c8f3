//! Meshes with a skin, and sheets in rows and columns to make them of.

use bevy::math::{Vec2, Vec3};

use super::skin::Influences;

/// A mesh of one or more primitives.
pub struct Model {
    pub name: &'static str,
    pub primitives: Vec<Primitive>,
    /// The node's extras.
    pub extras: serde_json::Value,
}

/// Triangles of one material.
#[derive(Default)]
pub struct Primitive {
    /// Its number among the materials of the file.
    pub material: usize,
    pub positions: Vec<[f32; 3]>,
    pub normals: Vec<[f32; 3]>,
    /// Empty, or one for each vertex, as the next.
    pub uvs: Vec<[f32; 2]>,
    pub looseness: Vec<[f32; 1]>,
    pub joints: Vec<[u8; 4]>,
    pub weights: Vec<[u16; 4]>,
    pub indices: Vec<u16>,
}

/// A vertex of a garment.
#[derive(Clone, Copy)]
pub struct Vertex {
    pub position: Vec3,
    pub uv: Vec2,
    /// The attribute `_CLOTH`: 0 where it is held by the skin, 1 where it hangs freely.
    pub looseness: f32,
    pub skin: Influences,
}

impl Primitive {
    pub fn push(&mut self, vertex: &Vertex, normal: Vec3) {
        self.positions.push(vertex.position.to_array());
        self.normals.push(normal.to_array());
        self.uvs.push(vertex.uv.to_array());
        self.looseness.push([vertex.looseness]);
        self.push_skin(vertex.skin);
    }

    pub fn push_skin(&mut self, skin: Influences) {
        self.joints.push(skin.joints);
        self.weights.push(skin.weights);
    }
}

/// Vertices in rows and columns, which are seen from outside from left to right and from the top down.
pub struct Sheet {
    pub columns: usize,
    pub vertices: Vec<Vertex>,
    /// Whether the last column lies on the first.
    pub is_closed: bool,
}

impl Sheet {
    pub fn rows(&self) -> usize {
        self.vertices.len() / self.columns
    }

    pub fn position(&self, row: usize, column: usize) -> Vec3 {
        self.vertices[row * self.columns + column].position
    }

    /// Two triangles a quad: neighbours are cut along opposite diagonals, so that the cloth prefers neither.
    pub fn triangles(&self, rows: core::ops::Range<usize>) -> Vec<[usize; 3]> {
        let mut triangles = Vec::new();
        for row in rows {
            for column in 0..self.columns - 1 {
                let a = row * self.columns + column;
                let [b, c, d] = [a + 1, a + self.columns, a + self.columns + 1];
                let is_even = (row + column).is_multiple_of(2);
                triangles.extend(if is_even { [[a, c, d], [a, d, b]] } else { [[a, c, b], [b, c, d]] });
            }
        }
        triangles
    }

    /// From the neighbours along rows and columns, so that both sides of a seam have the same.
    pub fn normals(&self) -> Vec<Vec3> {
        let (rows, columns) = (self.rows(), self.columns);
        let normal = |index: usize| {
            let (row, column) = (index / columns, index % columns);
            let (left, right) = match (self.is_closed, column) {
                (true, 0) => (columns - 2, 1),
                (true, _) if column == columns - 1 => (columns - 2, 1),
                _ => (column.saturating_sub(1), (column + 1).min(columns - 1)),
            };
            let (up, down) = (row.saturating_sub(1), (row + 1).min(rows - 1));
            let rightwards = self.position(row, right) - self.position(row, left);
            let upwards = self.position(up, column) - self.position(down, column);
            rightwards.cross(upwards).normalize()
        };
        (0..self.vertices.len()).map(normal).collect()
    }

    /// All of it as one primitive.
    pub fn primitive(&self, material: usize) -> Primitive {
        let mut primitive = Primitive { material, ..Primitive::default() };
        for (vertex, normal) in self.vertices.iter().zip(self.normals()) {
            primitive.push(vertex, normal);
        }
        let triangles = self.triangles(0..self.rows() - 1);
        primitive.indices = triangles.as_flattened().iter().map(|&index| index as u16).collect();
        primitive
    }
}

/// A part of a whole, from 0 to 1.
pub fn fraction(part: usize, whole: usize) -> f32 {
    part as f32 / whole as f32
}
