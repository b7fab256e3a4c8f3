//! The settings that a cloth runs by.

use bevy::prelude::*;

use super::Cloth;
use crate::{
    solver::{CollisionFilter, Material, StepSettings},
    state::ClothState,
};

/// The settings in force: the latest that were valid.
#[derive(Component, Clone, Debug, Default)]
#[component(clone_behavior = Ignore)]
pub(crate) struct InForce {
    pub settings: Cloth,
    /// What follows from them for the solver.
    pub solver: StepSettings,
}

impl InForce {
    /// Those of a cloth whose settings are valid, and whose `state` has its material.
    pub fn new(settings: &Cloth, state: &ClothState) -> Self {
        let moduli = state.material.as_ref().and_then(Material::moduli);
        let solver = StepSettings {
            method: settings.solver.into(),
            substep_policy: settings.substep_policy(&state.topology, moduli),
            max_substeps: settings.max_substeps,
            max_velocity: settings.max_velocity,
            tether_slack: settings.tether_slack.unwrap_or_default(),
            // As far as the cloth is wide enough for it.
            margin: settings.collision_margin.min(state.largest_margin()),
            max_depenetration_velocity: settings.max_depenetration_velocity,
            self_collision: settings.self_collision,
            self_distance: settings.self_distance,
            self_friction: settings.self_friction,
            collision_filter: CollisionFilter { layers: settings.collision_layers, mask: settings.collision_mask },
        };
        Self { settings: settings.clone(), solver }
    }

    /// Whether tethers hold the cloth.
    #[cfg(feature = "debug")]
    pub fn has_tethers(&self) -> bool {
        self.settings.tether_slack.is_some() && self.settings.solver != super::ClothSolver::Explicit
    }
}
