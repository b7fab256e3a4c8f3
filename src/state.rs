//! The running state of a cloth, and how a game reads and pushes it.

use core::time::Duration;
use std::sync::Arc;

use bevy::{
    math::{Affine3A, Vec3A},
    prelude::*,
};

use crate::{
    anchor::{Carrier, HeldPin},
    build::plan::PendingBuild,
    cloth::{Cloth, ClothSolver},
    draw::shading::particle_normals,
    grab::Grabs,
    rest_scale::RestScale,
    solver::{
        self, AttachedPin, BodyAttachment, BodyDisplacement, BodyImpulse, Energy, Grab, Material, MeshStructure,
        Obstacle, Particles, PinMotion, StepReport, Strain, SubstepPolicy, Tether, Tethers, Topology, WindSource,
        build::{
            blend::{BlendWeightBuild, BlendWeights},
            geodesic::TetherBuild,
            weld::NO_PARTICLE,
        },
    },
    teleport::Jump,
};

/// Particles of a cloth, in world space. Comes with [`Cloth`](crate::prelude::Cloth); empty until the cloth is ready.
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
    /// The settings in force: the latest that were valid.
    pub(crate) settings: Cloth,
    /// Substeps and levels that follow from the settings.
    pub(crate) effort: SubstepPolicy,
    /// The constants in force: the latest that were valid.
    pub(crate) material: Option<Material>,
    /// How wide it is at rest, m.
    pub(crate) width: f32,
    /// Fixed particles and what they follow.
    pub(crate) pins: Vec<HeldPin>,
    /// Particles that are fixed to bodies which give way, by what is known: they hold no tethers.
    pub(crate) attached_pins: Vec<u32>,
    /// Tethers to the pins.
    pub(crate) tethers: Tethers,
    /// Tethers that are being worked out anew.
    pub(crate) tying: Option<Box<TetherBuild>>,
    /// Points that are held by hand.
    pub(crate) grabs: Grabs,
    /// The scale that the cloth was built at, and what it has become since.
    pub(crate) rest_scale: RestScale,
    /// Transform of the entity at the latest step.
    pub(crate) pose: Affine3A,
    /// What the pins follow.
    pub(crate) carriers: Vec<Carrier>,
    /// By which weights its particles are drawn with several carriers.
    pub(crate) blend_weights: Option<BlendWeights>,
    /// Weights that are being worked out anew.
    pub(crate) blending: Option<Box<BlendWeightBuild>>,
    /// Number of steps that moved something since the cloth was built: drawing skips what hasn't moved.
    pub(crate) steps: u64,
    /// The latest step moved nothing.
    pub(crate) is_still: bool,
    /// What the latest step did.
    pub(crate) report: Option<StepReport>,
    /// Time that the latest step took.
    pub(crate) step_time: Duration,
    /// The latest step ended in a state that wasn't finite, and was taken back.
    pub(crate) is_taken_back: bool,
    /// What has been asked for and is done at the next occasion.
    pub(crate) requests: Requests,
    /// What it waits for, or the cloth that takes its place.
    pub(crate) awaited: Option<PendingBuild>,
    /// What has been said once and needn't be said again.
    pub(crate) said: Warned,
    /// Buffers of a step.
    pub(crate) work: Work,
}

/// What a game has asked of a cloth.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Requests {
    /// Back to the rest shape.
    pub reset: bool,
    /// Carry the cloth along with its entity, as one rigid piece.
    pub teleport: bool,
    /// It has been reset, and was on an entity at this pose before: what has come along has jumped.
    pub reset_from: Option<Affine3A>,
}

/// Which warnings have been given.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Warned {
    /// The explicit solver has too few substeps.
    pub softened: bool,
    /// The state became non-finite.
    pub not_finite: bool,
    /// A setting is out of its range.
    pub refused: bool,
    /// The margin is too large for the cloth.
    pub margin: bool,
    /// The mesh is too coarse for its fabric: by how many times its edges were too long when that was told, or 0.
    pub coarseness: f32,
    /// The mesh has a skin.
    pub skin: bool,
    /// The mesh has morph targets.
    pub morph_targets: bool,
}

/// What a cloth has given to a body.
#[cfg_attr(not(any(feature = "avian", feature = "rapier")), expect(dead_code, reason = "physics engines read it"))]
#[derive(Clone, Copy, Debug)]
pub(crate) struct Given {
    /// The body, or one of its colliders.
    pub to: Entity,
    pub push: BodyImpulse,
    /// How far it has come off its path by that.
    pub stray: BodyDisplacement,
}

