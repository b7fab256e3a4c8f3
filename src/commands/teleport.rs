//! Puts entities elsewhere, and what is on them and below them.

use bevy::prelude::*;

use crate::{
    frame::{Steps, Teleported},
    state::Requests,
};

/// What comes along where an entity is teleported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Along {
    /// Obstacles, and what is pinned to them.
    Colliders,
    /// Cloths too, pinned or not.
    Cloths,
}

/// Has an entity, and all below it, come from nowhere in the next step.
pub(super) fn teleport(world: &mut World, root: Entity, along: Along) {
    let Some(step) = world.get_resource::<Steps>().map(Steps::present) else { return };
    let mut left = vec![root];
    while let Some(entity) = left.pop() {
        left.extend(world.get::<Children>(entity).into_iter().flat_map(|children| children.iter()));
        if let Some(mut teleported) = world.get_resource_mut::<Teleported>() {
            teleported.insert(entity, step);
        }
        if along == Along::Cloths
            && let Some(mut requests) = world.get_mut::<Requests>(entity)
        {
            requests.teleport = true;
        }
    }
}
