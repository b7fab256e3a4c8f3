//! Whether a solid under its transform is what is seen of it.

use bevy::{
    math::{Affine3A, Vec3A},
    prelude::*,
};
use thiserror::Error;

use crate::solver::Solid;

/// How a solid differs from what is seen of it. The message names the cause and the mend.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
enum Difference {
    /// What is round about its axis is scaled one way across that more than the other.
    #[error(
        "it is round about Y, its scale isn't the same along X and Z, and the larger of the two counts; give both the same \
         scale, or use ClothCollider::convex_hull (of the feature mesh_colliders)"
    )]
    Across,
    /// What has round ends is scaled along its axis otherwise than across it.
    #[error(
        "its scale along Y isn't that along X and Z, and its ends stay balls; scale it the same along all axes and give its \
         shape another length, or use ClothCollider::convex_hull (of the feature mesh_colliders)"
    )]
    Ends,
    /// Right angles don't stay right.
    #[error(
        "it is turned below a scale that isn't uniform, which shears what is seen, and a solid is turned and scaled only; give \
         the parents uniform scales, or use ClothCollider::convex_hull (of the feature mesh_colliders)"
    )]
    Sheared,
}

impl Difference {
    /// How `solid` differs, if it does by more than rounding.
    fn of(solid: &Solid, pose: &Affine3A) -> Option<Self> {
        const ROUNDING: f32 = 1e-3;
        let axes = [pose.matrix3.x_axis, pose.matrix3.y_axis, pose.matrix3.z_axis];
        let scale @ [x, y, z] = axes.map(Vec3A::length);
        let are_square = |i: usize, j: usize| axes[i].dot(axes[j]).abs() <= ROUNDING * scale[i] * scale[j];
        let is_sheared = !(are_square(0, 1) && are_square(1, 2) && are_square(2, 0));
        let differ = |one: f32, other: f32| (one - other).abs() > ROUNDING * one.max(other);
        match solid {
            Solid::HalfSpace(_) => None,
            _ if is_sheared => Some(Self::Sheared),
            Solid::Sphere(_) | Solid::Ellipsoid(_) | Solid::Cuboid(_) => None,
            _ if differ(x, z) => Some(Self::Across),
            Solid::Capsule(_) | Solid::TaperedCapsule(_) if differ(x, y) => Some(Self::Ends),
            Solid::Capsule(_) | Solid::TaperedCapsule(_) | Solid::Cylinder(_) | Solid::Cone(_) => None,
        }
    }
}

/// What is known of that, and whether it has been told. Once is enough for a collider: a scale that changes from step to step
/// comes past one that is uniform again and again.
#[derive(Clone, Debug, Default)]
pub(super) struct Likeness {
    difference: Option<Difference>,
    is_told: bool,
}

impl Likeness {
    /// Looks at a solid and the transform that it has in the world.
    pub fn look(&mut self, solid: &Solid, pose: &Affine3A) {
        if !self.is_told {
            self.difference = Difference::of(solid, pose);
        }
    }

    /// Says what is found, if it hasn't been said.
    pub fn tell(&mut self, entity: Entity) {
        if let Some(difference) = self.difference.take() {
            self.is_told = true;
            warn!("collider {entity} isn't quite what is seen: {difference}");
        }
    }
}

#[cfg(test)]
mod tests {
    use bevy::math::primitives::InfinitePlane3d;

    use super::*;
    use crate::solver::TaperedCapsule;

    #[test]
    fn what_is_round_is_told_of_where_its_scale_does_not_keep_it_so() {
        let solids = [
            Solid::Sphere(Sphere::default()),
            Solid::Cuboid(Cuboid::default()),
            Solid::HalfSpace(InfinitePlane3d::default()),
            Solid::Cylinder(Cylinder::default()),
            Solid::Cone(Cone::default()),
            Solid::Capsule(Capsule3d::default()),
            Solid::TaperedCapsule(TaperedCapsule::new(0.1, 0.2, 0.3)),
        ];
        let turned = Quat::from_euler(EulerRot::XYZ, 0.4, -0.9, 1.3);
        let [no, across, ends, sheared] =
            [None, Some(Difference::Across), Some(Difference::Ends), Some(Difference::Sheared)];
        let expected = |pose: Affine3A| solids.map(|solid| Difference::of(&solid, &pose));
        for (scale, found) in [
            (Vec3::ONE, [no; 7]),
            (Vec3::new(-2.0, 2.0, 2.0), [no; 7]),
            (Vec3::new(2.0, 0.4, 2.0), [no, no, no, no, no, ends, ends]),
            (Vec3::new(2.0, 0.4, -1.0), [no, no, no, across, across, across, across]),
        ] {
            let pose = Affine3A::from_scale_rotation_translation(scale, turned, Vec3::X);
            assert_eq!(expected(pose), found, "{scale}");
        }
        let below = Affine3A::from_scale(Vec3::new(2.0, 1.0, 1.0)) * Affine3A::from_quat(turned);
        assert_eq!(expected(below), [sheared, sheared, no, sheared, sheared, sheared, sheared]);
    }
}
