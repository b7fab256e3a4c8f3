//! A mesh out of a binary glTF file.

use std::{fs, path::Path};

use bevy::prelude::*;
use gltf::{Document, Gltf, Node, accessor::DataType, buffer::Source, mesh::Mode};

use super::{Sheet, Top};

/// The top of a mesh that may have no straight edge there, as a share of its extent.
const DEPTH: f32 = 0.02;

/// A mesh that is lower than this (m) once it is scaled lies flat.
const FLAT: f32 = 0.01;

/// Reads the triangles of the first mesh of the file's scene, as they stand there, and scales and centres them: their
/// largest extent becomes 1 m. What lies flat hangs by its edge at -Z, as the square does; else the top is where it is
/// highest.
pub fn sheet(path: &Path) -> Result<Sheet, String> {
    let file = fs::read(path).map_err(|error| error.to_string())?;
    let Gltf { document, blob } =
        Gltf::from_slice(&file).map_err(|error| format!("it can't be read as glTF ({error})"))?;
    let (node, pose) = first_mesh(&document).ok_or("its scene has no mesh")?;
    let mut parts = Parts::default();
    for primitive in node.mesh().iter().flat_map(gltf::Mesh::primitives).filter(|p| p.mode() == Mode::Triangles) {
        parts.add(&primitive, blob.as_deref())?;
    }
    parts.finish(pose)
}

/// The first node with a mesh, and how it stands in the scene.
fn first_mesh(document: &Document) -> Option<(Node<'_>, Mat4)> {
    let scene = document.default_scene().or_else(|| document.scenes().next())?;
    scene.nodes().find_map(|node| find_mesh(node, Mat4::IDENTITY))
}

fn find_mesh(node: Node<'_>, parent: Mat4) -> Option<(Node<'_>, Mat4)> {
    let pose = parent * Mat4::from_cols_array_2d(&node.transform().matrix());
    if node.mesh().is_some() {
        return Some((node, pose));
    }
    node.children().find_map(|child| find_mesh(child, pose))
}

/// The parts of a mesh, one after the other.
#[derive(Default)]
struct Parts {
    positions: Vec<Vec3>,
    uvs: Vec<Vec2>,
    triangles: Vec<[u32; 3]>,
}

impl Parts {
    fn add(&mut self, primitive: &gltf::Primitive, blob: Option<&[u8]>) -> Result<(), String> {
        let reader = primitive.reader(|buffer| match buffer.source() {
            Source::Bin => blob,
            Source::Uri(_) => None,
        });
        let positions = reader.read_positions().ok_or("it doesn't hold the positions that it speaks of")?;
        let first = self.positions.len() as u32;
        self.positions.extend(positions.map(Vec3::from));
        let count = self.positions.len() as u32 - first;
        if let Some(uvs) = reader.read_tex_coords(0) {
            self.uvs.extend(uvs.into_f32().map(Vec2::from));
        }
        let indices: Vec<u32> = match primitive.indices().map(|accessor| accessor.data_type()) {
            None => (0..count).collect(),
            // The reader takes whole numbers for granted.
            Some(DataType::U8 | DataType::U16 | DataType::U32) => {
                reader.read_indices().ok_or("it doesn't hold the indices that it speaks of")?.into_u32().collect()
            }
            Some(_) => return Err("its indices are no whole numbers".into()),
        };
        self.triangles.extend(indices.as_chunks().0.iter().map(|triangle| triangle.map(|index| first + index)));
        Ok(())
    }

    fn finish(mut self, pose: Mat4) -> Result<Sheet, String> {
        let place = |p: &Vec3| pose.transform_point3(*p);
        let (low, high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let (low, high) = self.positions.iter().map(place).fold((low, high), |(l, h), p| (l.min(p), h.max(p)));
        let extent = (high - low).max_element();
        if !(extent.is_finite() && extent > 0.0) {
            return Err("its first mesh has no triangles, or no size".into());
        }
        let centred = |p: &Vec3| (place(p) - 0.5 * (low + high)) / extent;
        self.positions = self.positions.iter().map(centred).collect();
        let uvs = (self.uvs.len() == self.positions.len()).then_some(self.uvs);
        let mesh = super::assemble(self.positions, uvs, &self.triangles);
        let is_flat = (high.y - low.y) / extent < FLAT;
        let direction = if is_flat { Vec3::NEG_Z } else { Vec3::Y };
        Ok(Sheet { mesh, top: Top { direction, depth: DEPTH, is_ring: false } })
    }
}
