//! What a cloth waits for while tasks work on it.

use std::sync::Arc;

use bevy::{math::Mat3A, prelude::*};

use crate::solver::Topology;

/// What a cloth waits for, or the cloth that is to take its place.
#[derive(Component, Clone, Debug, Default)]
#[component(clone_behavior = Ignore)]
pub(crate) struct PendingBuild(pub Option<BuildKey>);

/// What is built for a cloth whose mesh is large.
#[derive(Clone, Debug)]
pub(crate) struct BuildKey {
    /// The rotation and scale that its topology is made for.
    pub to_world: Mat3A,
    /// Between which particles its tethers are, once it has a topology.
    pub tethers: Option<TetherKey>,
}

/// The pins of a topology, to which tethers are worked out.
#[derive(Clone, Debug)]
pub(crate) struct TetherKey {
    pub topology: Arc<Topology>,
    pub pins: Arc<[u32]>,
}

impl PartialEq for TetherKey {
    /// Of the very same topology.
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.topology, &other.topology) && self.pins == other.pins
    }
}
