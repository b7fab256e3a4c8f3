//! The standard scenes, so that every measurement means the same cloth: their cloths, what surrounds these, and what happens.
//!
//! Here is what the lab and the tests share; nothing knows the command line.

use std::{io, time::Instant};

use bevy::{
    math::{Isometry3d, Mat3A, Vec3A},
    prelude::*,
    tasks::TaskPool,
};
use bevy_drape::{
    build,
    prelude::ClothGrid,
    solver::{
        self, Anchor, Effort, LevelPass, Material, Member, Method, Obstacle, Particles, Scratch, SelfCollision, Shape,
        Solid, StepContext, Tethers, Topology, WindSource,
    },
};

mod crossing;
mod depth;
mod look;
mod wave;

pub mod bullet;
pub mod drape;
pub mod fold;
pub mod layers;
pub mod needle;
pub mod ribbon;
pub mod storm;
pub mod twist;

pub use look::Look;

/// Duration of a frame, s.
pub const FRAME: f32 = 1.0 / 60.0;

/// What all cloths of a scene have in common.
#[derive(Clone)]
pub struct Settings {
    /// Particles along a metre.
    pub n: u32,
    /// Frames that the scene has time for.
    pub frames: u32,
    pub method: Method,
    /// As many as the strain needs where it doesn't say.
    pub substeps: Option<u32>,
    /// The largest strain that is wanted, no unit.
    pub max_strain: f32,
    /// Those that go with the substeps where it doesn't say.
    pub levels: Option<Vec<LevelPass>>,
    pub material: Material,
    pub tether_slack: f32,
    pub self_collision: SelfCollision,
    /// Distance that parts of cloth keep from each other, m.
    pub self_distance: f32,
}

impl Settings {
    /// Substeps and levels for a mesh.
    pub fn effort(&self, topology: &Topology) -> Effort {
        let mut effort = match (self.method, self.substeps) {
            (Method::Strands, None) => Effort::to_hold(self.max_strain, topology),
            (Method::Strands, Some(substeps)) => Effort::fixed(substeps, Effort::levels_for(substeps, topology)),
            (_, substeps) => Effort::fixed(substeps.unwrap_or(8), Vec::new()),
        };
        if let Some(levels) = &self.levels {
            effort.levels.clone_from(levels);
            effort.careful_levels.clone_from(levels);
        }
        effort
    }

    /// Time of all frames, s.
    pub fn duration(&self) -> f32 {
        self.frames as f32 * FRAME
    }

    /// Distance between particles, m.
    pub fn cell(&self) -> f32 {
        1.0 / (self.n - 1) as f32
    }

    /// A rectangle of `width` x `height` metres with `n` particles a metre.
    pub fn grid(&self, width: f32, height: f32) -> ClothGrid {
        let particles = |length: f32| (length / self.cell()).round() as u32 + 1;
        ClothGrid::new(width, height, particles(width), particles(height))
    }

    /// A cloth with the particles and springs of `mesh`, free and at rest.
    ///
    /// # Errors
    ///
    /// Why the mesh can't be a cloth.
    pub fn cloth(&self, mesh: &Mesh) -> io::Result<Cloth> {
        let begun = Instant::now();
        let topology = build::topology_of(mesh, Mat3A::IDENTITY).map_err(io::Error::other)?;
        let build_ms = begun.elapsed().as_secs_f64() * 1e3;
        let rest = topology.rest.iter().copied().map(Vec3A::from).collect();
        Ok(Cloth {
            particles: Particles::at_rest(rest, &topology, &self.material),
            rig: Rig { anchors: Vec::new(), tethers: None, effort: self.effort(&topology) },
            scratch: Scratch::default(),
            topology,
            build_ms,
            tethers_ms: 0.0,
        })
    }
}

/// A cloth.
pub struct Cloth {
    pub topology: Topology,
    pub particles: Particles,
    pub rig: Rig,
    pub scratch: Scratch,
    /// Time that the topology took, ms.
    pub build_ms: f64,
    /// Time that the tethers took, ms.
    pub tethers_ms: f64,
}

/// What a cloth hangs by, and how much work is made for it.
pub struct Rig {
    pub anchors: Vec<Anchor>,
    pub tethers: Option<Tethers>,
    pub effort: Effort,
}

impl Cloth {
    /// Puts each particle where `place` says for its place at rest.
    pub fn placed(mut self, place: impl Fn(Vec3) -> Vec3A) -> Self {
        for (position, &rest) in self.particles.position.iter_mut().zip(&self.topology.rest) {
            *position = place(rest);
        }
        self
    }

    /// Holds the particles of which `is_held` is true at rest, where they are now.
    pub fn held(mut self, is_held: impl Fn(Vec3) -> bool) -> Self {
        let held: Vec<u32> =
            (0..).zip(&self.topology.rest).filter(|(_, rest)| is_held(**rest)).map(|(i, _)| i).collect();
        self.hold(&held);
        self
    }

    /// Holds these particles where they are.
    pub fn hold(&mut self, pins: &[u32]) {
        for &particle in pins {
            let place = self.particles.position[particle as usize];
            self.particles.inverse_mass[particle as usize] = 0.0;
            self.rig.anchors.push(Anchor { particle, start: place, end: place });
        }
    }

    /// Leads all that is held to where `place` says for its place at rest, within the next frame.
    pub fn lead(&mut self, place: impl Fn(Vec3) -> Vec3A) {
        for anchor in &mut self.rig.anchors {
            anchor.start = anchor.end;
            anchor.end = place(self.topology.rest[anchor.particle as usize]);
        }
    }
}

