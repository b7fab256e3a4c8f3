//! Signed distances of the solids, with normals. Each is centred on its pose, as in `bevy_math`.

use bevy_math::{
    Vec2, Vec3A,
    primitives::{Capsule3d, Cone, Cuboid, Cylinder, InfinitePlane3d, Sphere},
};
use bevy_reflect::Reflect;

mod ellipsoid;
pub(crate) mod field;

pub(crate) use crate::shape::solid::field::{SignedDistance, SignedDistanceField};
pub use ellipsoid::Ellipsoid;

/// A solid whose signed distance has a formula.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Debug, Clone, PartialEq)]
pub enum Solid {
    /// A ball.
    Sphere(Sphere),
    /// A ball that isn't as long along all axes.
    Ellipsoid(Ellipsoid),
    /// A box.
    Cuboid(Cuboid),
    /// A capsule along Y.
    Capsule(Capsule3d),
    /// A capsule along Y with two radii.
    TaperedCapsule(TaperedCapsule),
    /// A cylinder along Y.
    Cylinder(Cylinder),
    /// A cone along Y, its tip at the top; the middle of its height is its centre.
    Cone(Cone),
    /// All that lies behind a plane.
    HalfSpace(InfinitePlane3d),
}

/// Two balls one above the other and all that lies between them: a limb.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Debug, Clone, PartialEq)]
pub struct TaperedCapsule {
    /// Radius of the upper ball, m.
    pub radius_top: f32,
    /// Radius of the lower ball, m.
    pub radius_bottom: f32,
    /// Half of the distance between their centres, m.
    pub half_length: f32,
}

impl TaperedCapsule {
    /// With these radii and this distance between the centres of the balls, m.
    pub const fn new(radius_top: f32, radius_bottom: f32, length: f32) -> Self {
        Self { radius_top, radius_bottom, half_length: length / 2.0 }
    }
}

/// The nearest place on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Distance to the surface, m; negative inside.
    pub distance: f32,
    /// Outward unit normal there.
    pub normal: Vec3A,
}

impl From<SignedDistance<f32>> for SurfacePoint {
    fn from(SignedDistance { distance, normal }: SignedDistance<f32>) -> Self {
        Self { distance, normal: normal.into() }
    }
}

impl Solid {
    /// The surface as seen from `point` (m, in the solid's own frame).
    pub fn surface(&self, point: Vec3A) -> SurfacePoint {
        let point = point.into();
        SurfacePoint::from(match self {
            Self::Sphere(sphere) => sphere.sample(point),
            Self::Ellipsoid(ellipsoid) => ellipsoid.sample(point),
            Self::Cuboid(cuboid) => cuboid.sample(point),
            Self::Capsule(capsule) => capsule.sample(point),
            Self::TaperedCapsule(capsule) => capsule.sample(point),
            Self::Cylinder(cylinder) => cylinder.sample(point),
            Self::Cone(cone) => cone.sample(point),
            Self::HalfSpace(plane) => plane.sample(point),
        })
    }

    /// Radius of a ball around the origin that holds all of it, m. Infinite for a half-space.
    pub(crate) fn reach(&self) -> f32 {
        match self {
            Self::Sphere(sphere) => sphere.radius,
            Self::Ellipsoid(ellipsoid) => ellipsoid.half_size.max_element(),
            Self::Cuboid(cuboid) => cuboid.half_size.length(),
            Self::Capsule(capsule) => capsule.half_length + capsule.radius,
            Self::TaperedCapsule(capsule) => capsule.half_length + capsule.radius_top.max(capsule.radius_bottom),
            Self::Cylinder(cylinder) => Vec2::new(cylinder.radius, cylinder.half_height).length(),
            Self::Cone(cone) => Vec2::new(cone.radius, cone.height / 2.0).length(),
            Self::HalfSpace(_) => f32::INFINITY,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_math::{Dir3, Vec3};

    fn all_solids() -> [Solid; 12] {
        [
            Solid::Sphere(Sphere::new(0.4)),
            Solid::Ellipsoid(Ellipsoid { half_size: Vec3::new(0.8, 0.16, 0.4) }),
            Solid::Ellipsoid(Ellipsoid { half_size: Vec3::new(0.04, 0.6, 0.04) }),
            Solid::Ellipsoid(Ellipsoid { half_size: Vec3::splat(0.4) }),
            Solid::Cuboid(Cuboid::new(0.6, 1.0, 0.4)),
            Solid::Capsule(Capsule3d::new(0.2, 0.8)),
            Solid::TaperedCapsule(TaperedCapsule::new(0.1, 0.3, 0.7)),
            Solid::TaperedCapsule(TaperedCapsule::new(0.4, 0.1, 0.2)),
            Solid::Cylinder(Cylinder::new(0.3, 0.9)),
            Solid::Cone(Cone::new(0.4, 0.7)),
            Solid::Cone(Cone::new(0.1, 1.2)),
            Solid::HalfSpace(InfinitePlane3d { normal: Dir3::new_unchecked(Vec3::new(0.6, 0.8, 0.0)) }),
        ]
    }

    #[test]
    fn walking_the_distance_along_the_normal_ends_on_the_surface() {
        for solid in all_solids() {
            for i in 0..500 {
                let p = Vec3A::new((i % 9) as f32 - 4.1, (i / 9 % 8) as f32 - 3.6, (i / 72) as f32 - 3.3) * 0.23;
                let surface = solid.surface(p);
                assert!((surface.normal.length() - 1.0).abs() < 1e-5, "{solid:?} at {p}");
                let foot = solid.surface(p - surface.normal * surface.distance);
                assert!(foot.distance.abs() < 1e-5, "{solid:?} at {p}: {foot:?}");
            }
        }
    }

    #[test]
    fn the_centre_has_a_normal() {
        for solid in all_solids() {
            assert!(solid.surface(Vec3A::ZERO).normal.is_normalized(), "{solid:?}");
        }
    }
}
