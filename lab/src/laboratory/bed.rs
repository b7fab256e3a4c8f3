//! A cloth on the bench of the laboratory, and short ways to step it.

use bevy::{
    math::{Mat3A, Vec3A},
    prelude::Mesh,
};
use bevy_drape::{
    build,
    prelude::Fabric,
    solver::{
        Material, Method, Obstacle, Particles, PinMotion, Scratch, StepContext, StepSettings, SubstepPolicy, Tethers,
        Topology, step,
    },
};

use super::record::{Case, Rest};

/// Earth's gravity, m/s².
pub const GRAVITY: f32 = 9.81;

/// Duration of a step, s.
pub const FRAME: f32 = 1.0 / 60.0;

/// s.
const A_WHILE: f32 = 0.25;

/// A cloth and all that acts on it.
#[derive(Clone)]
pub struct Bed {
    pub topology: Topology,
    pub particles: Particles,
    pub material: Material,
    pub pin_motions: Vec<PinMotion>,
    pub obstacles: Vec<Obstacle>,
    pub method: Method,
    pub substeps: u32,
    pub gravity: Vec3A,
    pub fluid_density: f32,
    /// Duration of a step, s.
    pub dt: f32,
    pub tethers: Option<Tethers>,
    /// Below this speed (m/s) it counts as at rest: the mean velocity of the fastest particle over [`A_WHILE`]. In f32 and in
    /// small substeps, rounding shakes particles faster than that without moving them.
    pub slow: f32,
    pub scratch: Scratch,
}

/// Names and constants of all presets.
pub fn presets() -> impl Iterator<Item = (&'static str, Fabric)> {
    Fabric::PRESETS.into_iter().map(|preset| (preset.name, preset.fabric))
}

/// A fabric in a vacuum that nothing damps.
pub fn bare(fabric: Fabric) -> Material {
    let bare = Fabric { damping: 0.0, drag: 0.0, lift: 0.0, ..fabric };
    Material { thickness: 0.0, ..bare.material().expect("the laboratory's fabrics are valid") }
}

impl Bed {
    /// The particles of `mesh`, free and at rest.
    pub fn new(mesh: impl Into<Mesh>, material: Material) -> Self {
        let topology = build::topology_of(&mesh.into(), Mat3A::IDENTITY).expect("the laboratory's meshes have an area");
        let rest = topology.rest.iter().copied().map(Vec3A::from).collect();
        Self {
            particles: Particles::at_rest(rest, &topology, &material),
            topology,
            material,
            pin_motions: Vec::new(),
            obstacles: Vec::new(),
            method: Method::Strands,
            substeps: 8,
            gravity: Vec3A::NEG_Y * GRAVITY,
            fluid_density: 0.0,
            dt: FRAME,
            tethers: None,
            slow: 1e-4,
            scratch: Scratch::default(),
        }
    }

    /// Integrated in the way of `case`.
    pub fn solved_as_in(mut self, case: &Case) -> Self {
        self.method = case.method;
        self.substeps = case.substeps.unwrap_or(1);
        self
    }

    /// Fixes the particles that are chosen by their rest position, where they are.
    pub fn pinned(mut self, is_pinned: impl Fn(Vec3A) -> bool) -> Self {
        for particle in self.chosen(is_pinned) {
            let place = self.particles.position[particle];
            self.particles.inverse_mass[particle] = 0.0;
            self.pin_motions.push(PinMotion { particle: particle as u32, start: place, end: place });
        }
        self
    }

    /// Ties all particles to those that are fixed, as a game does.
    pub fn tethered(mut self) -> Self {
        let pins: Vec<u32> = self.pin_motions.iter().map(|anchor| anchor.particle).collect();
        self.tethers = Some(build::tethers(&self.topology, &pins));
        self
    }

    /// The particles whose rest position is as asked.
    pub fn chosen(&self, is_chosen: impl Fn(Vec3A) -> bool) -> Vec<usize> {
        let rest = self.topology.rest.iter().enumerate();
        rest.filter(|(_, place)| is_chosen(Vec3A::from(**place))).map(|(i, _)| i).collect()
    }

    /// One step.
    pub fn step(&mut self) {
        let settings = StepSettings {
            method: self.method,
            substep_policy: SubstepPolicy::fixed(self.substeps, Vec::new()),
            max_substeps: u32::MAX,
            max_velocity: 100.0,
            margin: 0.0,
            ..StepSettings::default()
        };
        let ctx = StepContext {
            gravity: self.gravity,
            fluid_density: self.fluid_density,
            pin_motions: &self.pin_motions,
            tethers: self.tethers.as_ref(),
            obstacles: &self.obstacles,
            ..StepContext::new(self.dt, &settings, self.material)
        };
        step(&mut self.particles, &self.topology, &ctx, &mut self.scratch);
    }

    /// Steps for about so long.
    pub fn run(&mut self, seconds: f32) {
        for _ in 0..(seconds / self.dt).round() as u32 {
            self.step();
        }
    }

    /// Steps for about so long with velocities that are damped by `damping`, 1/s.
    pub fn run_damped(&mut self, damping: f32, seconds: f32) {
        let before = core::mem::replace(&mut self.material.damping, damping);
        self.run(seconds);
        self.material.damping = before;
    }

    /// Damps the velocities by `damping` (1/s) and steps until the cloth is at rest, `longest` seconds at most.
    pub fn settle(&mut self, damping: f32, longest: f32) -> Rest {
        let while_steps = (A_WHILE / self.dt).round();
        let mut fastest = f32::INFINITY;
        for _ in 0..(longest / A_WHILE).ceil() as u32 {
            let start = self.particles.position.clone();
            self.run_damped(damping, A_WHILE);
            let ways = self.particles.position.iter().zip(&start).map(|(p, q)| p.distance(*q));
            fastest = ways.fold(0.0, f32::max) / (while_steps * self.dt);
            if fastest < self.slow {
                break;
            }
        }
        Rest { fastest: fastest.into(), is_reached: fastest < self.slow }
    }

    /// Mass of a particle, kg; that of its part of the cloth where it is fixed.
    pub fn mass(&self, particle: usize) -> f64 {
        f64::from(self.material.density) * f64::from(self.topology.areas[particle])
    }

    /// Mean of all positions, m.
    pub fn centre(&self) -> Vec3A {
        self.particles.position.iter().sum::<Vec3A>() / self.particles.len() as f32
    }

    /// Mean of what `value` gives for some particles.
    pub fn mean(&self, some: &[usize], value: impl Fn(Vec3A) -> f32) -> f64 {
        some.iter().map(|&i| f64::from(value(self.particles.position[i]))).sum::<f64>() / some.len() as f64
    }
}
