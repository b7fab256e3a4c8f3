//! What cloth has given to bodies in the latest step.

use bevy::{
    math::{Isometry3d, Vec3A},
    prelude::*,
};

use crate::{cloth::ClothStatus, solver::Push, state::ClothState};

/// What a cloth has given to a body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Given {
    /// The body, or one of its colliders.
    pub to: Entity,
    pub push: Push,
}

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
        let given = work.pushes.drain(..).enumerate();
        if *status == ClothStatus::Ready {
            buffer.extend(given.map(|(number, (to, push))| (Given { to, push }, cloth, number)));
        }
    }
    buffer.sort_unstable_by_key(|&(given, cloth, number)| (given.to, cloth, number));
    list.clear();
    let is_felt = |given: &Given| {
        let Push { linear, angular } = given.push;
        linear.is_finite() && angular.is_finite() && (linear != Vec3A::ZERO || angular != Vec3A::ZERO)
    };
    list.extend(buffer.iter().map(|&(given, ..)| given).filter(is_felt));
}

/// How a body has moved by what cloth gave it, and with what it goes on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moved {
    /// Its pose.
    pub pose: Isometry3d,
    /// Velocity that it has gained, m/s.
    pub velocity: Vec3,
    /// Angular velocity that it has gained, rad/s.
    pub angular_velocity: Vec3,
}

impl Moved {
    /// From `pose`, with a centre of mass in the body's frame, after velocities were gained evenly over `dt` s.
    pub fn new(pose: Isometry3d, centre: Vec3, velocity: Vec3, angular_velocity: Vec3, dt: f32) -> Self {
        let turn = Quat::from_scaled_axis(angular_velocity * (dt / 2.0));
        let rotation = (turn * pose.rotation).normalize();
        let world_centre = Vec3::from(pose * Vec3A::from(centre)) + velocity * (dt / 2.0);
        Self { pose: Isometry3d::new(world_centre - rotation * centre, rotation), velocity, angular_velocity }
    }

    /// Moves a transform along, from where the body was.
    pub fn carry(&self, transform: &mut Transform, from: Isometry3d) {
        let way = from.inverse() * self.pose;
        transform.translation += transform.rotation * Vec3::from(way.translation);
        transform.rotation = (transform.rotation * way.rotation).normalize();
    }
}
