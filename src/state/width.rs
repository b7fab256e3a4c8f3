//! How wide a cloth is.

use bevy::{
    math::{Mat3A, Vec3A},
    prelude::*,
};

use super::ClothState;

/// The largest that a margin may be of the cloth's width. What holds a cloth may be as near to an obstacle as one likes, and what
/// hangs from it is pushed off by the margin: one as large as the cloth would stretch it to several times its length.
const LARGEST_MARGIN: f32 = 0.25;

impl ClothState {
    /// Largest distance in m that the cloth can keep from obstacles beyond its fabric's thickness: a quarter of its width. A
    /// larger [`Cloth::collision_margin`](crate::prelude::Cloth::collision_margin) counts as that.
    pub fn largest_margin(&self) -> f32 {
        LARGEST_MARGIN * self.width
    }
}

/// How wide a cloth is at rest, m: the second of its lengths along its entity's axes, whose directions in the world are the columns
/// of `to_world`. Not the longest, since a ribbon may hang along all of that, and no more of it than its width gives way then.
pub(crate) fn width_at_rest(rest: &[Vec3], to_world: Mat3A) -> f32 {
    let axes = [to_world.x_axis, to_world.y_axis, to_world.z_axis];
    let along = |axis: Vec3A| {
        let places = rest.iter().map(|&place| axis.dot(place.into()));
        places.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), place| (low.min(place), high.max(place)))
    };
    let mut lengths = axes.map(|axis| along(axis.normalize_or_zero())).map(|(low, high)| high - low);
    lengths.sort_unstable_by(f32::total_cmp);
    lengths[1]
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
                let width = width_at_rest(&rest.map(|place| Vec3::from(to_world * Vec3A::from(place))), to_world);
                let mut lengths = (scale.abs() * Vec3::new(0.3, 0.2, 0.1)).to_array();
                lengths.sort_unstable_by(f32::total_cmp);
                assert!((width - lengths[1]).abs() < 1e-6, "{width} m for {lengths:?}");
            }
        }
    }
}
