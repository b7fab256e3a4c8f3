//! How much of its skeleton's motion clothes feel: `ClothInertia`.

use bevy::{
    math::{Affine3A, Vec3A},
    prelude::*,
};

use crate::{
    error::ClothError,
    frame::Jump,
    parameter::{Parameter, check_parameters},
};

/// Shares of a way, and angles in rad, that are rounding.
const ROUNDING: f32 = 1e-4;

/// How much of its skeleton's motion a [`Cloth`](crate::prelude::Cloth) on a skinned mesh feels: to be inserted beside it. Without it,
/// it has the defaults.
///
/// What isn't felt takes the clothes along rigidly, as they hang, before each step: half of a run is half of its wind. The motion is
/// that of the joint that has most of the clothes.
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, Clone, PartialEq)]
pub struct ClothInertia {
    /// Share of the way that is felt, no unit, 0 to 1. 1 by default, 0 for clothes that know nothing of running.
    #[reflect(@Parameter::within("", (0.0, 1.0), (0.0, 1.0)))]
    pub linear: f32,
    /// Share of the turn that is felt, no unit, 0 to 1. 1 by default.
    #[reflect(@Parameter::within("", (0.0, 1.0), (0.0, 1.0)))]
    pub angular: f32,
    /// Highest speed that is felt, m/s, 0 or more. 8 by default: a sprint. Dashes and vehicles are faster.
    #[reflect(@Parameter::not_negative("m/s", (0.0, 20.0)).entered((0.0, 1e6)))]
    pub max_speed: f32,
    /// Highest speed of turning that is felt, rad/s, 0 or more. 12 by default, which is two turns a second.
    #[reflect(@Parameter::not_negative("rad/s", (0.0, 30.0)).entered((0.0, 1e6)))]
    pub max_angular_speed: f32,
}

impl Default for ClothInertia {
    fn default() -> Self {
        Self { linear: 1.0, angular: 1.0, max_speed: 8.0, max_angular_speed: 12.0 }
    }
}

impl ClothInertia {
    /// Checks the ranges of all settings.
    ///
    /// # Errors
    ///
    /// [`ClothError::InvalidParameter`] with the first field that is out of its range.
    pub fn validate(&self) -> Result<(), ClothError> {
        check_parameters(self, |_| true)
    }

    /// The part of the move from one pose to another within `dt` seconds that isn't felt; none where all is.
    pub(crate) fn unfelt(&self, from: &Affine3A, to: &Affine3A, dt: f32) -> Option<Jump> {
        let way = to.translation - from.translation;
        let felt = (self.linear * way).clamp_length_max(self.max_speed * dt);
        let rotation = |pose: &Affine3A| pose.to_scale_rotation_translation().1;
        let turn = rotation(to) * rotation(from).inverse();
        let turn = if turn.w < 0.0 { -turn } else { turn };
        let (axis, angle) = turn.normalize().to_axis_angle();
        let unfelt_angle = angle - (self.angular * angle).min(self.max_angular_speed * dt);
        let unfelt = way - felt;
        let unfelt = if unfelt.length() > ROUNDING * way.length() { unfelt } else { Vec3A::ZERO };
        let is_any = unfelt != Vec3A::ZERO || unfelt_angle > ROUNDING;
        (is_any && unfelt.is_finite() && unfelt_angle.is_finite()).then(|| {
            Jump::rigid(from.translation, from.translation + unfelt, Quat::from_axis_angle(axis, unfelt_angle.max(0.0)))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT: f32 = 1.0 / 64.0;

    fn moved(way: Vec3, angle: f32) -> Affine3A {
        Affine3A::from_rotation_translation(Quat::from_rotation_y(angle), way)
    }

    #[test]
    fn a_run_and_a_turn_are_felt_whole_by_default() {
        let inertia = ClothInertia::default();
        assert_eq!(inertia.unfelt(&Affine3A::IDENTITY, &moved(Vec3::X * 5.0 * DT, 10.0 * DT), DT), None);
    }

    #[test]
    fn what_is_faster_than_is_felt_takes_the_clothes_along() {
        let inertia = ClothInertia::default();
        let unfelt = inertia.unfelt(&Affine3A::IDENTITY, &moved(Vec3::X * 20.0 * DT, 0.0), DT).unwrap();
        let beside = unfelt.place(Vec3A::Z, Vec3A::ZERO) + unfelt.end();
        assert!(beside.distance(Vec3A::new(12.0 * DT, 0.0, 1.0)) < 1e-5, "{beside}");
        let unfelt = inertia.unfelt(&Affine3A::IDENTITY, &moved(Vec3::ZERO, 20.0 * DT), DT).unwrap();
        let turned = unfelt.direction(Vec3A::Z);
        assert!(turned.distance(Quat::from_rotation_y(8.0 * DT) * Vec3A::Z) < 1e-4, "{turned}");
    }

    #[test]
    fn a_share_is_felt_of_everything() {
        let inertia = ClothInertia { linear: 0.25, angular: 0.5, ..default() };
        let unfelt = inertia.unfelt(&Affine3A::IDENTITY, &moved(Vec3::X * DT, 2.0 * DT), DT).unwrap();
        assert!(unfelt.end().distance(Vec3A::X * 0.75 * DT) < 1e-6);
        assert!(unfelt.direction(Vec3A::Z).distance(Quat::from_rotation_y(DT) * Vec3A::Z) < 1e-4);
    }
}
