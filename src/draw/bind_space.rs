//! Drawing in bind space: cloth on a skeleton is written so that the renderer's skinning puts it where it is.
//!
//! A vertex that is pinned to the skin keeps its place, joints and weights: it is drawn bit for bit as the body beside it. Any
//! other is bound to one joint alone, the strongest of its own, and written with the inverse of what that does.

use core::ops::Range;

use bevy::{
    math::{Affine3A, Mat3A, Vec3A},
    prelude::*,
};

use crate::{frame::joint_matrices, mesh_input::Skin, solver::build::weld::NO_PARTICLE, state::BoundSkin};

/// What takes vertices into bind space.
#[derive(Clone, Debug, Default)]
pub(super) struct BindSpace {
    /// What the joints do to the mesh by now, relative to `place`, and back.
    matrices: Vec<Affine3A>,
    inverses: Vec<Affine3A>,
    /// Place of the first joint, m.
    pub place: Vec3A,
    /// What they did when it was read before, and whether that differs.
    latest: Vec<Affine3A>,
    pub has_moved: bool,
    /// Whether the skin alone draws each particle.
    is_pinned: Vec<bool>,
    /// The mesh asset doesn't have the joints of all vertices yet.
    pub is_new: bool,
    /// Vertices relative to `place`, in the axes of the world.
    pub positions: Vec<[f32; 3]>,
}

impl BindSpace {
    /// Reads where the joints are by now. False where one is missing, or flat.
    pub fn read_joints(&mut self, bound: &BoundSkin, poses: &Query<&GlobalTransform>) -> bool {
        let pose = |joint| poses.get(joint).ok().map(GlobalTransform::affine);
        let Some(place) = joint_matrices(&bound.joints, &bound.bindposes, pose, &mut self.matrices) else {
            return false;
        };
        self.has_moved = self.place != place || self.latest != self.matrices;
        self.latest.clone_from(&self.matrices);
        self.place = place;
        self.inverses.clear();
        self.inverses.extend(self.matrices.iter().map(Affine3A::inverse));
        // A joint of no size, as that of a head that is hidden, matters only to what is bound to it.
        self.matrices.len() >= bound.vertices.joint_count
            && self.matrices.iter().all(|matrix| matrix.is_finite())
            && bound.strongest.iter().all(|&joint| self.inverses[usize::from(joint)].is_finite())
    }

    /// Takes note of which of so many particles are pinned to the skin.
    pub fn note_pins(&mut self, on_skin: impl Iterator<Item = usize> + Clone, count: usize) {
        let is_known = self.is_pinned.len() == count
            && on_skin.clone().all(|particle| self.is_pinned[particle])
            && on_skin.clone().count() == self.is_pinned.iter().filter(|pinned| **pinned).count();
        if !is_known {
            self.is_pinned.clear();
            self.is_pinned.resize(count, false);
            on_skin.for_each(|particle| self.is_pinned[particle] = true);
            self.is_new = true;
        }
    }

    /// Whether the skin alone draws a particle.
    pub fn is_pinned(&self, particle: u32) -> bool {
        self.is_pinned.get(particle as usize).copied().unwrap_or_default()
    }

    /// Whether the skin alone draws a vertex of a particle, or of none.
    fn is_skinned(&self, particle: u32) -> bool {
        particle == NO_PARTICLE || self.is_pinned[particle as usize]
    }

    /// Writes positions in bind space.
    pub fn write_positions(&self, skin: &Skin, particle_of_vertex: &[u32], positions: &mut [[f32; 3]]) {
        let vertices = skin.points().iter().zip(particle_of_vertex).zip(&self.positions);
        for (((point, &particle), &place), position) in vertices.zip(positions) {
            *position = match self.is_skinned(particle) {
                true => point.place.to_array(),
                false => self.inverses[usize::from(point.strongest())].transform_point3a(place.into()).to_array(),
            };
        }
    }

    /// Takes normals and tangents into bind space. The renderer turns normals by the inverse transpose of what it does to
    /// positions, and tangents as positions.
    pub fn write_directions(
        &self,
        skin: &Skin,
        particle_of_vertex: &[u32],
        normals: &mut [[f32; 3]],
        tangents: &mut [[f32; 4]],
    ) {
        let matrix = |vertex: usize| {
            let point = &skin.points()[vertex];
            match self.is_skinned(particle_of_vertex[vertex]) {
                true => point.matrix(&self.matrices),
                false => self.matrices[usize::from(point.strongest())].matrix3,
            }
        };
        for (vertex, normal) in normals.iter_mut().enumerate() {
            *normal = (matrix(vertex).transpose() * Vec3A::from(*normal)).normalize_or(Vec3A::Y).to_array();
        }
        for (vertex, tangent) in tangents.iter_mut().enumerate() {
            let [x, y, z, sign] = *tangent;
            let inverse = inverse(matrix(vertex));
            *tangent = (inverse * Vec3A::new(x, y, z)).normalize_or(Vec3A::X).extend(sign).to_array();
        }
    }

    /// Joints and weights by which each of some vertices is drawn.
    pub fn influences<'a>(
        &'a self,
        skin: &'a Skin,
        particle_of_vertex: &'a [u32],
        span: &Range<usize>,
    ) -> impl Iterator<Item = ([u16; 4], [f32; 4])> + 'a {
        let vertices = skin.points().iter().zip(particle_of_vertex);
        vertices.take(span.end).skip(span.start).map(|(point, &particle)| match self.is_skinned(particle) {
            true => (point.joints, point.weights),
            false => ([point.strongest(), 0, 0, 0], [1.0, 0.0, 0.0, 0.0]),
        })
    }
}

/// The inverse of a blend of joints, which may be flat where each joint isn't.
fn inverse(matrix: Mat3A) -> Mat3A {
    let inverse = matrix.inverse();
    if inverse.is_finite() { inverse } else { Mat3A::IDENTITY }
}
