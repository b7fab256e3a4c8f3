//! Small cloths and short ways to step them.

use std::sync::Arc;

use bevy_math::Vec3A;
use bevy_tasks::TaskPool;
use drape_solver::{
    AttachedPin, BodyAttachment, Grab, Material, Member, Method, Obstacle, Particles, PinMotion, Scratch, Skin,
    SkinLimits, SkinPose, SourceMesh, StepContext, StepReach, StepReport, StepSettings, SubstepPolicy, Tethers,
    Topology, WindSource, build, step,
};

use crate::fixtures::mesh::{Grid, topology};

pub const GRAVITY: f32 = 9.81;

/// Every way to integrate the springs.
pub const ALL: [Method; 3] = [Method::Strands, Method::Xpbd, Method::Explicit];

/// Those that are stable whatever the stiffness and the time step: the default and the one before it.
pub const STABLE: [Method; 2] = [Method::Strands, Method::Xpbd];

/// An animated mesh that holds a cloth.
#[derive(Clone)]
pub struct AnimatedMesh {
    pub limits: SkinLimits,
    /// At the start and the end of the coming step.
    pub poses: [SkinPose; 2],
    /// Hz
    pub pull: f32,
    pub pull_damping: f32,
}

/// A cloth and all that acts on it.
#[derive(Clone)]
pub struct Bed {
    pub topology: Topology,
    pub particles: Particles,
    pub material: Material,
    pub pin_motions: Vec<PinMotion>,
    pub body_attachments: Vec<BodyAttachment>,
    pub attached_pins: Vec<AttachedPin>,
    pub grabs: Vec<Grab>,
    pub tethers: Option<Tethers>,
    pub tether_slack: f32,
    pub skin: Option<AnimatedMesh>,
    pub obstacles: Vec<Obstacle>,
    pub winds: Vec<WindSource>,
    pub method: Method,
    pub substep_policy: SubstepPolicy,
    pub max_substeps: u32,
    pub max_velocity: f32,
    pub substep_limit: u32,
    pub margin: f32,
    pub self_collision: bool,
    pub gravity: Vec3A,
    pub fluid_density: f32,
    pub pool: Option<Arc<TaskPool>>,
    /// Its origin from that of the first bed that it is stepped together with, m.
    pub offset: Vec3A,
    pub scratch: Scratch,
    /// Those of the latest step.
    pub settings: StepSettings,
}

impl Bed {
    /// The particles of `mesh`, free and at rest.
    pub fn new(mesh: impl Into<SourceMesh>, material: Material) -> Self {
        let topology = topology(mesh);
        let rest = topology.rest.iter().copied().map(Vec3A::from).collect();
        Self {
            particles: Particles::at_rest(rest, &topology, &material),
            topology,
            material,
            pin_motions: Vec::new(),
            body_attachments: Vec::new(),
            attached_pins: Vec::new(),
            grabs: Vec::new(),
            tethers: None,
            tether_slack: 0.0,
            skin: None,
            obstacles: Vec::new(),
            winds: Vec::new(),
            method: Method::Strands,
            substep_policy: SubstepPolicy::fixed(8, Vec::new()),
            max_substeps: 4096,
            max_velocity: 100.0,
            substep_limit: u32::MAX,
            margin: 0.0,
            self_collision: false,
            gravity: Vec3A::NEG_Y * GRAVITY,
            fluid_density: 1.225,
            pool: None,
            offset: Vec3A::ZERO,
            scratch: Scratch::default(),
            settings: StepSettings::default(),
        }
    }

    /// A square metre, lying at height 0, of `n` x `n` particles.
    pub fn lying(n: u32, material: Material) -> Self {
        Self::new(Grid::new(1.0, 1.0, n, n).lying(), material)
    }

    /// Fixes particles where they are.
    pub fn pinned(mut self, particles: impl IntoIterator<Item = u32>) -> Self {
        for particle in particles {
            let place = self.particles.position[particle as usize];
            self.particles.inverse_mass[particle as usize] = 0.0;
            self.pin_motions.push(PinMotion { particle, start: place, end: place });
        }
        self
    }

    /// Ties all particles to `pins`.
    pub fn tethered(mut self, pins: &[u32]) -> Self {
        self.tethers = Some(build::tethers(&self.topology, pins));
        self
    }

    /// A method with the substeps that a game takes where it says nothing of them.
    pub fn like_a_game(mut self, method: Method) -> Self {
        self.method = method;
        // Strands come after the tethers, and fight those that give nothing; the others keep what they were tested with.
        self.tether_slack = if method == Method::Strands { 0.005 } else { 0.0 };
        self.substep_policy = match method {
            Method::Strands => SubstepPolicy::to_hold(0.01, &self.topology, self.material.moduli()),
            Method::Xpbd | Method::Explicit => SubstepPolicy::fixed(8, Vec::new()),
        };
        self
    }

