//! Pinned particles follow their targets.

use bevy::{
    ecs::{query::QueryData, system::NonSendMarker},
    math::{Affine3A, Vec3A},
    prelude::*,
};

use super::skeleton;
use crate::{
    draw::ClothMesh,
    frame::{self, ClothRun, Jump, Poses, Skeletons, Steps},
    pins::{PinTarget, Pins, targets_by_particle},
    skin::{ClothInertia, ClothSkin, ClothTeleport},
    solver::{PinMotion, build::blend::BlendWeightBuild},
    state::{
        self, ClothAttachments, ClothGrabs, ClothState, ClothStatus, HeldPin, PinAnchor, Requests, Skinning, StepInput,
        Warned,
    },
};

/// Reads changed [`Pins`] and has the tethers worked out anew.
pub(crate) fn update_pins(
    mut cloths: Query<
        (
            Entity,
            (&Pins, Option<&ClothSkin>),
            (&ClothMesh, &ClothStatus),
            &mut ClothState,
            &mut ClothAttachments,
            &mut StepInput,
            &mut Skinning,
        ),
        Or<(Changed<Pins>, Changed<ClothSkin>)>,
    >,
    meshes: Res<Assets<Mesh>>,
    poses: Poses,
) {
    for (entity, (pins, skin), (mesh, status), mut state, mut attachments, mut input, mut skinning) in &mut cloths {
        let Some(source) = meshes.get(&mesh.source) else { continue };
        if !status.is_running() || input.pass != poses.pass() {
            continue;
        }
        let (mut targets, refused) = targets_by_particle(pins, source, &state.particle_of_vertex, &state.topology);
        if let Some(bound) = &mut skinning.0 {
            let skin = skin.cloned().unwrap_or_default();
            match skin.validate() {
                Ok(()) => bound.settings = skin,
                Err(error) => warn!("cloth {entity} keeps the skin that it had: {error}"),
            }
            let limits = bound.settings.limits(source, &state.particle_of_vertex, state.particles.len());
            limits.fix(&mut targets);
            bound.limit(&limits.limits, &state.topology);
            state.is_disturbed = true;
        }
        match refused.first() {
            None => hold(&mut state, &mut attachments, &mut input, &targets, (entity, &skinning), &poses),
            Some((_, error)) => warn!("cloth {entity} keeps the pins that it had: {error}"),
        }
    }
}

/// Without a [`ClothSkin`], the defaults are in force again.
pub(crate) fn on_skin_removed(removed: On<Remove, ClothSkin>, mut pins: Query<&mut Pins>) {
    if let Ok(mut pins) = pins.get_mut(removed.entity) {
        pins.set_changed();
    }
}

/// Pins particles to their targets where they are now, and lets go of the others.
///
/// A particle that keeps its target keeps its place there.
pub(crate) fn hold(
    state: &mut ClothState,
    attachments: &mut ClothAttachments,
    input: &mut StepInput,
    targets: &[PinTarget],
    (cloth, skinning): (Entity, &Skinning),
    poses: &Poses,
) {
    let carrier = skinning.carrier(cloth);
    let mut anchors: Vec<PinAnchor> = Vec::new();
    let pins: Vec<HeldPin> = (0..)
        .zip(targets)
        .filter(|&(_, &target)| target != PinTarget::Free)
        .map(|(particle, &target)| {
            let held = attachments.pins.binary_search_by_key(&particle, |pin| pin.particle).ok();
            let kept = held.map(|i| attachments.pins[i]).filter(|pin| pin.target == target);
            let world_place = || (target == PinTarget::World).then(|| state.particles.position[particle as usize]);
            let offset = kept.map_or_else(world_place, |pin| pin.offset);
            let anchor = anchors.iter().position(|anchor| anchor.target == target).unwrap_or_else(|| {
                let known = attachments.anchors.iter().find(|anchor| anchor.target == target);
                anchors.push(known.copied().unwrap_or_else(|| PinAnchor::new(target, carrier, poses)));
                anchors.len() - 1
            });
            HeldPin { particle, target, anchor: anchor as u32, offset }
        })
        .collect();
    if pins == attachments.pins {
        return;
    }
    attachments.blend_weights = None;
    attachments.blend_build = (anchors.len() > 1).then(|| {
        let held = pins.iter().map(|pin| (pin.particle, pin.anchor));
        Box::new(BlendWeightBuild::begin(held.collect()))
    });
    attachments.pins = pins;
    attachments.anchors = anchors;
    let particles: Vec<u32> = attachments.pins.iter().map(|pin| pin.particle).collect();
    attachments.keep_tethers(|pin| particles.binary_search(&pin).is_ok());
    attachments.begin_tethers();
    state.set_masses(&attachments.pins);
    // Takes the places of new pins in their targets' space now, before either moves on.
    plan_motions(state, attachments, input, skinning);
}

/// Distances along the cloth that are worked out in one step: some milliseconds. 64 x 64 particles on two pins are done
/// in one.
const DISTANCES_A_STEP: usize = 12_000;

/// Works on what pins have asked for: tethers, by whose old ones a large cloth hangs meanwhile, and weights of the anchors
/// that it is drawn with.
pub(crate) fn advance_builds(
    mut cloths: Query<(&mut ClothState, &mut ClothAttachments, &ClothStatus, &StepInput)>,
    steps: Res<Steps>,
) {
    for (mut state, mut attachments, status, input) in &mut cloths {
        let is_idle = attachments.tether_build.is_none() && attachments.blend_build.is_none();
        if !status.is_running() || is_idle || input.pass != steps.pass() {
            continue;
        }
        if let Some(mut build) = attachments.blend_build.take() {
            if build.advance(&state.topology, DISTANCES_A_STEP) {
                attachments.blend_weights = Some(build.finish());
            } else {
                attachments.blend_build = Some(build);
            }
        }
        if let Some(mut build) = attachments.tether_build.take() {
            if build.advance(state.built_topology(), DISTANCES_A_STEP) {
                let tethers = build.finish(state.built_topology());
                attachments.set_tethers(&mut state, tethers);
            } else {
                attachments.tether_build = Some(build);
            }
        }
    }
}

