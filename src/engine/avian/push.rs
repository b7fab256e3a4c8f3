//! Moves Avian's bodies as cloth has pushed them.

use avian3d::{
    dynamics::rigid_body::RigidBodyQuery,
    parry::shape::SharedShape,
    prelude::{ColliderOf, RigidBodyDisabled},
};
use bevy::prelude::*;

use super::gather::pose;
use crate::engine::{Bridge, Pushes, carry, strayed};

/// Gives the bodies what cloth has lost to them in the latest step. That wakes those that sleep.
pub(super) fn push_bodies(
    pushes: Res<Pushes>,
    colliders: Query<&ColliderOf>,
    mut bodies: Query<(RigidBodyQuery, Option<&mut Transform>), Without<RigidBodyDisabled>>,
    mut bridge: ResMut<Bridge<SharedShape>>,
) {
    for push in &pushes.list {
        let entity = colliders.get(push.to).map_or(push.to, |of| of.body);
        let Ok((mut body, transform)) = bodies.get_mut(entity) else { continue };
        if !body.rb.is_dynamic() {
            continue;
        }
        let velocity = body.effective_inverse_mass() * Vec3::from(push.impulse.linear);
        let turn = Mat3::from(body.effective_global_angular_inertia().inverse()) * Vec3::from(push.impulse.angular);
        let from = pose(&body.position, &body.rotation);
        let to = strayed(from, body.center_of_mass.0, &push.displacement);
        body.position.0 = to.translation.into();
        body.rotation.0 = to.rotation;
        body.linear_velocity.0 += velocity;
        body.angular_velocity.0 += turn;
        if let Some(mut transform) = transform {
            carry(&mut transform, from, to);
        }
        bridge.bodies.moved(entity, to, body.linear_velocity.0);
    }
}
