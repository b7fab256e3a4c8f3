//! Gravity on all cloth.

use bevy::prelude::*;

use crate::parameter::Parameter;

/// Gravity on all cloth along X, Y and Z, in m/s². Earth's by default, -9.81 along Y; the moon's is -1.62. None while it isn't
/// finite, with one warning.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Resource, Default, Debug, Clone, PartialEq)]
#[reflect(@Parameter::finite("m/s²", (-20.0, 20.0)).entered((-1e3, 1e3)).titled("Gravity"))]
pub struct ClothGravity(pub Vec3);

impl Default for ClothGravity {
    fn default() -> Self {
        Self(Vec3::NEG_Y * 9.81)
    }
}
