//! What cloth has given to bodies in the latest step.

use bevy::{
    math::{Isometry3d, Vec3A},
    prelude::*,
};

use crate::{
    solver::{BodyDisplacement, BodyImpulse},
    state::{BodyPush, ClothStatus, StepInput},
};

/// The impulses that bodies got from all cloths in the latest step, ordered by collider, then by cloth.
#[derive(Resource, Debug, Default)]
pub(crate) struct Pushes {
    pub list: Vec<BodyPush>,
    /// The impulses with their cloth and their number among that cloth's.
    buffer: Vec<(BodyPush, Entity, usize)>,
}

/// Takes over what each cloth has given, whichever thread stepped it.
pub(crate) fn collect_pushes(mut cloths: Query<(Entity, &ClothStatus, &mut StepInput)>, mut pushes: ResMut<Pushes>) {
    let Pushes { list, buffer } = &mut *pushes;
    buffer.clear();
    for (cloth, status, mut input) in &mut cloths {
        let pushes = input.bypass_change_detection().pushes.drain(..).enumerate();
        if status.is_running() {
            buffer.extend(pushes.map(|(number, push)| (push, cloth, number)));
        }
    }
    buffer.sort_unstable_by_key(|&(push, cloth, number)| (push.to, cloth, number));
    list.clear();
    let is_felt = |push: &BodyPush| {
        let BodyPush {
            impulse: BodyImpulse { linear, angular }, displacement: BodyDisplacement { shift, turn }, ..
        } = push;
        let is_finite = linear.is_finite() && angular.is_finite() && shift.is_finite() && turn.is_finite();
        is_finite && (*linear != Vec3A::ZERO || *angular != Vec3A::ZERO)
    };
    list.extend(buffer.iter().map(|&(push, ..)| push).filter(is_felt));
}

/// Where a body is that was at `pose`, with its centre of mass at `centre` (m) in its frame, and has strayed.
pub(crate) fn strayed(pose: Isometry3d, centre: Vec3, stray: &BodyDisplacement) -> Isometry3d {
    let rotation = (stray.turn * pose.rotation).normalize();
    let centre = Vec3A::from(centre);
    let world_centre = pose * centre + stray.shift;
    Isometry3d { rotation, translation: world_centre - rotation * centre }
}

/// Moves a transform as a body has been moved.
pub(crate) fn carry(transform: &mut Transform, from: Isometry3d, to: Isometry3d) {
    let way = from.inverse() * to;
    transform.translation += transform.rotation * Vec3::from(way.translation);
    transform.rotation = (transform.rotation * way.rotation).normalize();
}
