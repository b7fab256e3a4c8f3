//! The running state of a cloth: the body that a game reads and pushes, and what its other components hold.
//!
//! Types and what they do by themselves; the systems that work on them are in the rooms of their stages.

use std::sync::Arc;

use bevy::{
    math::{Affine3A, Mat3A, Vec3A},
    prelude::*,
};

use crate::solver::{
    self, Energy, Material, MeshStructure, Particles, Strain, Topology, build::weld::NO_PARTICLE, measure,
};

mod allowance;
mod attachments;
mod forces;
mod grabs;
mod origin;
mod pending_build;
mod pin_anchor;
mod point;
mod report;
mod requests;
mod rest_scale;
mod skinning;
mod sleep;
mod status;
mod step_input;
mod width;

pub(crate) use allowance::Allowance;
pub use attachments::ClothAttachments;
pub(crate) use attachments::HeldPin;
pub(crate) use grabs::HeldGrab;
pub use grabs::{ClothGrabbed, ClothGrabs, ClothGrip, ClothReleased, GrabId};
pub(crate) use origin::{carry, shift, stay_near, take_along};
pub(crate) use pending_build::{BuildKey, PendingBuild, TetherKey};
pub(crate) use pin_anchor::PinAnchor;
#[cfg(any(feature = "avian", feature = "rapier"))]
pub(crate) use pin_anchor::target_entity;
pub use point::ClothPoint;
#[cfg(feature = "debug")]
pub(crate) use point::blend;
pub use report::ClothReport;
pub(crate) use requests::{Requests, Warned};
pub(crate) use rest_scale::RestScale;
pub(crate) use skinning::{BoundSkin, Skinning};
pub(crate) use sleep::Sleep;
pub use sleep::{ClothFellAsleep, ClothSleepingDisabled, ClothWokeUp};
pub use status::{ClothFailed, ClothReady, ClothReset, ClothStatus, ResetCause};
pub(crate) use step_input::{BodyPush, StepInput};
pub(crate) use width::width_at_rest;

/// The body of a cloth: its particles, in world space. Comes with [`Cloth`](crate::prelude::Cloth); empty until the cloth is
/// ready.
///
/// A mesh's vertices that share a position are one particle: [`particle_of_vertex`](Self::particle_of_vertex) maps
/// one to the other.
#[derive(Component, Clone, Debug, Default, Reflect)]
#[component(clone_behavior = Ignore)]
#[reflect(opaque)]
// Not as a component: scenes leave the running state out, and a cloth that is loaded makes its own.
#[reflect(Default, Debug, Clone)]
pub struct ClothState {
    /// State of the solver, relative to `origin`.
    pub(crate) particles: Particles,
    /// Positions when the latest step began: drawing interpolates from them, and recovery goes back to them.
    pub(crate) step_start: Vec<Vec3A>,
    /// World position that all positions are relative to, m.
    pub(crate) origin: Vec3,
    /// What is connected to what.
    pub(crate) topology: Arc<Topology>,
    /// Particle of each vertex of the mesh.
    pub(crate) particle_of_vertex: Arc<[u32]>,
    /// The constants in force: the latest that were valid. None until the cloth is ready.
    pub(crate) material: Option<Material>,
    /// How wide it is at rest, m.
    pub(crate) width: f32,
    /// The scale that the cloth was built at, and what it has become since.
    pub(crate) rest_scale: RestScale,
    /// Transform of the entity at the latest step.
    pub(crate) pose: Affine3A,
    /// Number of steps that moved something since the cloth was built: drawing skips what hasn't moved.
    pub(crate) steps: u64,
    /// The latest step moved nothing.
    pub(crate) is_still: bool,
    /// Something else than a step has changed the cloth, or what it is made of, since the latest step.
    pub(crate) is_disturbed: bool,
}

impl ClothState {
    /// Number of particles; 0 until the cloth is ready.
    pub fn particle_count(&self) -> usize {
        self.particles.len()
    }

