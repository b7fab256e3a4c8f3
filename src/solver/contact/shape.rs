//! Signed distances of the solids, with normals. Each is centred on its pose, as in `bevy_math`.
//!
//! The formulas are those of Quilez, "Distance functions"; they are exact outside and inside, so a sphere trace along
//! them never steps over a surface.

use bevy::{
    math::{
        Vec3, Vec3A,
        primitives::{Capsule3d, Cuboid, Cylinder, InfinitePlane3d, Sphere},
    },
    prelude::Reflect,
};

/// A solid.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Debug, Clone, PartialEq)]
pub enum ColliderShape {
    /// A ball.
    Sphere(Sphere),
    /// A box.
    Cuboid(Cuboid),
    /// A capsule along Y.
    Capsule(Capsule3d),
    /// A cylinder along Y.
    Cylinder(Cylinder),
    /// All that lies behind a plane.
    HalfSpace(InfinitePlane3d),
}

/// The nearest place on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Distance to the surface, m; negative inside.
    pub distance: f32,
    /// Outward unit normal there.
    pub normal: Vec3A,
}

impl ColliderShape {
    /// The surface as seen from `point` (m, in the solid's own frame).
    pub fn surface(&self, point: Vec3A) -> Surface {
        match self {
            Self::Sphere(sphere) => ball(point, sphere.radius),
            Self::Cuboid(cuboid) => self::cuboid(point, cuboid.half_size.into()),
            Self::Capsule(capsule) => {
                let on_axis = point.y.clamp(-capsule.half_length, capsule.half_length);
                ball(point - Vec3A::Y * on_axis, capsule.radius)
            }
            Self::Cylinder(cylinder) => self::cylinder(point, cylinder.radius, cylinder.half_height),
            Self::HalfSpace(plane) => {
                let normal: Vec3A = Vec3::from(plane.normal).into();
                Surface { distance: normal.dot(point), normal }
            }
        }
    }
}

fn ball(point: Vec3A, radius: f32) -> Surface {
    let (normal, length) = point.normalize_and_length();
    // The centre is as far from all sides: any direction will do.
    let normal = if length > 0.0 { normal } else { Vec3A::Y };
    Surface { distance: length - radius, normal }
}

fn cuboid(point: Vec3A, half_size: Vec3A) -> Surface {
    let beyond = point.abs() - half_size;
    let outside = beyond.max(Vec3A::ZERO);
    let distance = outside.length();
    if distance > 0.0 {
        let normal = outside / distance * point.signum();
        return Surface { distance, normal };
    }
    let distance = beyond.max_element();
    let axis = if distance == beyond.x {
        Vec3A::X
    } else if distance == beyond.y {
        Vec3A::Y
    } else {
        Vec3A::Z
    };
    Surface { distance, normal: axis * point.signum() }
}

fn cylinder(point: Vec3A, radius: f32, half_height: f32) -> Surface {
    let (across, from_axis) = Vec3A::new(point.x, 0.0, point.z).normalize_and_length();
    let across = if from_axis > 0.0 { across } else { Vec3A::X };
    let along = Vec3A::Y * point.y.signum();
    let (side, end) = (from_axis - radius, point.y.abs() - half_height);
    if side > 0.0 && end > 0.0 {
        let (normal, distance) = (across * side + along * end).normalize_and_length();
        Surface { distance, normal }
    } else if side > end {
        Surface { distance: side, normal: across }
    } else {
        Surface { distance: end, normal: along }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::math::Dir3;

    fn all_shapes() -> [ColliderShape; 5] {
        [
            ColliderShape::Sphere(Sphere::new(0.4)),
            ColliderShape::Cuboid(Cuboid::new(0.6, 1.0, 0.4)),
            ColliderShape::Capsule(Capsule3d::new(0.2, 0.8)),
            ColliderShape::Cylinder(Cylinder::new(0.3, 0.9)),
            ColliderShape::HalfSpace(InfinitePlane3d { normal: Dir3::new_unchecked(Vec3::new(0.6, 0.8, 0.0)) }),
        ]
    }

    #[test]
    fn walking_the_distance_along_the_normal_ends_on_the_surface() {
        for shape in all_shapes() {
            for i in 0..500 {
                let p = Vec3A::new((i % 9) as f32 - 4.1, (i / 9 % 8) as f32 - 3.6, (i / 72) as f32 - 3.3) * 0.23;
                let surface = shape.surface(p);
                assert!((surface.normal.length() - 1.0).abs() < 1e-5, "{shape:?} at {p}");
                let foot = shape.surface(p - surface.normal * surface.distance);
                assert!(foot.distance.abs() < 1e-5, "{shape:?} at {p}: {foot:?}");
            }
        }
    }

    #[test]
    fn the_centre_has_a_normal() {
        for shape in all_shapes() {
            assert!(shape.surface(Vec3A::ZERO).normal.is_normalized(), "{shape:?}");
        }
    }
}
