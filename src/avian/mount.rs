//! Pins follow Avian's bodies, and pull at them.

use avian3d::{dynamics::rigid_body::RigidBodyQueryReadOnly, parry::shape::SharedShape, prelude::RigidBodyDisabled};
use bevy::prelude::*;

use super::gather::mover;
use crate::{
    cloth::ClothStatus,
    engine::{self, Bridge},
    state::ClothState,
};

/// Fixes pins to Avian's bodies.
pub(super) fn mount_pins(
    mut cloths: Query<(Entity, &mut ClothState, &ClothStatus)>,
    bodies: Query<RigidBodyQueryReadOnly, Without<RigidBodyDisabled>>,
    parents: Query<&ChildOf>,
    mut bridge: ResMut<Bridge<SharedShape>>,
) {
    let of = |entity| {
        let mut line = core::iter::once(entity).chain(parents.iter_ancestors(entity));
        let body = line.find_map(|entity| bodies.get(entity).ok())?;
        Some((body.entity, mover(&body)))
    };
    for (cloth, mut state, status) in &mut cloths {
        if *status == ClothStatus::Ready {
            engine::mount_pins(cloth, state.bypass_change_detection(), &mut bridge.bodies, of);
        }
    }
}
