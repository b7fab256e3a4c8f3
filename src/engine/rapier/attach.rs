//! Pins follow Rapier's bodies, and pull at them.

use bevy::prelude::*;
use bevy_rapier3d::{
    parry::shape::SharedShape,
    plugin::context::{RapierContextEntityLink, RapierRigidBodySet},
    prelude::RapierRigidBodyHandle,
};

use super::gather::body_pose;
use crate::{
    engine::{self, Bridge},
    frame::Pass,
    state::{ClothAttachments, ClothState, ClothStatus, StepInput},
};

/// Fixes pins to Rapier's bodies.
pub(super) fn attach_pins(
    mut cloths: Query<(Entity, &ClothStatus, &ClothState, &ClothAttachments, &mut StepInput)>,
    handles: Query<(&RapierContextEntityLink, &RapierRigidBodyHandle)>,
    contexts: Query<&RapierRigidBodySet>,
    parents: Query<&ChildOf>,
    mut bridge: ResMut<Bridge<SharedShape>>,
) {
    let of = |entity| {
        let mut line = core::iter::once(entity).chain(parents.iter_ancestors(entity));
        let (entity, (context, handle)) = line.find_map(|entity| Some((entity, handles.get(entity).ok()?)))?;
        let body = contexts.get(context.0).ok()?.bodies.get(handle.0)?;
        body.is_enabled().then(|| (entity, body_pose(body)))
    };
    for (cloth, status, state, attachments, mut input) in &mut cloths {
        // Late cloth follows bodies as any other entity.
        if status.is_running() && input.pass == Pass::Fixed {
            engine::attach_pins(cloth, (state, attachments, &mut input), &mut bridge.bodies, of);
        }
    }
}
