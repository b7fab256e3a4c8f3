//! Reads Rapier's colliders.

use bevy::{
    math::{Isometry3d, Mat3A},
    prelude::*,
};
use bevy_rapier3d::{
    parry::shape::SharedShape,
    plugin::context::{RapierContextColliders, RapierContextEntityLink, RapierRigidBodySet},
    prelude::{CollisionGroups, RapierColliderHandle},
    rapier::{dynamics::RigidBody, geometry::InteractionGroups},
};

use super::{ClothRapierSettings, shapes};
use crate::{
    engine::{BodyPose, Bridge, Dynamic, EngineCollider, NotClothCollider, friction_factor},
    frame::JumpDetection,
    surroundings::collider::{ClothCollider, Obstacles},
};

/// Adds Rapier's colliders to the obstacles of the coming step.
pub(super) fn gather_colliders(
    colliders: Query<
        (Entity, &RapierColliderHandle, &RapierContextEntityLink),
        (Without<ClothCollider>, Without<NotClothCollider>),
    >,
    contexts: Query<(&RapierRigidBodySet, &RapierContextColliders)>,
    left_out: Query<(), With<NotClothCollider>>,
    settings: Res<ClothRapierSettings>,
    jumps: JumpDetection,
    mut bridge: ResMut<Bridge<SharedShape>>,
    mut obstacles: ResMut<Obstacles>,
) {
    bridge.begin(&jumps);
    for (entity, handle, context) in &colliders {
        let Ok((bodies, colliders)) = contexts.get(context.0) else { continue };
        let Some(collider) = colliders.colliders.get(handle.0) else { continue };
        let groups = collider.collision_groups();
        if !collider.is_enabled() || collider.is_sensor() || !are_met(groups, settings.groups) {
            continue;
        }
        let body = collider.parent().and_then(|handle| bodies.bodies.get(handle).zip(bodies.rigid_body_entity(handle)));
        let (body, body_pose, place) = match body {
            Some((_, body)) if left_out.contains(body) => continue,
            Some((body, entity)) => {
                let place = collider.position_wrt_parent().map_or(Isometry3d::IDENTITY, shapes::isometry);
                (entity, body_pose(body), place)
            }
            None => {
                let body_pose = BodyPose { pose: shapes::isometry(collider.position()), dynamic: None };
                (entity, body_pose, Isometry3d::IDENTITY)
            }
        };
        let shape = collider.shared_shape();
        let parts = bridge.shapes.parts(shapes::address(shape), shape, || shapes::convert(entity, &**shape));
        bridge.add(EngineCollider {
            collider: entity,
            layers: groups.memberships.bits(),
            friction: friction_factor(collider.friction()),
            body,
            body_pose,
            place,
            parts,
        });
    }
    bridge.end(&mut obstacles);
}

/// Whether a collider and all cloth want to meet.
fn are_met(collider: InteractionGroups, cloth: CollisionGroups) -> bool {
    collider.memberships.bits() & cloth.filters.bits() != 0 && cloth.memberships.bits() & collider.filter.bits() != 0
}

pub(super) fn body_pose(body: &RigidBody) -> BodyPose {
    let mass = body.mass_properties();
    let inertia = mass.effective_world_inv_inertia;
    let columns = [
        Vec3::new(inertia.m11, inertia.m12, inertia.m13),
        Vec3::new(inertia.m12, inertia.m22, inertia.m23),
        Vec3::new(inertia.m13, inertia.m23, inertia.m33),
    ];
    let dynamic = body.is_dynamic().then(|| Dynamic {
        velocity: body.linvel(),
        // Along locked axes the body doesn't go where cloth pushes it; what it gets there is lost.
        inverse_mass: mass.effective_inv_mass.max_element(),
        inverse_inertia: Mat3A::from(Mat3::from_cols(columns[0], columns[1], columns[2])),
        centre: body.local_center_of_mass().into(),
    });
    BodyPose { pose: shapes::isometry(body.position()), dynamic }
}
