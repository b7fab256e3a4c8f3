//! What cloth has given to bodies in the latest step.

use bevy::{
    math::{Isometry3d, Vec3A},
    prelude::*,
};

use crate::{
    cloth::ClothStatus,
    solver::{BodyDisplacement, BodyImpulse},
    state::{ClothState, Given},
};

/// What all cloths have given in the latest step, in a fixed order: that of the colliders, then of the cloths.
#[derive(Resource, Debug, Default)]
pub(crate) struct Pushes {
    pub list: Vec<Given>,
    /// The same with the cloth and its number among that cloth's.
    buffer: Vec<(Given, Entity, usize)>,
}

/// Takes over what each cloth has given, whichever thread stepped it.
pub(crate) fn collect_pushes(mut cloths: Query<(Entity, &ClothStatus, &mut ClothState)>, mut pushes: ResMut<Pushes>) {
    let Pushes { list, buffer } = &mut *pushes;
    buffer.clear();
    for (cloth, status, mut state) in &mut cloths {
        let work = &mut state.bypass_change_detection().work;
        let given = work.given.drain(..).enumerate();
        if *status == ClothStatus::Ready {
            buffer.extend(given.map(|(number, given)| (given, cloth, number)));
        }
    }
    buffer.sort_unstable_by_key(|&(given, cloth, number)| (given.to, cloth, number));
    list.clear();
    let is_felt = |given: &Given| {
        let Given { push: BodyImpulse { linear, angular }, stray: BodyDisplacement { shift, turn }, .. } = given;
        let is_finite = linear.is_finite() && angular.is_finite() && shift.is_finite() && turn.is_finite();
        is_finite && (*linear != Vec3A::ZERO || *angular != Vec3A::ZERO)
    };
    list.extend(buffer.iter().map(|&(given, ..)| given).filter(is_felt));
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