    /// The particle that a vertex of the mesh belongs to; none for a vertex that is in no triangle.
    pub fn particle_of_vertex(&self, vertex: usize) -> Option<usize> {
        let &particle = self.particle_of_vertex.get(vertex)?;
        (particle != NO_PARTICLE).then_some(particle as usize)
    }

    /// World position of a particle after the latest step, m.
    pub fn position(&self, particle: usize) -> Option<Vec3> {
        Some(self.origin + Vec3::from(*self.particles.position.get(particle)?))
    }

    /// World positions of all particles after the latest step, m.
    pub fn positions(&self) -> impl ExactSizeIterator<Item = Vec3> {
        self.particles.position.iter().map(|&p| self.origin + Vec3::from(p))
    }

    /// World position, m, that the cloth's own positions are relative to. It stays near the cloth.
    pub fn origin(&self) -> Vec3 {
        self.origin
    }

    /// Positions of all particles relative to [`origin`](Self::origin), m: exact where world positions, far from the
    /// world's origin, no longer are.
    pub fn positions_from_origin(&self) -> impl ExactSizeIterator<Item = Vec3> {
        self.particles.position.iter().copied().map(Vec3::from)
    }

    /// Velocity of a particle, m/s. A pinned particle has the velocity of its pin.
    pub fn velocity(&self, particle: usize) -> Option<Vec3> {
        self.particles.velocity.get(particle).copied().map(Vec3::from)
    }

    /// Velocities of all particles, m/s.
    pub fn velocities(&self) -> impl ExactSizeIterator<Item = Vec3> {
        self.particles.velocity.iter().copied().map(Vec3::from)
    }

    /// World normals of all particles, unit vectors, on the side that the mesh's own normals face; of a mesh without any, the
    /// side that its triangles face. Computed anew.
    pub fn normals(&self) -> Vec<Vec3> {
        shown_normals(self.triangles(), &self.particles.position, &self.pose.matrix3).collect()
    }

    /// Particles of each triangle.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.topology.triangles
    }

    /// Whether a particle is pinned.
    pub fn is_pinned(&self, particle: usize) -> bool {
        self.particles.inverse_mass.get(particle) == Some(&0.0)
    }

    /// Springs, triangles and areas.
    pub fn topology(&self) -> &Arc<Topology> {
        &self.topology
    }

    /// What the cloth's mesh was found to be, by which [`ClothSolver::Strands`](crate::prelude::ClothSolver::Strands) goes: rows
    /// and columns; triangles that take implicit steps; with [`ClothSprings`](crate::prelude::ClothSprings) strands, or springs
    /// one by one. None until the cloth is ready.
    pub fn structure(&self) -> Option<MeshStructure> {
        let is_sheet = self.material.is_some_and(|material| material.moduli().is_some());
        let found = || if is_sheet { self.topology.structure_of_sheet() } else { self.topology.structure() };
        (!self.particles.is_empty()).then(found)
    }

    /// How far the cloth is stretched along its springs, no unit. Computed anew.
    pub fn strain(&self) -> Strain {
        solver::measure::strain(&self.particles, &self.topology)
    }

    /// Where the cloth's energy is, J, under the gravity that it feels, m/s². Computed anew.
    pub fn energy(&self, gravity: Vec3) -> Energy {
        let energy = |material| measure::energy(&self.particles, &self.topology, &material, gravity.into());
        self.material.map(energy).unwrap_or_default()
    }
}

/// World normals of particles, unit vectors, on the side that their mesh shows. `position` is up to a shift in the world,
/// `to_world` takes the mesh there.
pub(crate) fn shown_normals(
    triangles: &[[u32; 3]],
    position: &[Vec3A],
    to_world: &Mat3A,
) -> impl Iterator<Item = Vec3> + use<> {
    // A mirrored mesh shows its back where its triangles, in the world, seem to face.
    let side = 1.0_f32.copysign(to_world.determinant());
    measure::normals(triangles, position).into_iter().map(move |normal| (normal * side).into())
}