/// What acts on all cloths of a scene.
pub struct Surroundings {
    pub settings: Settings,
    pub obstacles: Vec<Obstacle>,
    pub winds: Vec<WindSource>,
    /// kg/m³
    pub fluid_density: f32,
}

impl Surroundings {
    /// All that surrounds a cloth during a frame, with threads of `pool` to help.
    pub fn context<'a>(&'a self, rig: &'a Rig, pool: Option<&'a TaskPool>) -> StepContext<'a> {
        let settings = &self.settings;
        StepContext {
            dt: FRAME,
            method: settings.method,
            effort: &rig.effort,
            max_substeps: u32::MAX,
            material: settings.material,
            gravity: Vec3A::NEG_Y * 9.81,
            anchors: &rig.anchors,
            mounts: &[],
            mounted: &[],
            grabs: &[],
            max_velocity: 50.0,
            tethers: rig.tethers.as_ref(),
            tether_slack: settings.tether_slack,
            margin: 0.0,
            max_depenetration_velocity: 1.0,
            self_collision: settings.self_collision,
            collision_layers: 1,
            collision_mask: 1,
            self_distance: settings.self_distance,
            self_friction: 0.3,
            obstacles: &self.obstacles,
            fluid_density: self.fluid_density,
            winds: &self.winds,
            pool,
        }
    }
}

/// Changes a scene before a frame, of which it is told at how many seconds it ends.
type Lead = Box<dyn Fn(&mut Scene, f32) + Send + Sync>;

/// What an experiment counts of its own: nothing is wrong at zero.
pub struct Fault {
    pub name: &'static str,
    count: Box<dyn Fn(&Scene) -> f32 + Send + Sync>,
}

/// Cloths and all that acts on them.
pub struct Scene {
    pub cloths: Vec<Cloth>,
    pub surroundings: Surroundings,
    /// What no cloth may be inside of: of each obstacle.
    pub solids: Vec<Solid>,
    pub fault: Option<Fault>,
    lead: Option<Lead>,
    frames: u32,
}

impl Scene {
    /// Cloths in a vacuum.
    pub fn new(settings: &Settings, cloths: impl IntoIterator<Item = Cloth>) -> Self {
        let settings = settings.clone();
        Self {
            cloths: cloths.into_iter().collect(),
            surroundings: Surroundings { settings, obstacles: Vec::new(), winds: Vec::new(), fluid_density: 0.0 },
            solids: Vec::new(),
            fault: None,
            lead: None,
            frames: 0,
        }
    }

    /// With something at `place`.
    pub fn with(self, solid: Solid, place: Vec3) -> Self {
        self.with_shape(solid, solid, Isometry3d::from_translation(place))
    }

    /// With something that no cloth may be inside of, at least as far as `solid` goes.
    pub fn with_shape(mut self, shape: impl Into<Shape>, solid: Solid, pose: Isometry3d) -> Self {
        self.surroundings.obstacles.push(Obstacle::still(shape, pose));
        self.solids.push(solid);
        self
    }

    /// With something that happens before each frame, which is told at how many seconds that ends.
    pub fn led_by(mut self, lead: impl Fn(&mut Self, f32) + Send + Sync + 'static) -> Self {
        self.lead = Some(Box::new(lead));
        self
    }

    /// With something of its own to count.
    pub fn judged_by(mut self, name: &'static str, count: impl Fn(&Self) -> f32 + Send + Sync + 'static) -> Self {
        self.fault = Some(Fault { name, count: Box::new(count) });
        self
    }

    /// Moves what moves by itself, for the next frame.
    pub fn lead(&mut self) {
        self.frames += 1;
        let seconds = self.frames as f32 * FRAME;
        if let Some(lead) = self.lead.take() {
            lead(self, seconds);
            self.lead = Some(lead);
        }
        self.surroundings.winds.iter_mut().for_each(|wind| wind.advance(FRAME));
    }

    /// Leads obstacle `i` to `pose` within the next frame.
    pub fn lead_obstacle(&mut self, i: usize, pose: Isometry3d) {
        let obstacle = &mut self.surroundings.obstacles[i];
        (obstacle.start, obstacle.end) = (obstacle.end, pose);
    }

    /// Steps all cloths by a frame. Returns the number of substeps.
    pub fn step(&mut self, pool: Option<&TaskPool>) -> u32 {
        let Self { cloths, surroundings, .. } = self;
        if let [Cloth { topology, particles, rig, scratch, .. }] = cloths.as_mut_slice() {
            return solver::step(particles, topology, &surroundings.context(rig, pool), scratch).substeps;
        }
        let parts = cloths.iter_mut().map(|Cloth { topology, particles, rig, scratch, .. }| {
            (particles, &*topology, surroundings.context(rig, pool), scratch)
        });
        let mut parts: Vec<_> = parts.collect();
        let member = |(particles, topology, ctx, scratch)| Member {
            particles,
            topology,
            ctx,
            scratch,
            offset: Vec3A::ZERO,
            report: None,
        };
        let mut members: Vec<Member> = parts.iter_mut().map(|(p, t, c, s)| member((p, t, c, s))).collect();
        solver::step_together(&mut members);
        members.iter().filter_map(|member| Some(member.report?.substeps)).max().unwrap_or(0)
    }

    /// Triangles of all cloths.
    pub fn triangle_count(&self) -> usize {
        self.cloths.iter().map(|cloth| cloth.topology.triangles.len()).sum()
    }

    /// Where the corners of each triangle of all cloths are, m.
    fn triangles(&self) -> impl Iterator<Item = [Vec3A; 3]> {
        self.cloths.iter().flat_map(|cloth| {
            cloth.topology.triangles.iter().map(|corners| corners.map(|i| cloth.particles.position[i as usize]))
        })
    }
}
