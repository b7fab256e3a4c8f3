//! Binds cloth to the skeleton of its mesh.

use bevy::{
    math::{Affine3A, Mat3A},
    mesh::skinning::SkinnedMesh,
    prelude::*,
};

use super::{candidate::CandidateItem, plan::Plan};
use crate::{
    error::ClothError,
    frame::Skeletons,
    mesh_input::Skin,
    pins::PinTarget,
    skin::ParticleLimits,
    solver::{SkinLimit, build::weld::NO_PARTICLE},
    state::{BoundSkin, ClothState},
};

impl CandidateItem<'_, '_> {
    /// Binds the cloth to its skeleton, and adds what its [`ClothSkin`] fixes there to the `targets`.
    pub(super) fn bind(
        &mut self,
        mesh: &Mesh,
        plan: &Plan,
        (joints, bindposes): (&[Entity], &[Mat4]),
        targets: &mut [PinTarget],
        skeletons: &Skeletons,
    ) -> Result<BoundSkin, ClothError> {
        let positions: Vec<Vec3> = plan.positions.iter().copied().map(Vec3::from).collect();
        let particles = first_vertices(&plan.binding.particle_of_vertex, plan.topology.particle_count());
        let all: Vec<u32> = (0..positions.len() as u32).collect();
        let read = |vertices: &[u32]| Skin::read(mesh, &positions, vertices);
        let lost = |needed| ClothError::Skeleton { needed, found: joints.len().min(bindposes.len()) };
        let skins = read(&particles).zip(read(&all)).ok_or(lost(1))?;
        let needed = skins.0.joint_count.max(skins.1.joint_count);
        let settings = self.skin.as_deref().cloned().unwrap_or_default();
        settings.validate()?;
        let limits = settings.limits(mesh, &plan.binding.particle_of_vertex, plan.topology.particle_count());
        limits.fix(targets);
        let held = |particle: usize| targets[particle] == PinTarget::Cloth;
        let mut bound = BoundSkin::new(skins, (joints, bindposes), held, skeletons).ok_or(lost(needed))?;
        bound.settings = settings;
        bound.limit(&limits.limits, &plan.topology);
        self.warn_of_skin(&limits, targets);
        Ok(bound)
    }

    /// Warns once of paint that is no distance, and of clothes that nothing holds.
    fn warn_of_skin(&mut self, limits: &ParticleLimits, targets: &[PinTarget]) {
        if let Some(vertex) = limits.badly_painted
            && !core::mem::replace(&mut self.warned.paint, true)
        {
            warn!(
                "cloth {}: what is painted as _CLOTH on vertex {vertex} is no distance; it counts as 0, which is fixed to the \
                 skeleton; paint 0 or more",
                self.entity
            );
        }
        let holds = |limit: &SkinLimit| limit.max_distance < f32::INFINITY;
        let is_held = limits.limits.iter().any(holds) || targets.iter().any(|target| *target != PinTarget::Free);
        if !is_held && !core::mem::replace(&mut self.warned.falls_off, true) {
            warn!(
                "cloth {} would fall off its skeleton: no vertex is pinned or limited; give it Pins, paint _CLOTH, or set \
                 ClothSkin::max_distance",
                self.entity
            );
        }
    }
}

/// Puts a cloth where its skeleton has it.
pub(super) fn wear(state: &mut ClothState, bound: &mut BoundSkin) {
    let Some(pose) = bound.pose() else { return };
    state.pose = pose;
    state.origin = pose.translation.into();
    bound.advance(&state.topology, state.origin, true);
    if bound.places().iter().all(|place| place.is_finite()) {
        state.particles.position.copy_from_slice(bound.places());
        state.step_start.copy_from_slice(bound.places());
    }
}

/// The transform that a skinned mesh is built at: the scale that the first joint gives it, in the axes of the mesh.
pub(super) fn at_scale_of(
    skeleton: &SkinnedMesh,
    bindposes: &[Mat4],
    skeletons: &Skeletons,
) -> Result<Affine3A, ClothError> {
    let lost = ClothError::Skeleton { needed: skeleton.joints.len().max(1), found: 0 };
    let joint = skeleton.joints.first().and_then(|&joint| skeletons.pose(joint)).ok_or(lost.clone())?;
    let pose = joint * bindposes.first().map_or(Affine3A::IDENTITY, |&bindpose| Affine3A::from_mat4(bindpose));
    let scale = pose.is_finite().then(|| pose.matrix3.determinant().abs().cbrt()).filter(|scale| scale.is_normal());
    scale.map(|scale| Affine3A { matrix3: Mat3A::from_diagonal(Vec3::splat(scale)), ..pose }).ok_or(lost)
}

/// A vertex of each particle: the first.
fn first_vertices(particle_of_vertex: &[u32], count: usize) -> Vec<u32> {
    let mut vertices = vec![0; count];
    for (vertex, &particle) in particle_of_vertex.iter().enumerate().rev() {
        if particle != NO_PARTICLE {
            vertices[particle as usize] = vertex as u32;
        }
    }
    vertices
}
