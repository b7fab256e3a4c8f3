//! Reads Avian's colliders.

use avian3d::{
    dynamics::rigid_body::{RigidBodyQueryReadOnly, RigidBodyQueryReadOnlyItem},
    parry::shape::SharedShape,
    prelude::{
        Collider, ColliderDisabled, ColliderOf, ColliderTransform, CollisionLayers, DefaultFriction, Friction,
        Position, RigidBodyDisabled, Rotation, Sensor,
    },
};
use bevy::{
    ecs::query::QueryData,
    math::{Isometry3d, Mat3A},
    prelude::*,
};

use super::{ClothAvianSettings, shapes};
use crate::{
    engine::{BodyPose, Bridge, Dynamic, EngineCollider, NotClothCollider, friction_factor},
    frame::JumpDetection,
    surroundings::collider::{ClothCollider, Obstacles},
};

/// A collider of Avian's.
#[derive(QueryData)]
pub(super) struct AvianCollider {
    entity: Entity,
    collider: &'static Collider,
    position: &'static Position,
    rotation: &'static Rotation,
    of: Option<&'static ColliderOf>,
    place: Option<&'static ColliderTransform>,
    layers: Option<&'static CollisionLayers>,
    friction: Option<&'static Friction>,
}

/// What cloth doesn't meet.
type IsMet = (Without<ColliderDisabled>, Without<Sensor>, Without<ClothCollider>, Without<NotClothCollider>);

/// Adds Avian's colliders to the obstacles of the coming step.
pub(super) fn gather_colliders(
    colliders: Query<AvianCollider, IsMet>,
    bodies: Query<(RigidBodyQueryReadOnly, Has<RigidBodyDisabled>, Has<NotClothCollider>)>,
    (settings, default_friction): (Res<ClothAvianSettings>, Option<Res<DefaultFriction>>),
    jumps: JumpDetection,
    mut bridge: ResMut<Bridge<SharedShape>>,
    mut obstacles: ResMut<Obstacles>,
) {
    bridge.begin(&jumps);
    let default_friction = default_friction.map_or_else(Friction::default, |default| default.0);
    for it in &colliders {
        let layers = it.layers.copied().unwrap_or_default();
        // Until Avian has seen it, it isn't anywhere.
        let is_placed = *it.position != Position::PLACEHOLDER;
        if !is_placed || !layers.interacts_with(settings.layers) {
            continue;
        }
        let body = it.of.and_then(|of| bodies.get(of.body).ok());
        if body.as_ref().is_some_and(|&(_, is_disabled, is_left_out)| is_disabled || is_left_out) {
            continue;
        }
        let friction = it.friction.or(body.as_ref().and_then(|(body, ..)| body.friction)).unwrap_or(&default_friction);
        let own =
            || (it.entity, BodyPose { pose: pose(it.position, it.rotation), dynamic: None }, Isometry3d::IDENTITY);
        let (body, body_pose, place) = match &body {
            Some((body, ..)) => (body.entity, body_pose(body), it.place.map_or(Isometry3d::IDENTITY, place)),
            None => own(),
        };
        let shape = it.collider.shape_scaled();
        let parts = bridge.shapes.parts(shapes::address(shape), shape, || shapes::convert(it.entity, &**shape));
        bridge.add(EngineCollider {
            collider: it.entity,
            layers: layers.memberships.0,
            friction: friction_factor(friction.dynamic_coefficient),
            body,
            body_pose,
            place,
            parts,
        });
    }
    bridge.end(&mut obstacles);
}

pub(super) fn pose(position: &Position, rotation: &Rotation) -> Isometry3d {
    Isometry3d::new(position.0, rotation.0)
}

fn place(place: &ColliderTransform) -> Isometry3d {
    Isometry3d::new(place.translation, place.rotation.0)
}

pub(super) fn body_pose(body: &RigidBodyQueryReadOnlyItem) -> BodyPose {
    let dynamic = body.rb.is_dynamic().then(|| Dynamic {
        velocity: body.linear_velocity.0,
        // Along locked axes the body doesn't go where cloth pushes it; what it gets there is lost.
        inverse_mass: body.effective_inverse_mass().max_element(),
        inverse_inertia: Mat3A::from(Mat3::from(body.effective_global_angular_inertia().inverse())),
        centre: body.center_of_mass.0.into(),
    });
    BodyPose { pose: pose(body.position, body.rotation), dynamic }
}
