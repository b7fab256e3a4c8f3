//! Signed distances of the solids, with normals. Each is centred on its pose, as in `bevy_math`.
//!
//! The formulas are those of Quilez, "Distance functions"; they are exact outside and inside, so a sphere trace along
//! them never steps over a surface.

use bevy::{
    math::{
        Vec2, Vec3, Vec3A,
        primitives::{Capsule3d, Cone, Cuboid, Cylinder, InfinitePlane3d, Sphere},
    },
    prelude::Reflect,
};

/// A solid whose signed distance has a formula.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Debug, Clone, PartialEq)]
pub enum Solid {
    /// A ball.
    Sphere(Sphere),
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
pub struct Surface {
    /// Distance to the surface, m; negative inside.
    pub distance: f32,
    /// Outward unit normal there.
    pub normal: Vec3A,
}

impl Solid {
    /// The surface as seen from `point` (m, in the solid's own frame).
    pub fn surface(&self, point: Vec3A) -> Surface {
        match self {
            Self::Sphere(sphere) => ball(point, sphere.radius),
            Self::Cuboid(cuboid) => self::cuboid(point, cuboid.half_size.into()),
            Self::Capsule(capsule) => {
                let on_axis = point.y.clamp(-capsule.half_length, capsule.half_length);
                ball(point - Vec3A::Y * on_axis, capsule.radius)
            }
            Self::TaperedCapsule(capsule) => tapered_capsule(point, capsule),
            Self::Cone(cone) => self::cone(point, cone.radius, cone.height / 2.0),
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

/// Where the cone that touches both balls does so, the side of it is nearest; above and below, a ball is.
fn tapered_capsule(point: Vec3A, capsule: &TaperedCapsule) -> Surface {
    let TaperedCapsule { radius_top, radius_bottom, half_length } = *capsule;
    // Sine and cosine of the angle between the cone's side and the axis.
    let sine = (radius_bottom - radius_top) / (2.0 * half_length);
    let (from_top, from_bottom) = (point - Vec3A::Y * half_length, point + Vec3A::Y * half_length);
    if !(sine.abs() < 1.0) {
        // One ball has the other within.
        return if radius_top > radius_bottom { ball(from_top, radius_top) } else { ball(from_bottom, radius_bottom) };
    }
    let cosine = (1.0 - sine * sine).sqrt();
    let (across, from_axis) = axial(point);
    let along = cosine * from_bottom.y - sine * from_axis;
    if along < 0.0 {
        ball(from_bottom, radius_bottom)
    } else if along > cosine * 2.0 * half_length {
        ball(from_top, radius_top)
    } else {
        let distance = cosine * from_axis + sine * from_bottom.y - radius_bottom;
        Surface { distance, normal: across * cosine + Vec3A::Y * sine }
    }
}

fn cone(point: Vec3A, radius: f32, half_height: f32) -> Surface {
    let (across, from_axis) = axial(point);
    let place = Vec2::new(from_axis, point.y);
    let (tip, rim) = (Vec2::new(0.0, half_height), Vec2::new(radius, -half_height));
    let down = rim - tip;
    let side_normal = Vec2::new(-down.y, down.x) / down.length();
    let (beyond_side, beyond_base) = (side_normal.dot(place - tip), -half_height - point.y);
    let outward = |normal: Vec2| across * normal.x + Vec3A::Y * normal.y;
    if beyond_side <= 0.0 && beyond_base <= 0.0 {
        let (distance, normal) =
            if beyond_side > beyond_base { (beyond_side, side_normal) } else { (beyond_base, Vec2::NEG_Y) };
        return Surface { distance, normal: outward(normal) };
    }
    let on_side = tip + down * ((place - tip).dot(down) / down.length_squared()).clamp(0.0, 1.0);
    let on_base = Vec2::new(from_axis.min(radius), -half_height);
    let is_side = place.distance_squared(on_side) < place.distance_squared(on_base);
    let (nearest, flat) = if is_side { (on_side, side_normal) } else { (on_base, Vec2::NEG_Y) };
    let (normal, distance) = (place - nearest).normalize_and_length();
    // On the surface itself there is no direction to it.
    Surface { distance, normal: outward(if distance > 0.0 { normal } else { flat }) }
}

/// Direction from the axis Y to a point, and the distance. On the axis any direction will do.
fn axial(point: Vec3A) -> (Vec3A, f32) {
    let (across, from_axis) = Vec3A::new(point.x, 0.0, point.z).normalize_and_length();
    (if from_axis > 0.0 { across } else { Vec3A::X }, from_axis)
}

fn cylinder(point: Vec3A, radius: f32, half_height: f32) -> Surface {
    let (across, from_axis) = axial(point);
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

    fn all_solids() -> [Solid; 9] {
        [
            Solid::Sphere(Sphere::new(0.4)),
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
