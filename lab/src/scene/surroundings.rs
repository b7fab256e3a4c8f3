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
        StepContext {
            gravity: Vec3A::NEG_Y * 9.81,
            fluid_density: self.fluid_density,
            pin_motions: &rig.pin_motions,
            tethers: rig.tethers.as_ref(),
            obstacles: &self.obstacles,
            winds: &self.winds,
            pool,
            ..StepContext::new(FRAME, &rig.settings, self.settings.material)
        }
    }
}
