//! Gravity on all cloth.

use bevy::prelude::*;

/// Gravity on all cloth, m/s². Earth's along -Y by default. None while it isn't finite, with one warning.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Resource, Default, Debug, Clone, PartialEq)]
pub struct ClothGravity(pub Vec3);

impl Default for ClothGravity {
    fn default() -> Self {
        Self(Vec3::NEG_Y * 9.81)
    }
}
