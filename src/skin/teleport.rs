//! When a character has been put elsewhere, and what becomes of its clothes: `ClothTeleport`.

use bevy::{
    math::{Affine3A, Vec3A},
    prelude::*,
};

use crate::{
    error::ClothError,
    parameter::{Parameter, check_parameters},
};

/// What clothes do when their skeleton is put elsewhere within a step: to be inserted beside a [`Cloth`](crate::prelude::Cloth) on a
/// skinned mesh. Without it, they have the defaults.
///
/// A way is taken for a teleport where it is longer *and* faster than these, so that a low frame rate isn't taken for one; a turn
/// likewise. Both are those of the joint that has most of the clothes.
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, Clone, PartialEq)]
pub struct ClothTeleport {
    /// What becomes of the clothes, [`TeleportMode::Carry`] by default.
    pub mode: TeleportMode,
    /// Longest way in m that is no teleport, however fast, 0 or more, 0.5 by default.
    #[reflect(@Parameter::not_negative("m", (0.0, 5.0)).entered((0.0, 1e6)))]
    pub distance: f32,
    /// Highest speed in m/s that is no teleport, however far, 0 or more, 40 by default.
    #[reflect(@Parameter::not_negative("m/s", (0.0, 100.0)).entered((0.0, 1e6)))]
    pub speed: f32,
    /// Largest turn in rad that is no teleport, however fast, 0 or more, 1 by default.
    #[reflect(@Parameter::not_negative("rad", (0.0, 3.2)).entered((0.0, 100.0)))]
    pub angle: f32,
    /// Highest speed of turning in rad/s that is no teleport, however far, 0 or more, 40 by default.
    #[reflect(@Parameter::not_negative("rad/s", (0.0, 100.0)).entered((0.0, 1e6)))]
    pub angular_speed: f32,
}

/// What becomes of clothes whose skeleton is put elsewhere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Default, Debug, Clone, PartialEq)]
pub enum TeleportMode {
    /// They come along as they hang, velocities too.
    #[default]
    Carry,
    /// They are put where the skeleton alone has them, at rest.
    Reset,
    /// They are pulled along: nothing is taken for a teleport.
    Off,
}

impl Default for ClothTeleport {
    fn default() -> Self {
        Self { mode: TeleportMode::Carry, distance: 0.5, speed: 40.0, angle: 1.0, angular_speed: 40.0 }
    }
}

impl ClothTeleport {
    /// Checks the ranges of all settings.
    ///
    /// # Errors
    ///
    /// [`ClothError::InvalidParameter`] with the first field that is out of its range.
    pub fn validate(&self) -> Result<(), ClothError> {
        check_parameters(self, |_| true)
    }

    /// Whether the move from one pose to another within `dt` seconds is a teleport.
    pub(crate) fn is_exceeded(&self, from: &Affine3A, to: &Affine3A, dt: f32) -> bool {
        if self.mode == TeleportMode::Off {
            return false;
        }
        let way = from.translation.distance(to.translation);
        let rotation = |pose: &Affine3A| pose.to_scale_rotation_translation().1;
        let angle = rotation(from).angle_between(rotation(to));
        way > self.distance.max(self.speed * dt) || angle > self.angle.max(self.angular_speed * dt)
    }
}

/// Puts particles at rest where a skeleton has them.
pub(crate) fn put_at_rest(places: &[Vec3A], positions: &mut [Vec3A], velocities: &mut [Vec3A]) {
    for (position, place) in positions.iter_mut().zip(places).filter(|(_, place)| place.is_finite()) {
        *position = *place;
    }
    velocities.fill(Vec3A::ZERO);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_far_and_fast_is_a_teleport() {
        let teleport = ClothTeleport::default();
        let moved =
            |way: f32, dt| teleport.is_exceeded(&Affine3A::IDENTITY, &Affine3A::from_translation(Vec3::X * way), dt);
        assert!(moved(0.7, 1.0 / 60.0) && !moved(0.6, 1.0 / 60.0), "40 m/s");
        assert!(!moved(0.4, 1e-3), "fast, and not far");
        assert!(!moved(3.0, 0.1), "far, and not fast");
        let turned = |angle: f32, dt| teleport.is_exceeded(&Affine3A::IDENTITY, &Affine3A::from_rotation_y(angle), dt);
        assert!(turned(1.1, 1.0 / 60.0) && !turned(0.9, 1.0 / 60.0) && !turned(3.0, 0.1));
        let off = ClothTeleport { mode: TeleportMode::Off, ..teleport };
        assert!(!off.is_exceeded(&Affine3A::IDENTITY, &Affine3A::from_translation(Vec3::X * 1e3), 1e-3));
    }
}
