//! Pins that follow a body of an engine's pull at it.

use bevy::{math::Vec3A, prelude::*};

use super::{Bodies, BodyPose};
use crate::{
    frame::Poses,
    pins::PinTarget,
    solver::{AttachedPin, Body, BodyAttachment},
    state::{ClothAttachments, ClothState, ClothStatus, StepInput, target_entity},
};

/// Fixes the pins of a cloth to the bodies that an engine has, given those `of` entities: a pin's target, one of its
/// parents or none.
pub(crate) fn attach_pins(
    cloth: Entity,
    (state, attachments, input): (&ClothState, &ClothAttachments, &mut StepInput),
    bodies: &mut Bodies,
    of: impl Fn(Entity) -> Option<(Entity, BodyPose)>,
) {
    let origin = Vec3A::from(state.origin);
    // Pins of one target stand together mostly: its body is looked up once.
    let mut latest: Option<(PinTarget, Option<u32>)> = None;
    for (number, pin) in (0..).zip(&attachments.pins) {
        let attachment = match latest {
            Some((target, attachment)) if target == pin.target => attachment,
            _ => target_entity(pin.target, cloth).and_then(&of).and_then(|(entity, body_pose)| {
                let known = input.attachment_owners.iter().position(|&owner| owner == entity);
                let known = known.map(|known| known as u32);
                known.or_else(|| {
                    let attachment = attachment_to(bodies, entity, &body_pose, origin)?;
                    input.body_attachments.push(attachment);
                    input.attachment_owners.push(entity);
                    Some(input.body_attachments.len() as u32 - 1)
                })
            }),
        };
        latest = Some((pin.target, attachment));
        input.attached_pins.extend(attachment.map(|attachment| AttachedPin { pin_motion: number, attachment }));
    }
}

/// A body as something to fix pins to. None where nothing moves it.
fn attachment_to(bodies: &mut Bodies, entity: Entity, body_pose: &BodyPose, origin: Vec3A) -> Option<BodyAttachment> {
    let motion = bodies.motion(entity, body_pose);
    let (body, dynamic) = motion.body.zip(body_pose.dynamic)?;
    let attachment = BodyAttachment {
        body: Body { centre: body.centre - origin, ..body },
        displacement: motion.end * dynamic.centre - motion.start * dynamic.centre,
    };
    (attachment.body.centre.is_finite() && attachment.displacement.is_finite()).then_some(attachment)
}

/// Ties tethers to pins on bodies no more, and again to those that are on none by now: a tether doesn't pull at its pin.
pub(crate) fn untie_attached(mut cloths: Query<(&StepInput, &mut ClothAttachments, &ClothStatus)>) {
    for (input, mut attachments, status) in &mut cloths {
        let on_bodies = || input.attached_pins.iter().map(|it| input.pin_motions[it.pin_motion as usize].particle);
        if !status.is_running() || on_bodies().eq(attachments.on_bodies.iter().copied()) {
            continue;
        }
        let on_bodies: Vec<u32> = on_bodies().collect();
        attachments.keep_tethers(|pin| !on_bodies.contains(&pin));
        attachments.on_bodies = on_bodies;
        attachments.begin_tethers();
    }
}

/// Cloth is drawn with the entity that carries it: one that it has pulled along is where it is by now.
pub(crate) fn note_anchors(mut cloths: Query<(&StepInput, &mut ClothAttachments)>, poses: Poses) {
    for (input, mut attachments) in &mut cloths {
        if input.body_attachments.is_empty() {
            continue;
        }
        for anchor in &mut attachments.bypass_change_detection().anchors {
            let end = anchor.entity.and_then(|entity| poses.compute_global_transform(entity).ok());
            if let Some(end) = end {
                anchor.end = end.affine();
            }
        }
    }
}
