//! The standard scenes, so that every measurement means the same cloth: their cloths, what surrounds these, and what happens.
//!
//! Here is what the lab and the tests share; nothing knows the command line.

use bevy::{
    math::{Isometry3d, Vec3A},
    prelude::*,
    tasks::TaskPool,
};
use bevy_drape::solver::{self, Member, Obstacle, Shape, Solid};

mod cloth;
mod crossing;
mod depth;
mod look;
mod settings;
mod surroundings;
mod wave;

pub mod bullet;
pub mod drape;
pub mod fold;
pub mod layers;
pub mod needle;
pub mod ribbon;
pub mod storm;
pub mod twist;

pub use cloth::{Cloth, Rig};
pub use look::Look;
pub use settings::{DENSITY, STIFFNESS, Settings};
pub use surroundings::Surroundings;

/// Duration of a frame, s.
pub const FRAME: f32 = 1.0 / 60.0;

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
