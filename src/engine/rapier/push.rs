//! Moves Rapier's bodies as cloth has pushed them.

use bevy::prelude::*;
use bevy_rapier3d::{
    parry::{math::Pose, shape::SharedShape},
    plugin::context::{RapierContextColliders, RapierContextEntityLink, RapierRigidBodySet},
    prelude::{RapierColliderHandle, RapierRigidBodyHandle, TransformInterpolation, Velocity},
};

use super::shapes;
use crate::engine::{Bridge, Pushes, carry, strayed};

/// Gives the bodies what cloth has lost to them in the latest step. That wakes those that sleep.
pub(super) fn push_bodies(
    pushes: Res<Pushes>,
    handles: Query<(&RapierContextEntityLink, Option<&RapierRigidBodyHandle>, Option<&RapierColliderHandle>)>,
    mut contexts: Query<(&mut RapierRigidBodySet, &RapierContextColliders)>,
    mut shown: Query<(Option<&mut Velocity>, Option<&mut Transform>, Has<TransformInterpolation>, Has<ChildOf>)>,
    mut bridge: ResMut<Bridge<SharedShape>>,
) {
    for push in &pushes.list {
        let Ok((context, body, collider)) = handles.get(push.to) else { continue };
        let Ok((mut bodies, colliders)) = contexts.get_mut(context.0) else { continue };
        let of_collider = || colliders.colliders.get(collider?.0)?.parent();
        let Some(handle) = body.map(|body| body.0).or_else(of_collider) else { continue };
        let Some(entity) = bodies.rigid_body_entity(handle) else { continue };
        let Some(body) = bodies.bodies.get_mut(handle).filter(|body| body.is_dynamic() && body.is_enabled()) else {
            continue;
        };
        let mass = body.mass_properties();
        let velocity = mass.effective_inv_mass * Vec3::from(push.impulse.linear);
        let turn = mass.effective_world_inv_inertia * Vec3::from(push.impulse.angular);
        let from = shapes::isometry(body.position());
        let to = strayed(from, body.local_center_of_mass(), &push.displacement);
        body.set_position(Pose::from_parts(to.translation.into(), to.rotation), true);
        body.set_linvel(body.linvel() + velocity, true);
        body.set_angvel(body.angvel() + turn, true);
        bridge.bodies.moved(entity, to, body.linvel());
        let Ok((shown_velocity, transform, is_interpolated, is_child)) = shown.get_mut(entity) else { continue };
        // Rapier takes over components that have changed, as its own have in this step.
        if let Some(mut shown) = shown_velocity {
            (shown.linear, shown.angular) = (body.linvel(), body.angvel());
        }
        if let Some(mut transform) = transform.filter(|_| !is_interpolated && !is_child) {
            carry(&mut transform, from, to);
        }
    }
}
