//! Colliders made from primitives.

use bevy::{
    math::{Affine3A, Isometry3d, Vec3A, primitives::InfinitePlane3d},
    prelude::*,
};

use super::{ClothCollider, ColliderShape, error::ColliderError};
use crate::solver::{Ellipsoid, Solid, TaperedCapsule};

impl From<Solid> for ClothCollider {
    fn from(solid: Solid) -> Self {
        ColliderShape::Solid(solid).into()
    }
}

impl From<Sphere> for ClothCollider {
    fn from(sphere: Sphere) -> Self {
        Solid::Sphere(sphere).into()
    }
}

impl From<Ellipsoid> for ClothCollider {
    fn from(ellipsoid: Ellipsoid) -> Self {
        Solid::Ellipsoid(ellipsoid).into()
    }
}

impl From<Cuboid> for ClothCollider {
    fn from(cuboid: Cuboid) -> Self {
        Solid::Cuboid(cuboid).into()
    }
}

impl From<Capsule3d> for ClothCollider {
    fn from(capsule: Capsule3d) -> Self {
        Solid::Capsule(capsule).into()
    }
}

impl From<Cylinder> for ClothCollider {
    fn from(cylinder: Cylinder) -> Self {
        Solid::Cylinder(cylinder).into()
    }
}

impl From<TaperedCapsule> for ClothCollider {
    fn from(capsule: TaperedCapsule) -> Self {
        Solid::TaperedCapsule(capsule).into()
    }
}

impl From<Cone> for ClothCollider {
    fn from(cone: Cone) -> Self {
        Solid::Cone(cone).into()
    }
}

impl From<InfinitePlane3d> for ClothCollider {
    fn from(plane: InfinitePlane3d) -> Self {
        Solid::HalfSpace(plane).into()
    }
}

/// A solid and its world pose under a transform.
pub(super) fn placed(solid: Solid, pose: Affine3A) -> Result<(Solid, Isometry3d), ColliderError> {
    let (scale, rotation, translation) = pose.to_scale_rotation_translation();
    let mut solid = scaled(solid, scale.abs()).ok_or(ColliderError::NoSize)?;
    if let Solid::HalfSpace(plane) = &mut solid {
        // A plane's normal goes by the inverse transpose: exact under any scale, mirrored or not.
        let world = pose.matrix3.inverse().transpose() * Vec3A::from(Vec3::from(plane.normal));
        plane.normal = Dir3::new(rotation.inverse() * Vec3::from(world)).map_err(|_| ColliderError::NoSize)?;
    }
    Ok((solid, Isometry3d::new(translation, rotation)))
}

/// A solid under a scale of no negative factors; none where it has no size or none that is finite.
fn scaled(solid: Solid, scale: Vec3) -> Option<Solid> {
    let around = scale.max_element();
    let across = scale.x.max(scale.z);
    let all_positive = |sizes: &[f32]| sizes.iter().all(|&size| size.is_finite() && size > 0.0);
    let (solid, has_size) = match solid {
        Solid::Sphere(Sphere { radius }) => {
            let ellipsoid = Ellipsoid { half_size: radius * scale };
            let solid = if ellipsoid.is_ball() {
                Solid::Sphere(Sphere { radius: radius * around })
            } else {
                Solid::Ellipsoid(ellipsoid)
            };
            (solid, all_positive(&ellipsoid.half_size.to_array()))
        }
        Solid::Ellipsoid(Ellipsoid { half_size }) => {
            let half_size = half_size * scale;
            (Solid::Ellipsoid(Ellipsoid { half_size }), all_positive(&half_size.to_array()))
        }
        Solid::Cuboid(Cuboid { half_size }) => {
            let half_size = half_size * scale;
            (Solid::Cuboid(Cuboid { half_size }), all_positive(&half_size.to_array()))
        }
        Solid::Capsule(Capsule3d { radius, half_length }) => {
            let (radius, half_length) = (radius * across, half_length * scale.y);
            let has_size = all_positive(&[radius]) && half_length.is_finite() && half_length >= 0.0;
            (Solid::Capsule(Capsule3d { radius, half_length }), has_size)
        }
        Solid::TaperedCapsule(TaperedCapsule { radius_top, radius_bottom, half_length }) => {
            let (radius_top, radius_bottom) = (radius_top * across, radius_bottom * across);
            let half_length = half_length * scale.y;
            let has_size = all_positive(&[radius_top, radius_bottom]) && half_length.is_finite() && half_length >= 0.0;
            (Solid::TaperedCapsule(TaperedCapsule { radius_top, radius_bottom, half_length }), has_size)
        }
        Solid::Cone(Cone { radius, height }) => {
            let (radius, height) = (radius * across, height * scale.y);
            (Solid::Cone(Cone { radius, height }), all_positive(&[radius, height]))
        }
        Solid::Cylinder(Cylinder { radius, half_height }) => {
            let (radius, half_height) = (radius * across, half_height * scale.y);
            (Solid::Cylinder(Cylinder { radius, half_height }), all_positive(&[radius, half_height]))
        }
        Solid::HalfSpace(_) => (solid, all_positive(&[around])),
    };
    has_size.then_some(solid)
}
