//! What acts on all cloths of a scene.

use bevy::{math::Vec3A, tasks::TaskPool};
use bevy_drape::solver::{Obstacle, StepContext, WindSource};

use super::{FRAME, Rig, Settings};

/// Obstacles, wind and air.
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
            pin_motions: &rig.pin_motions,
            body_attachments: &[],
            attached_pins: &[],
            grabs: &[],
            max_velocity: 50.0,
            tethers: rig.tethers.as_ref(),
            tether_slack: settings.tether_slack,
            margin: settings.margin,
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
