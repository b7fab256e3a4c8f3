//! The margin that a cloth keeps from obstacles: that of its settings, as far as it is large enough for it.

use bevy::{
    math::{Mat3A, Vec3A},
    prelude::*,
};

use crate::state::ClothState;

/// The largest that a margin may be of the cloth's width. What holds a cloth may be as near to an obstacle as one likes, and what
/// hangs from it is pushed off by the margin: one as large as the cloth would stretch it to several times its length.
const LARGEST: f32 = 0.25;

impl ClothState {
    /// Distance in m that the cloth keeps from obstacles beyond its fabric's thickness: its
    /// [`Cloth::collision_margin`](crate::prelude::Cloth::collision_margin), or a quarter of its width, if that is less.
    pub fn collision_margin(&self) -> f32 {
        self.settings.collision_margin.min(LARGEST * self.width)
    }
}

/// How wide a cloth is at rest, m: the second of its lengths along its entity's axes, whose directions in the world are the columns
/// of `to_world`. Not the longest, since a ribbon may hang along all of that, and no more of it than its width gives way then.
pub(crate) fn width(rest: &[Vec3], to_world: Mat3A) -> f32 {
    let axes = [to_world.x_axis, to_world.y_axis, to_world.z_axis];
    let along = |axis: Vec3A| {
        let places = rest.iter().map(|&place| axis.dot(place.into()));
        places.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), place| (low.min(place), high.max(place)))
    };
    let mut lengths = axes.map(|axis| along(axis.normalize_or_zero())).map(|(low, high)| high - low);
    lengths.sort_unstable_by(f32::total_cmp);
    lengths[1]
}

/// Says so where a cloth is too small for the margin that it is given, once until it isn't.
pub(crate) fn warn_if_too_large(entity: Entity, state: &mut ClothState) {
    let (given, kept) = (state.settings.collision_margin, state.collision_margin());
    let is_less = kept < given;
    if is_less && !state.said.margin {
        warn!(
            "cloth {entity} is {:.2} mm wide, too small for a margin of {:.2} mm, and keeps {:.2} mm from obstacles, a quarter \
             of its width: set Cloth::collision_margin to that or less",
            state.width * 1e3,
            given * 1e3,
            kept * 1e3
        );
    }
    state.said.margin = is_less;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_cloth_is_as_wide_as_it_was() {
        let rest = [Vec3::ZERO, Vec3::new(0.3, 0.0, 0.1), Vec3::new(0.0, 0.2, 0.0)];
        for turn in [Quat::IDENTITY, Quat::from_euler(EulerRot::XYZ, 0.4, -0.9, 1.3)] {
            for scale in [Vec3::ONE, Vec3::splat(-2.0), Vec3::new(1.0, 3.0, 0.5)] {
                let to_world = Mat3A::from_quat(turn) * Mat3A::from_diagonal(scale);
                let width = width(&rest.map(|place| Vec3::from(to_world * Vec3A::from(place))), to_world);
                let mut lengths = (scale.abs() * Vec3::new(0.3, 0.2, 0.1)).to_array();
                lengths.sort_unstable_by(f32::total_cmp);
                assert!((width - lengths[1]).abs() < 1e-6, "{width} m for {lengths:?}");
            }
        }
    }
}
