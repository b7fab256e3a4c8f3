//! Pinned particles follow their targets.

use bevy::{
    math::{Affine3A, Vec3A},
    prelude::*,
};

use crate::{
    cloth::ClothStatus,
    draw::mesh::ClothMesh,
    origin,
    pins::{PinTarget, Pins, targets_by_particle},
    pose::{Poses, is_invertible},
    solver::{
        PinMotion,
        build::{blend::BlendWeightBuild, geodesic::TetherBuild},
    },
    state::{ClothState, Work},
    teleport::Jump,
};

mod carrier;

pub(crate) use carrier::Carrier;

/// A fixed particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HeldPin {
    pub particle: u32,
    pub target: PinTarget,
    /// Which of the cloth's carriers that is.
    pub carrier: u32,
    /// Its place in the target's own space, once the target has a pose that can be followed; for
    /// [`PinTarget::World`] its place relative to the cloth's origin.
    pub offset: Option<Vec3A>,
}

/// Reads changed [`Pins`] and re-ties the tethers.
pub(crate) fn update_pins(
    mut cloths: Query<(Entity, &Pins, &mut ClothState, &ClothMesh, &ClothStatus), Changed<Pins>>,
    meshes: Res<Assets<Mesh>>,
    poses: Poses,
) {
    for (entity, pins, mut state, mesh, status) in &mut cloths {
        let Some(source) = meshes.get(&mesh.source) else { continue };
        if *status != ClothStatus::Ready {
            continue;
        }
        let (targets, refused) = targets_by_particle(pins, source, &state.particle_of_vertex, &state.topology);
        match refused.first() {
            None => hold(&mut state, &targets, entity, &poses),
            Some((_, error)) => warn!("cloth {entity} keeps the pins that it had: {error}"),
        }
    }
}

/// Pins particles to their targets where they are now, and lets go of the others.
///
/// A particle that keeps its target keeps its place there.
pub(crate) fn hold(state: &mut ClothState, targets: &[PinTarget], cloth: Entity, poses: &Poses) {
    let mut carriers: Vec<Carrier> = Vec::new();
    let pins: Vec<HeldPin> = (0..)
        .zip(targets)
        .filter(|&(_, &target)| target != PinTarget::Free)
        .map(|(particle, &target)| {
            let held = state.pins.binary_search_by_key(&particle, |pin| pin.particle).ok();
            let kept = held.map(|i| state.pins[i]).filter(|pin| pin.target == target);
            let world_place = || (target == PinTarget::World).then(|| state.particles.position[particle as usize]);
            let offset = kept.map_or_else(world_place, |pin| pin.offset);
            let carrier = carriers.iter().position(|carrier| carrier.target == target).unwrap_or_else(|| {
                let known = state.carriers.iter().find(|carrier| carrier.target == target);
                carriers.push(known.copied().unwrap_or_else(|| Carrier::new(target, cloth, poses)));
                carriers.len() - 1
            });
            HeldPin { particle, target, carrier: carrier as u32, offset }
        })
        .collect();
    if pins == state.pins {
        return;
    }
    let particles: Vec<u32> = pins.iter().map(|pin| pin.particle).collect();
    state.keep_tethers(|pin| particles.binary_search(&pin).is_ok());
    let tied = particles.iter().copied().filter(|particle| !state.attached_pins.contains(particle));
    state.tying = Some(Box::new(TetherBuild::begin(tied.collect())));
    state.blend_weights = None;
    state.blending = (carriers.len() > 1).then(|| {
        let held = pins.iter().map(|pin| (pin.particle, pin.carrier));
        Box::new(BlendWeightBuild::begin(held.collect()))
    });
    state.pins = pins;
    state.carriers = carriers;
    set_masses(state);
    // Takes the places of new pins in their targets' space now, before either moves on.
    plan_anchors(state);
}

/// Distances along the cloth that are worked out in one step: some milliseconds. 64 x 64 particles on two pins are done
/// in one.
const DISTANCES_A_STEP: usize = 12_000;

