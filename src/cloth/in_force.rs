//! The settings that a cloth runs by.

use bevy::prelude::*;

use super::Cloth;
use crate::{solver::SubstepPolicy, state::ClothState};

/// The settings in force: the latest that were valid.
#[derive(Component, Clone, Debug, Default)]
#[component(clone_behavior = Ignore)]
pub(crate) struct InForce {
    pub settings: Cloth,
    /// Substeps and levels that follow from the settings.
    pub policy: SubstepPolicy,
}

impl InForce {
    /// Those of a cloth whose settings are valid.
    pub fn new(settings: &Cloth, state: &ClothState) -> Self {
        Self { settings: settings.clone(), policy: settings.substep_policy(&state.topology) }
    }

    /// Distance in m that the cloth keeps from obstacles beyond its fabric's thickness.
    pub fn collision_margin(&self, state: &ClothState) -> f32 {
        self.settings.collision_margin.min(state.largest_margin())
    }

    /// Whether tethers hold the cloth.
    #[cfg(feature = "debug")]
    pub fn has_tethers(&self) -> bool {
        self.settings.tether_slack.is_some() && self.settings.solver != super::ClothSolver::Explicit
    }
}