/// All of a cloth that has to do with its targets.
#[derive(QueryData)]
#[query_data(mutable)]
pub(crate) struct Follower {
    entity: Entity,
    status: &'static ClothStatus,
    state: &'static mut ClothState,
    attachments: &'static mut ClothAttachments,
    grabs: &'static mut ClothGrabs,
    requests: &'static mut Requests,
    input: &'static mut StepInput,
    skinning: &'static mut Skinning,
    teleport: Option<&'static ClothTeleport>,
    inertia: Option<&'static ClothInertia>,
    warned: &'static mut Warned,
}

/// Plans the motion of every pinned particle over the coming step. A cloth that jumps, or whose pins all do, jumps along
/// first.
pub(crate) fn follow_targets(
    mut cloths: Query<Follower>,
    skeletons: Skeletons,
    time: Res<Time>,
    run: Res<ClothRun>,
    _main_thread: NonSendMarker,
) {
    let pass = skeletons.poses.pass();
    let are_stepped = cloths.iter_mut().filter(|cloth| cloth.status.is_running() && cloth.input.pass == pass);
    // Of those without a skeleton, few are worth a task each.
    let (worn, others): (Vec<_>, Vec<_>) = are_stepped.partition(|cloth| cloth.skinning.0.is_some());
    let dt = time.delta_secs();
    others.into_iter().for_each(|cloth| follow(cloth, &skeletons, dt));
    frame::for_each(worn, run.parallel, |cloth| follow(cloth, &skeletons, dt));
}

/// Plans the motion of one cloth's pins over the coming step of `dt` seconds.
fn follow(cloth: FollowerItem, skeletons: &Skeletons, dt: f32) {
    let FollowerItem {
        entity,
        mut state,
        mut attachments,
        mut grabs,
        mut requests,
        mut input,
        mut skinning,
        teleport,
        inertia,
        mut warned,
        ..
    } = cloth;
    let poses = &skeletons.poses;
    let (state, attachments, grabs) = (&mut *state, &mut *attachments, grabs.bypass_change_detection());
    let carrier = skinning.carrier(entity);
    for anchor in &mut attachments.anchors {
        anchor.follow(carrier, poses);
    }
    let (mut jump, mut taken_along) = (None, None);
    let pose = match &mut skinning.0 {
        Some(bound) => {
            bound.read_joints(skeletons);
            bound.pose()
        }
        None => skeletons.pose(entity),
    };
    if let Some(pose) = pose {
        state.is_disturbed |= state.pose != pose;
        jump = take_asked_jump((state, attachments, grabs), &mut requests, pose);
        if let Some(bound) = skinning.0.as_mut().filter(|_| jump.is_none()) {
            let (parts, rules) = ((&mut *state, &mut *attachments, &mut *grabs), (teleport, inertia));
            (jump, taken_along) = skeleton::come_along(parts, bound, rules, pose, dt);
        }
        state.pose = pose;
        state.follow_scale(attachments);
    }
    if jump.is_none() {
        jump = PinAnchor::common_jump(&attachments.anchors);
        if let Some(jump) = &jump {
            state::carry(state, attachments, grabs, jump);
        }
    }
    if jump.is_some() {
        attachments.anchors.iter_mut().for_each(PinAnchor::forget_way);
    }
    // Obstacles that go with the skeleton come from where the cloth was taken along to, too.
    input.jump = jump.or(taken_along);
    state::stay_near(state, attachments, grabs);
    if let Some(bound) = &mut skinning.0 {
        skeleton::advance(entity, bound, state, jump.is_some(), teleport, &mut warned);
    }
    plan_motions(state, attachments, &mut input, &skinning);
}

/// Does the jump to `pose` that has been asked for, and tells of the one that a reset has been.
fn take_asked_jump(
    (state, attachments, grabs): (&mut ClothState, &mut ClothAttachments, &mut ClothGrabs),
    requests: &mut Requests,
    pose: Affine3A,
) -> Option<Jump> {
    let reset_from = requests.reset_from.take();
    if core::mem::take(&mut requests.teleport) {
        let jump = Jump::between(state.pose, pose)?;
        state::carry(state, attachments, grabs, &jump);
        return Some(jump);
    }
    Jump::between(reset_from?, pose)
}

/// Plans the motion of each pin from where its particle is to where its anchor has it.
fn plan_motions(
    state: &mut ClothState,
    attachments: &mut ClothAttachments,
    input: &mut StepInput,
    skinning: &Skinning,
) {
    let origin = Vec3A::from(state.origin);
    input.pin_motions.clear();
    // Bridges to physics engines fill these.
    input.body_attachments.clear();
    input.attachment_owners.clear();
    input.attached_pins.clear();
    for pin in &mut attachments.pins {
        let anchor = &attachments.anchors[pin.anchor as usize];
        let place = &mut state.particles.position[pin.particle as usize];
        let on_skin = skinning.0.as_ref().and_then(|bound| bound.holds(pin));
        let end = match (pin.target, anchor.pose()) {
            _ if on_skin.is_some() => on_skin.unwrap_or(*place),
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
        if anchor.has_jumped() {
            state.is_disturbed |= *place != end;
            *place = end;
        }
        input.pin_motions.push(PinMotion { particle: pin.particle, start: *place, end });
    }
}
