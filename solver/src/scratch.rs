//! Buffers that a step needs and nobody keeps: reused from step to step, so a step doesn't allocate.

use bevy_math::Vec3A;

use crate::{
    constraint::{
        attach::{body::BodyAttachments, skin::SkinPoints, tether::PinPlaces},
        implicit::ImplicitBuffers,
        multigrid::Levels,
        strand::bend_factors::BendFactors,
        unstructured::bend::{BendSolver, stages::ChebyshevBuffers},
    },
    contact::{body::Bodies, broad_phase::BroadPhase, feature::FeatureContacts, mesh::MeshContacts},
    force::wind::Air,
    input::{BodyDisplacement, BodyImpulse},
    layout::{points::Points, simd::SimdLevel},
    parallel::grid_substep::WorkerScratch,
    particles::{gathered::GatheredParticles, lanes::Lanes},
};

/// Working memory of [`step`](crate::step()). One can serve any number of cloths in turn.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    /// Which instructions steps use.
    pub simd_level: SimdLevel,
    /// The particles.
    pub(crate) lanes: Lanes,
    /// The air around them.
    pub(crate) air: Air,
    /// External force and force of the air on each particle, N: constant over some substeps.
    pub(crate) steady_force: Vec<Vec3A>,
    /// The steady force and the force of the springs on each particle, N.
    pub(crate) force: Vec<Vec3A>,
    /// The force that moves the particles, N.
    pub(crate) applied_force: Points,
    /// Sum of (stiffness in N/m, damping in N·s/m) of the springs at each particle.
    pub(crate) spring_sums: Vec<(f32, f32)>,
    /// The particles one by one.
    pub(crate) gathered: GatheredParticles,
    /// Their displacements while they bend.
    pub(crate) ways: ChebyshevBuffers,
    /// How they bend in this step.
    pub(crate) bending: Option<BendSolver>,
    /// The implicit solver of sheets.
    pub(crate) implicit: ImplicitBuffers,
    /// The coarse levels.
    pub(crate) levels: Levels,
    /// What a lattice's bends have in common.
    pub(crate) bend_factors: BendFactors,
    /// The pins that hold tethers.
    pub(crate) pins: PinPlaces,
    /// The animated mesh that holds the cloth.
    pub(crate) skin: SkinPoints,
    /// Bodies that pins are fixed to.
    pub(crate) body_attachments: BodyAttachments,
    /// What this thread needs of its own.
    pub(crate) worker_scratch: WorkerScratch,
    /// The obstacles around.
    pub(crate) broad_phase: BroadPhase,
    /// The faces of each of them that is a mesh.
    pub(crate) faces: Vec<MeshContacts>,
    /// The bodies among the obstacles.
    pub(crate) bodies: Bodies,
    /// What is touched with triangles and edges: of the first of the cloths that are stepped together.
    pub(crate) touch: FeatureContacts,
    /// What each thread needs of its own that shares a large cloth.
    pub(crate) worker_scratches: Vec<WorkerScratch>,
}

impl Scratch {
    /// What the cloth has given to each of the [`obstacles`](crate::input::StepContext::obstacles) in the latest step: nothing to
    /// those that are no bodies.
    pub fn obstacle_impulses(&self) -> &[BodyImpulse] {
        &self.bodies.impulses
    }

    /// How far each of them has come off its path by that until the step's end. Who moves the bodies by it as well has them
    /// where the cloth has seen them last.
    pub fn obstacle_displacements(&self) -> &[BodyDisplacement] {
        &self.bodies.displacements
    }

    /// What the cloth has given to each of the [`body_attachments`](crate::input::StepContext::body_attachments) in the latest
    /// step, and how far that has come off its path by it.
    pub fn attachment_impulses(&self) -> &[(BodyImpulse, BodyDisplacement)] {
        &self.body_attachments.impulses
    }
}
