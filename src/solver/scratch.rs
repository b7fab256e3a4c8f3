//! Buffers that a step needs and nobody keeps: reused from step to step, so a step doesn't allocate.

use bevy::math::Vec3A;

use super::{
    SimdLevel, Lanes, BodyImpulse, BodyDisplacement,
    constraint::{
        beads::GatheredParticles,
        bend::{BendSolver, ChebyshevBuffers},
        level::Levels,
        mount::BodyAttachments,
        bend_factors::BendFactors,
        tether::PinPlaces,
    },
    contact::{Bodies, MeshContacts, BroadPhase, touch::FeatureContacts},
    force::wind::Air,
    lanes::Points,
    share::WorkerScratch,
};

/// Working memory of [`step`](super::step()). One can serve any number of cloths in turn.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    /// Which instructions steps use.
    pub simd_level: SimdLevel,
    /// The particles.
    pub(super) lanes: Lanes,
    /// The air around them.
    pub(super) air: Air,
    /// External force and force of the air on each particle, N: constant over some substeps.
    pub(super) steady_force: Vec<Vec3A>,
    /// The steady force and the force of the springs on each particle, N.
    pub(super) force: Vec<Vec3A>,
    /// The force that moves the particles, N.
    pub(super) applied_force: Points,
    /// Sum of (stiffness in N/m, damping in N·s/m) of the springs at each particle.
    pub(super) spring_sums: Vec<(f32, f32)>,
    /// The particles one by one.
    pub(super) beads: GatheredParticles,
    /// Their ways while they bend.
    pub(super) ways: ChebyshevBuffers,
    /// How they bend in this step.
    pub(super) bending: Option<BendSolver>,
    /// The coarse levels.
    pub(super) levels: Levels,
    /// What a lattice's bends have in common.
    pub(super) bend_factors: BendFactors,
    /// The pins that hold tethers.
    pub(super) pins: PinPlaces,
    /// Bodies that anchors are fixed to.
    pub(super) mounts: BodyAttachments,
    /// What this thread needs of its own.
    pub(super) bench: WorkerScratch,
    /// The obstacles around.
    pub(super) near: BroadPhase,
    /// The faces of each of them that is a mesh.
    pub(super) faces: Vec<MeshContacts>,
    /// The bodies among the obstacles.
    pub(super) bodies: Bodies,
    /// What is touched with triangles and edges: of the first of the cloths that are stepped together.
    pub(super) touch: FeatureContacts,
    /// What each thread needs of its own that shares a large cloth.
    pub(super) benches: Vec<WorkerScratch>,
}

impl Scratch {
    /// What the cloth has given to each of the [`obstacles`](super::StepContext::obstacles) in the latest step: nothing to
    /// those that are no bodies.
    pub fn pushes(&self) -> &[BodyImpulse] {
        &self.bodies.pushes
    }

    /// How far each of them has come off its path by that until the step's end. Who moves the bodies by it as well has them
    /// where the cloth has seen them last.
    pub fn strays(&self) -> &[BodyDisplacement] {
        &self.bodies.strays
    }

    /// What the cloth has given to each of the [`mounts`](super::StepContext::mounts) in the latest step, and how far that
    /// has come off its path by it.
    pub fn pulls(&self) -> &[(BodyImpulse, BodyDisplacement)] {
        &self.mounts.pulls
    }
}
