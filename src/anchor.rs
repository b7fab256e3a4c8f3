//! Pinned particles follow their targets.

use bevy::{
    math::{Affine3A, Vec3A},
    prelude::*,
};

use crate::{
    build::Tying,
    cloth::ClothStatus,
    draw::{carrier::Carrier, mesh::ClothMesh},
    origin,
    pins::{PinTarget, Pins, targets_by_particle},
    solver::Anchor,
    state::{ClothState, Work},
};

/// A fixed particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HeldPin {
    pub particle: u32,
    pub target: PinTarget,
    /// Its place in the target's own space, once the target has a pose that can be followed; for
    /// [`PinTarget::World`] its place relative to the cloth's origin.
    pub offset: Option<Vec3A>,
}

/// World poses of entities, up to date within a frame.
pub(crate) type Poses<'w, 's> = TransformHelper<'w, 's>;

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
    let pins: Vec<HeldPin> = (0..)
        .zip(targets)
        .filter(|&(_, &target)| target != PinTarget::Free)
        .map(|(particle, &target)| {
            let held = state.pins.binary_search_by_key(&particle, |pin| pin.particle).ok();
            let kept = held.map(|i| state.pins[i]).filter(|pin| pin.target == target);
            kept.unwrap_or_else(|| {
                let offset = (target == PinTarget::World).then(|| state.particles.position[particle as usize]);
                HeldPin { particle, target, offset }
            })
        })
        .collect();
    if pins == state.pins {
        return;
    }
    let particles: Vec<u32> = pins.iter().map(|pin| pin.particle).collect();
    state.tethers.keep(|pin| particles.binary_search(&pin).is_ok());
    let tied = particles.iter().copied().filter(|particle| !state.mounted.contains(particle));
    state.tying = Some(Box::new(Tying::begin(tied.collect())));
    state.pins = pins;
    set_masses(state);
    // Takes the places of new pins in their targets' space now, before either moves on.
    plan_anchors(state, cloth, poses);
    state.carrier = carrier(state, cloth, poses);
}

/// Distances along the cloth that are worked out in one step: some milliseconds. 64 x 64 particles on two pins are done
/// in one.
const DISTANCES_A_STEP: usize = 12_000;

/// Works on tethers that pins have asked for; a large cloth hangs by its old ones meanwhile.
pub(crate) fn tie_tethers(mut cloths: Query<(&mut ClothState, &ClothStatus)>) {
    for (mut state, status) in &mut cloths {
        if *status != ClothStatus::Ready || state.tying.is_none() {
            continue;
        }
        let state = &mut *state;
        if let Some(mut tying) = state.tying.take() {
            if tying.go_on(&state.topology, DISTANCES_A_STEP) {
                state.tethers = tying.finish(&state.topology);
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

/// Plans the way of every pinned particle over the coming step.
pub(crate) fn follow_targets(mut cloths: Query<(Entity, &mut ClothState, &ClothStatus)>, poses: Poses) {
    for (entity, mut state, status) in &mut cloths {
        if *status != ClothStatus::Ready {
            continue;
        }
        let state = &mut *state;
        if let Ok(pose) = poses.compute_global_transform(entity) {
            let pose = pose.affine();
            if core::mem::take(&mut state.requests.teleport) {
                origin::teleport(state, pose);
                state.carrier = None;
            }
            state.pose = pose;
        }
        origin::stay_near(state);
        plan_anchors(state, entity, &poses);
        state.carrier = carrier(state, entity, &poses);
    }
}

fn plan_anchors(state: &mut ClothState, cloth: Entity, poses: &Poses) {
    let origin = Vec3A::from(state.origin);
    // Pins of one target stand together mostly: its pose is looked up once.
    let mut latest: Option<(PinTarget, Option<Affine3A>)> = None;
    let Work { anchors, mounts, mount_owners, mounted, .. } = &mut state.work;
    anchors.clear();
    // Bridges to physics engines fill these.
    mounts.clear();
    mount_owners.clear();
    mounted.clear();
    for pin in &mut state.pins {
        let pose = match latest {
            Some((target, pose)) if target == pin.target => pose,
            _ => target_pose(pin.target, cloth, poses),
        };
        latest = Some((pin.target, pose));
        let start = state.particles.position[pin.particle as usize];
        let end = match (pin.target, pose) {
            (PinTarget::World, _) => pin.offset.unwrap_or(start),
            (_, Some(pose)) => {
                let from_pose = pose.translation - origin;
                let offset = *pin.offset.get_or_insert_with(|| pose.matrix3.inverse() * (start - from_pose));
                pose.matrix3 * offset + from_pose
            }
            // The target is gone, flat or not there yet: stay.
            (_, None) => start,
        };
        let end = if end.is_finite() { end } else { start };
        anchors.push(Anchor { particle: pin.particle, start, end });
    }
}

/// The entity that all pins follow, if they all follow one, and its way from the latest step to now.
fn carrier(state: &ClothState, cloth: Entity, poses: &Poses) -> Option<Carrier> {
    let target = state.pins.first()?.target;
    let entity = target_entity(target, cloth).filter(|_| state.pins.iter().all(|pin| pin.target == target))?;
    let end = target_pose(target, cloth, poses)?;
    let start = state.carrier.filter(|carrier| carrier.entity == entity).map_or(end, |carrier| carrier.end);
    Some(Carrier { entity, start, end })
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

/// Whether a transform keeps volume: all of its scales are finite and not zero.
pub(crate) fn is_invertible(pose: &Affine3A) -> bool {
    pose.is_finite() && pose.matrix3.determinant().is_normal() && pose.inverse().is_finite()
}
