//! Pins that follow a body of an engine's pull at it.

use bevy::{math::Vec3A, prelude::*};

use super::{Bodies, Mover};
use crate::{
    anchor,
    cloth::ClothStatus,
    pins::PinTarget,
    pose::Poses,
    solver::{AttachedPin, Body, BodyAttachment, build::geodesic::TetherBuild},
    state::ClothState,
};

/// Fixes the pins of a cloth to the bodies that an engine has, given those `of` entities: a pin's target, one of its
/// parents or none.
pub(crate) fn mount_pins(
    cloth: Entity,
    state: &mut ClothState,
    bodies: &mut Bodies,
    of: impl Fn(Entity) -> Option<(Entity, Mover)>,
) {
    let origin = Vec3A::from(state.origin);
    let work = &mut state.work;
    // Pins of one target stand together mostly: its body is looked up once.
    let mut latest: Option<(PinTarget, Option<u32>)> = None;
    for (number, pin) in (0..).zip(&state.pins) {
        let mount = match latest {
            Some((target, mount)) if target == pin.target => mount,
            _ => anchor::target_entity(pin.target, cloth).and_then(&of).and_then(|(entity, mover)| {
                let known = work.mount_owners.iter().position(|&owner| owner == entity);
                let known = known.map(|known| known as u32);
                known.or_else(|| {
                    let mount = mount(bodies, entity, &mover, origin)?;
                    work.body_attachments.push(mount);
                    work.mount_owners.push(entity);
                    Some(work.body_attachments.len() as u32 - 1)
                })
            }),
        };
        latest = Some((pin.target, mount));
        work.attached_pins.extend(mount.map(|mount| AttachedPin { anchor: number, mount }));
    }
}

/// A body as something to fix anchors to. None where nothing moves it.
fn mount(bodies: &mut Bodies, entity: Entity, mover: &Mover, origin: Vec3A) -> Option<BodyAttachment> {
    let way = bodies.way(entity, mover);
    let (body, dynamic) = way.body.zip(mover.dynamic)?;
    let mount = BodyAttachment {
        body: Body { centre: body.centre - origin, ..body },
        way: way.end * dynamic.centre - way.start * dynamic.centre,
    };
    (mount.body.centre.is_finite() && mount.way.is_finite()).then_some(mount)
}

/// Ties tethers to pins on bodies no more, and again to those that are on none by now: a tether doesn't pull at its pin.
pub(crate) fn untie_mounted(mut cloths: Query<(&mut ClothState, &ClothStatus)>) {
    for (mut state, status) in &mut cloths {
        let is_known = |state: &ClothState| {
            let attached_pins =
                state.work.attached_pins.iter().map(|it| state.work.pin_motions[it.anchor as usize].particle);
            attached_pins.eq(state.attached_pins.iter().copied())
        };
        if *status != ClothStatus::Ready || is_known(&state) {
            continue;
        }
        let state = &mut *state;
        let work = &state.work;
        state.attached_pins.clear();
        state.attached_pins.extend(work.attached_pins.iter().map(|it| work.pin_motions[it.anchor as usize].particle));
        let attached_pins = state.attached_pins.clone();
        state.keep_tethers(|pin| !attached_pins.contains(&pin));
        let pins = &state.pins;
        let tied = pins.iter().map(|pin| pin.particle).filter(|particle| !attached_pins.contains(particle));
        state.tying = Some(Box::new(TetherBuild::begin(tied.collect())));
    }
}

/// Cloth is drawn with the entity that carries it: one that it has pulled along is where it is by now.
pub(crate) fn note_carriers(mut cloths: Query<&mut ClothState>, poses: Poses) {
    for mut state in &mut cloths {
        if state.work.body_attachments.is_empty() {
            continue;
        }
        for carrier in &mut state.bypass_change_detection().carriers {
            let end = carrier.entity.and_then(|entity| poses.compute_global_transform(entity).ok());
            if let Some(end) = end {
                carrier.end = end.affine();
            }
        }
    }
}