    /// All levels that may go with one substep, whatever the substeps. Only strands have any.
    pub fn with_levels(mut self) -> Self {
        self.substep_policy =
            SubstepPolicy::fixed(self.substep_policy.substeps, SubstepPolicy::levels_for(1, &self.topology));
        self
    }

    /// So many substeps, without levels.
    pub fn with_substeps(mut self, substeps: u32) -> Self {
        self.substep_policy = SubstepPolicy::fixed(substeps, Vec::new());
        self
    }

    /// One step of `dt` seconds.
    pub fn step(&mut self, dt: f32) -> StepReport {
        let (particles, topology, ctx, scratch) = self.parts(dt);
        step(particles, topology, &ctx, scratch)
    }

    /// What a step of `dt` seconds may reach.
    pub fn reach(&mut self, dt: f32) -> StepReach {
        let (particles, _, ctx, _) = self.parts(dt);
        StepReach::new(particles, &ctx)
    }

    /// What goes into a step of `dt` seconds, for which the winds move on.
    fn parts(&mut self, dt: f32) -> (&mut Particles, &Topology, StepContext<'_>, &mut Scratch) {
        self.winds.iter_mut().for_each(|wind| wind.advance(dt));
        // Only where it is another: a step of the bed allocates nothing.
        if self.settings.substep_policy != self.substep_policy {
            self.settings.substep_policy.clone_from(&self.substep_policy);
        }
        self.settings.method = self.method;
        self.settings.max_substeps = self.max_substeps;
        self.settings.max_velocity = self.max_velocity;
        self.settings.tether_slack = self.tether_slack;
        self.settings.margin = self.margin;
        self.settings.self_collision = self.self_collision;
        let ctx = StepContext {
            gravity: self.gravity,
            fluid_density: self.fluid_density,
            pin_motions: &self.pin_motions,
            body_attachments: &self.body_attachments,
            attached_pins: &self.attached_pins,
            grabs: &self.grabs,
            tethers: self.tethers.as_ref(),
            skin: self.skin.as_ref().map(|AnimatedMesh { limits, poses: [start, end], pull, pull_damping }| Skin {
                limits,
                start,
                end,
                pull: *pull,
                pull_damping: *pull_damping,
            }),
            obstacles: &self.obstacles,
            winds: &self.winds,
            substep_limit: self.substep_limit,
            pool: self.pool.as_deref(),
            ..StepContext::new(dt, &self.settings, self.material)
        };
        (&mut self.particles, &self.topology, ctx, &mut self.scratch)
    }

    /// Steps of 1/60 s for about `seconds`.
    pub fn run(&mut self, seconds: f32) {
        for _ in 0..(seconds * 60.0).round() as u32 {
            self.step(1.0 / 60.0);
        }
    }

    pub fn centre(&self) -> Vec3A {
        self.particles.position.iter().sum::<Vec3A>() / self.particles.len() as f32
    }

    pub fn fastest(&self) -> f32 {
        self.particles.velocity.iter().map(|v| v.length()).fold(0.0, f32::max)
    }
}

/// Shows beds to `act` as the plugin gives cloths that may touch each other to the solver, for a step of `dt` seconds.
pub fn together<R>(beds: &mut [Bed], dt: f32, act: impl FnOnce(&mut [Member]) -> R) -> R {
    let mut parts: Vec<_> = beds.iter_mut().map(|bed| (bed.offset, bed.parts(dt))).collect();
    let members = parts.iter_mut().map(|(offset, (particles, topology, ctx, scratch))| Member {
        particles,
        topology,
        ctx,
        scratch,
        offset: *offset,
        report: None,
    });
    act(&mut members.collect::<Vec<_>>())
}

/// Root of the mean squared distance between the particles of two cloths, m.
pub fn rms(a: &Particles, b: &Particles) -> f32 {
    let squares = a.position.iter().zip(&b.position).map(|(p, q)| p.distance_squared(*q));
    (squares.sum::<f32>() / a.len() as f32).sqrt()
}

/// The bits of all positions and velocities.
pub fn bits(particles: &Particles) -> Vec<u32> {
    let values = particles.position.iter().chain(&particles.velocity);
    values.flat_map(|v| v.to_array()).map(f32::to_bits).collect()
}

/// A number that stands for some bits: the 64-bit FNV-1a hash of their bytes, the same with every Rust and on every machine.
pub fn digest(bits: impl IntoIterator<Item = u32>) -> u64 {
    let bytes = bits.into_iter().flat_map(u32::to_le_bytes);
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}