/// Buffers that a step fills anew.
#[derive(Clone, Debug, Default)]
pub(crate) struct Work {
    pub pin_motions: Vec<PinMotion>,
    pub grabs: Vec<Grab>,
    pub obstacles: Vec<Obstacle>,
    /// Whose obstacle each is.
    pub owners: Vec<Entity>,
    /// Bodies that pins are fixed to, whose they are, and which anchors are on which.
    pub body_attachments: Vec<BodyAttachment>,
    pub mount_owners: Vec<Entity>,
    pub attached_pins: Vec<AttachedPin>,
    /// What the bodies among all these have been given.
    pub given: Vec<Given>,
    pub winds: Vec<WindSource>,
    /// The jump that the cloth has made before the step.
    pub jump: Option<Jump>,
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
        particle_normals(&self.topology.triangles, &self.particles.position, &self.pose.matrix3).collect()
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

    /// What the cloth's mesh was found to be, by which [`ClothSolver::Strands`] goes: rows and columns, threads, or
    /// springs one by one. None until the cloth is ready.
    pub fn structure(&self) -> Option<MeshStructure> {
        (!self.particles.is_empty()).then(|| self.topology.structure())
    }

    /// What the latest step did: substeps, contacts. None before the first.
    pub fn report(&self) -> Option<StepReport> {
        self.report
    }

    /// Time that the latest step took on its thread.
    pub fn step_time(&self) -> Duration {
        self.step_time
    }

    /// How far the cloth is stretched along its threads. Computed anew.
    pub fn strain(&self) -> Strain {
        solver::measure::strain(&self.particles, &self.topology)
    }

    /// Where the cloth's energy is, under a gravity in m/s². Computed anew.
    pub fn energy(&self, gravity: Vec3) -> Energy {
        let gravity = Vec3A::from(gravity * self.settings.gravity_scale);
        let energy = |material| solver::measure::energy(&self.particles, &self.topology, &material, gravity);
        self.material.map(energy).unwrap_or_default()
    }

    /// Tethers to the pins, as pairs of a particle and the particle that holds it. None where the solver has none.
    pub fn tethers(&self) -> impl Iterator<Item = Tether> {
        let is_tethered = self.settings.tether_slack.is_some() && self.settings.solver != ClothSolver::Explicit;
        is_tethered.then(|| self.tethers.iter()).into_iter().flatten()
    }

    /// Pushes a particle with `force` (N) during the next step. Forces add up until then, so push once a step: in the
    /// plugin's schedule, before [`ClothSystems::Simulate`](crate::prelude::ClothSystems::Simulate), or in any fixed one
    /// before it. A force that isn't finite is ignored.
    pub fn add_force(&mut self, particle: usize, force: Vec3) {
        if let Some(total) = self.particles.force.get_mut(particle)
            && force.is_finite()
        {
            *total += Vec3A::from(force);
        }
    }

    /// Gives a particle an impulse (N·s) at once. Pinned particles and impulses that aren't finite are left alone.
    pub fn add_impulse(&mut self, particle: usize, impulse: Vec3) {
        if let Some(velocity) = self.particles.velocity.get_mut(particle)
            && impulse.is_finite()
        {
            *velocity += Vec3A::from(impulse) * self.particles.inverse_mass[particle];
        }
    }

    /// Spreads `force` (N in all) during the next step over the free particles within `radius` (m) of the world
    /// position `centre`: by mass, and fading to nothing at the radius.
    pub fn add_force_in_radius(&mut self, centre: Vec3, radius: f32, force: Vec3) {
        self.spread(centre, radius, |state, particle, share| state.add_force(particle, force * share));
    }

    /// Spreads an impulse (N·s in all) at once, as [`add_force_in_radius`](Self::add_force_in_radius) does a force.
    pub fn add_impulse_in_radius(&mut self, centre: Vec3, radius: f32, impulse: Vec3) {
        self.spread(centre, radius, |state, particle, share| {
            state.add_impulse(particle, impulse * share);
        });
    }

    fn spread(&mut self, centre: Vec3, radius: f32, apply: impl Fn(&mut Self, usize, f32)) {
        if radius.is_nan() || radius <= 0.0 {
            return;
        }
        let centre = Vec3A::from(centre - self.origin);
        let weight = |state: &Self, particle: usize| {
            let closeness = 1.0 - state.particles.position[particle].distance(centre) / radius;
            let inverse_mass = state.particles.inverse_mass[particle];
            if closeness > 0.0 && inverse_mass > 0.0 { closeness / inverse_mass } else { 0.0 }
        };
        let total: f32 = (0..self.particles.len()).map(|i| weight(self, i)).sum();
        if total > 0.0 {
            for particle in 0..self.particles.len() {
                let share = weight(self, particle) / total;
                if share > 0.0 {
                    apply(self, particle, share);
                }
            }
        }
    }
}
