//! Clothes come along with their skeleton: what they don't feel of its motion, teleports, and where it holds them.

use bevy::{math::Affine3A, prelude::*};

use crate::{
    frame::Jump,
    skin::{ClothInertia, ClothTeleport, TeleportMode, teleport::put_at_rest},
    state::{self, BoundSkin, ClothAttachments, ClothGrabs, ClothState, Warned},
};

/// Has a cloth come along with a skeleton that is at `pose` by now, after a step of `dt` seconds. Returns the jump that it has made with
/// it, or the motion that it has been taken along by and doesn't feel.
pub(super) fn come_along(
    (state, attachments, grabs): (&mut ClothState, &mut ClothAttachments, &mut ClothGrabs),
    bound: &mut BoundSkin,
    (teleport, inertia): (Option<&ClothTeleport>, Option<&ClothInertia>),
    pose: Affine3A,
    dt: f32,
) -> (Option<Jump>, Option<Jump>) {
    let teleport = teleport.copied().filter(|teleport| teleport.validate().is_ok()).unwrap_or_default();
    let jump = teleport.is_exceeded(&state.pose, &pose, dt).then(|| Jump::between(state.pose, pose)).flatten();
    if let Some(jump) = &jump {
        state::carry(state, attachments, grabs, jump);
        return (Some(*jump), None);
    }
    let inertia = inertia.copied().filter(|inertia| inertia.validate().is_ok()).unwrap_or_default();
    let unfelt = inertia.unfelt(&state.pose, &pose, dt);
    if let Some(motion) = &unfelt {
        state::take_along(state, attachments, grabs, motion);
        bound.take_along(motion);
    }
    (None, unfelt)
}

/// Takes the skin of a cloth to the end of the coming step, and says so once where a joint is gone.
pub(super) fn advance(
    cloth: Entity,
    bound: &mut BoundSkin,
    state: &mut ClothState,
    has_jumped: bool,
    teleport: Option<&ClothTeleport>,
    warned: &mut Warned,
) {
    bound.advance(&state.topology, state.origin, has_jumped);
    if has_jumped && teleport.is_some_and(|teleport| teleport.mode == TeleportMode::Reset) {
        let particles = &mut state.particles;
        put_at_rest(bound.places(), &mut particles.position, &mut particles.velocity);
    }
    state.is_disturbed |= bound.moves();
    if !bound.is_whole() && !core::mem::replace(&mut warned.lost_joint, true) {
        warn!(
            "cloth {cloth} has lost a joint of its skeleton and stays where it was: give it a SkinnedMesh whose joints are there"
        );
    }
}