/// Works on what pins have asked for: tethers, by whose old ones a large cloth hangs meanwhile, and weights of the carriers
/// that it is drawn with.
pub(crate) fn tie_tethers(mut cloths: Query<(&mut ClothState, &ClothStatus)>) {
    for (mut state, status) in &mut cloths {
        if *status != ClothStatus::Ready || state.tying.is_none() && state.blending.is_none() {
            continue;
        }
        let state = &mut *state;
        if let Some(mut blending) = state.blending.take() {
            if blending.go_on(&state.topology, DISTANCES_A_STEP) {
                state.blend_weights = Some(blending.finish());
            } else {
                state.blending = Some(blending);
            }
        }
        if let Some(mut tying) = state.tying.take() {
            if tying.go_on(state.built_topology(), DISTANCES_A_STEP) {
                state.set_tethers(tying.finish(state.built_topology()));
            } else {
                state.tying = Some(tying);
            }
        }
    }
}

/// Gives free particles their mass, and fixed ones none that could be moved.
pub(crate) fn set_masses(state: &mut ClothState) {
    let Some(material) = &state.material else { return };
    let mut is_fixed = vec![false; state.particles.len()];
    for pin in &state.pins {
        is_fixed[pin.particle as usize] = true;
    }
    state.particles.set_masses(&state.topology, material, |i| is_fixed[i]);
}

/// Plans the way of every pinned particle over the coming step. A cloth that jumps, or whose pins all do, jumps along first.
pub(crate) fn follow_targets(mut cloths: Query<(Entity, &mut ClothState, &ClothStatus)>, poses: Poses) {
    for (entity, mut state, status) in &mut cloths {
        if *status != ClothStatus::Ready {
            continue;
        }
        let state = &mut *state;
        for carrier in &mut state.carriers {
            carrier.follow(entity, &poses);
        }
        let mut jump = None;
        if let Ok(pose) = poses.compute_global_transform(entity) {
            let pose = pose.affine();
            jump = take_asked_jump(state, pose);
            state.pose = pose;
            state.follow_scale();
        }
        if jump.is_none() {
            jump = Carrier::common_jump(&state.carriers);
            if let Some(jump) = &jump {
                origin::carry(state, jump);
            }
        }
        if jump.is_some() {
            state.carriers.iter_mut().for_each(Carrier::forget_way);
        }
        state.work.jump = jump;
        origin::stay_near(state);
        plan_anchors(state);
    }
}

/// Does the jump to `pose` that has been asked for, and tells of the one that a reset has been.
fn take_asked_jump(state: &mut ClothState, pose: Affine3A) -> Option<Jump> {
    let reset_from = state.requests.reset_from.take();
    if core::mem::take(&mut state.requests.teleport) {
        let jump = Jump::between(state.pose, pose)?;
        origin::carry(state, &jump);
        return Some(jump);
    }
    Jump::between(reset_from?, pose)
}

fn plan_anchors(state: &mut ClothState) {
    let origin = Vec3A::from(state.origin);
    let Work { pin_motions, body_attachments, mount_owners, attached_pins, .. } = &mut state.work;
    pin_motions.clear();
    // Bridges to physics engines fill these.
    body_attachments.clear();
    mount_owners.clear();
    attached_pins.clear();
    for pin in &mut state.pins {
        let carrier = &state.carriers[pin.carrier as usize];
        let place = &mut state.particles.position[pin.particle as usize];
        let end = match (pin.target, carrier.pose()) {
            (PinTarget::World, _) => pin.offset.unwrap_or(*place),
            (_, Some(pose)) => {
                let from_pose = pose.translation - origin;
                let offset = *pin.offset.get_or_insert_with(|| pose.matrix3.inverse() * (*place - from_pose));
                pose.matrix3 * offset + from_pose
            }
            // The target is gone, flat or not there yet: stay.
            (_, None) => *place,
        };
        let end = if end.is_finite() { end } else { *place };
        if carrier.has_jumped() {
            *place = end;
        }
        pin_motions.push(PinMotion { particle: pin.particle, start: *place, end });
    }
}

/// The entity that a target's pins follow.
pub(crate) fn target_entity(target: PinTarget, cloth: Entity) -> Option<Entity> {
    match target {
        PinTarget::Cloth => Some(cloth),
        PinTarget::Entity(entity) => entity,
        PinTarget::World | PinTarget::Free => None,
    }
}

/// The pose that a target's pins follow. None for the world, an entity that is gone, and a transform that is flat.
fn target_pose(target: PinTarget, cloth: Entity, poses: &Poses) -> Option<Affine3A> {
    let pose = poses.compute_global_transform(target_entity(target, cloth)?).ok()?.affine();
    is_invertible(&pose).then_some(pose)
}
