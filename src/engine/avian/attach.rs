//! Pins follow Avian's bodies, and pull at them.

use avian3d::{dynamics::rigid_body::RigidBodyQueryReadOnly, parry::shape::SharedShape, prelude::RigidBodyDisabled};
use bevy::prelude::*;

use super::gather::body_pose;
use crate::{
    engine::{self, Bridge},
    frame::Pass,
    state::{ClothAttachments, ClothState, ClothStatus, StepInput},
};

/// Fixes pins to Avian's bodies.
pub(super) fn attach_pins(
    mut cloths: Query<(Entity, &ClothStatus, &ClothState, &ClothAttachments, &mut StepInput)>,
    bodies: Query<RigidBodyQueryReadOnly, Without<RigidBodyDisabled>>,
    parents: Query<&ChildOf>,
    mut bridge: ResMut<Bridge<SharedShape>>,
) {
    let of = |entity| {
        let mut line = core::iter::once(entity).chain(parents.iter_ancestors(entity));
        let body = line.find_map(|entity| bodies.get(entity).ok())?;
        Some((body.entity, body_pose(&body)))
    };
    for (cloth, status, state, attachments, mut input) in &mut cloths {
        // Late cloth follows bodies as any other entity.
        if status.is_running() && input.pass == Pass::Fixed {
            engine::attach_pins(cloth, (state, attachments, &mut input), &mut bridge.bodies, of);
        }
    }
}
