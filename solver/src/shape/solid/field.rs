//! The formulas, for one point and for eight.
//!
//! They are those of Quilez, "Distance functions", and exact outside and inside, so a sphere trace along them never steps
//! over a surface.

use bevy_math::{
    Vec2, Vec3, Vec3A,
    primitives::{Capsule3d, Cone, Cuboid, Cylinder, InfinitePlane3d, Sphere},
};

use crate::{
    layout::{number::Number, simd::Vec3Wide},
    shape::TaperedCapsule,
};

/// Below this length (m) nothing has a direction: its square would be rounded away.
const SHORTEST: f32 = 1e-18;

/// Surfaces as they are seen from points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SignedDistance<N> {
    /// Distance, m; negative inside.
    pub distance: N,
    /// Outward unit normal.
    pub normal: Vec3Wide<N>,
}

/// A solid that is seen from points in its own frame (m).
pub(crate) trait SignedDistanceField: Copy {
    fn sample<N: Number>(&self, point: Vec3Wide<N>) -> SignedDistance<N>;
}

impl SignedDistanceField for Sphere {
    #[inline(always)]
    fn sample<N: Number>(&self, point: Vec3Wide<N>) -> SignedDistance<N> {
        ball(point, point.x.broadcast(self.radius))
    }
}

/// The centre is as far from all sides: any direction will do.
#[inline(always)]
fn ball<N: Number>(point: Vec3Wide<N>, radius: N) -> SignedDistance<N> {
    let length = point.dot(point).square_root();
    let scale = point.x.broadcast(1.0) / length;
    let (zero, one) = (point.x.broadcast(0.0), point.x.broadcast(1.0));
    let is_long = zero.broadcast(SHORTEST).is_below(length);
    SignedDistance {
        distance: length - radius,
        normal: (point * scale).select(is_long, Vec3Wide { x: zero, y: one, z: zero }),
    }
}

impl SignedDistanceField for Cuboid {
    #[inline(always)]
    fn sample<N: Number>(&self, point: Vec3Wide<N>) -> SignedDistance<N> {
        let (half, zero) = (self.half_size, point.x.broadcast(0.0));
        let (x, y, z) = (point.x.absolute() - half.x, point.y.absolute() - half.y, point.z.absolute() - half.z);
        let outside = Vec3Wide { x: x.at_least(zero), y: y.at_least(zero), z: z.at_least(zero) };
        let length = outside.dot(outside).square_root();
        let is_outside = zero.broadcast(SHORTEST).is_below(length);
        // Inside, the nearest face.
        let depth = x.at_least(y).at_least(z);
        let (is_y, is_z) = (x.is_below(depth), x.at_least(y).is_below(depth));
        let one = zero.broadcast(1.0);
        let axis = Vec3Wide {
            x: zero.select(is_y, one),
            y: zero.select(is_z, one.select(is_y, zero)),
            z: one.select(is_z, zero),
        };
        let normal = (outside * (one / length)).select(is_outside, axis);
        SignedDistance {
            distance: length.select(is_outside, depth),
            normal: Vec3Wide {
                x: (-normal.x).select(point.x.is_below(zero), normal.x),
                y: (-normal.y).select(point.y.is_below(zero), normal.y),
                z: (-normal.z).select(point.z.is_below(zero), normal.z),
            },
        }
    }
}

impl SignedDistanceField for Capsule3d {
    #[inline(always)]
    fn sample<N: Number>(&self, point: Vec3Wide<N>) -> SignedDistance<N> {
        let end = point.y.broadcast(self.half_length);
        let on_axis = point.y.at_least(-end).at_most(end);
        ball(Vec3Wide { y: point.y - on_axis, ..point }, end.broadcast(self.radius))
    }
}

impl SignedDistanceField for TaperedCapsule {
    /// Where the cone that touches both balls does so, the side of it is nearest; above and below, a ball is.
    #[inline(always)]
    fn sample<N: Number>(&self, point: Vec3Wide<N>) -> SignedDistance<N> {
        let Self { radius_top, radius_bottom, half_length } = *self;
        let some = point.x;
        // Sine of the angle between the cone's side and the axis.
        let sine = (radius_bottom - radius_top) / (2.0 * half_length);
        if sine.is_nan() || sine.absolute() >= 1.0 {
            // One ball has the other within.
            let (radius, end) =
                if radius_top > radius_bottom { (radius_top, half_length) } else { (radius_bottom, -half_length) };
            return ball(Vec3Wide { y: point.y - end, ..point }, some.broadcast(radius));
        }
        let cosine = (1.0 - sine * sine).sqrt();
        let (across, from_axis) = axial(point);
        let height = point.y + half_length;
        let along = height * cosine - from_axis * sine;
        let (is_low, is_side) =
            (along.is_below(some.broadcast(0.0)), along.is_below(some.broadcast(cosine * 2.0 * half_length)));
        let (end, radius) = (
            some.broadcast(-half_length).select(is_low, some.broadcast(half_length)),
            some.broadcast(radius_bottom).select(is_low, some.broadcast(radius_top)),
        );
        let ends = ball(Vec3Wide { y: point.y - end, ..point }, radius);
        let distance = from_axis * cosine + height * sine - radius_bottom;
        let side = SignedDistance { distance, normal: outward(across, some.broadcast(cosine), some.broadcast(sine)) };
        side.select(is_side & !is_low, ends)
    }
}

impl SignedDistanceField for Cylinder {
    #[inline(always)]
    fn sample<N: Number>(&self, point: Vec3Wide<N>) -> SignedDistance<N> {
        let (across, from_axis) = axial(point);
        let (zero, one) = (point.x.broadcast(0.0), point.x.broadcast(1.0));
        let (side, end) = (from_axis - self.radius, point.y.absolute() - self.half_height);
        let (beside, above) = (side.at_least(zero), end.at_least(zero));
        let length = (beside * beside + above * above).square_root();
        let none = zero.broadcast(SHORTEST);
        let is_corner = none.is_below(side) & none.is_below(end);
        let is_side = end.is_below(side);
        let (out, up) = (one.select(is_side, zero), zero.select(is_side, one));
        let scale = one / length;
        let (out, up) = ((beside * scale).select(is_corner, out), (above * scale).select(is_corner, up));
        let up = (-up).select(point.y.is_below(zero), up);
        SignedDistance { distance: length.select(is_corner, side.at_least(end)), normal: outward(across, out, up) }
    }
}

impl SignedDistanceField for Cone {
    #[inline(always)]
    fn sample<N: Number>(&self, point: Vec3Wide<N>) -> SignedDistance<N> {
        let some = point.x;
        let zero = some.broadcast(0.0);
        let (across, from_axis) = axial(point);
        let half_height = self.height / 2.0;
        let down = Vec2::new(self.radius, -self.height);
        let slant = down.length();
        let side_normal = Vec2::new(self.height, self.radius) / slant;
        // Below the tip, and below the base.
        let (below, beyond_base) = (point.y - half_height, -point.y - half_height);
        let beyond_side = from_axis * side_normal.x + below * side_normal.y;
        let along = ((from_axis * down.x + below * down.y) * (1.0 / (slant * slant)))
            .at_least(zero)
            .at_most(some.broadcast(1.0));
        let (side_x, side_y) = (from_axis - along * down.x, below - along * down.y);
        let (base_x, base_y) = (from_axis - from_axis.at_most(some.broadcast(self.radius)), -beyond_base);
        let is_side = (side_x * side_x + side_y * side_y).is_below(base_x * base_x + base_y * base_y);
        let (x, y) = (side_x.select(is_side, base_x), side_y.select(is_side, base_y));
        let length = (x * x + y * y).square_root();
        let scale = some.broadcast(1.0) / length;
        let is_inside = !zero.is_below(beyond_side) & !zero.is_below(beyond_base);
        // Inside, and on the surface itself, which has no direction to it, the normal of side or base.
        let is_flat_side = beyond_base.is_below(beyond_side);
        let (flat_x, flat_y) = (
            some.broadcast(side_normal.x).select(is_flat_side, zero),
            some.broadcast(side_normal.y).select(is_flat_side, some.broadcast(-1.0)),
        );
        let has_direction = !is_inside & some.broadcast(SHORTEST).is_below(length);
        let (out, up) = ((x * scale).select(has_direction, flat_x), (y * scale).select(has_direction, flat_y));
        let depth = beyond_side.at_least(beyond_base);
        SignedDistance { distance: depth.select(is_inside, length), normal: outward(across, out, up) }
    }
}

impl SignedDistanceField for InfinitePlane3d {
    #[inline(always)]
    fn sample<N: Number>(&self, point: Vec3Wide<N>) -> SignedDistance<N> {
        let normal: Vec3A = Vec3::from(self.normal).into();
        let some = point.x;
        let normal = Vec3Wide { x: some.broadcast(normal.x), y: some.broadcast(normal.y), z: some.broadcast(normal.z) };
        SignedDistance { distance: normal.dot(point), normal }
    }
}

impl<N: Number> SignedDistance<N> {
    /// `self` where that is so, else `other`.
    #[inline(always)]
    fn select(self, so: N::Mask, other: Self) -> Self {
        Self { distance: self.distance.select(so, other.distance), normal: self.normal.select(so, other.normal) }
    }
}

/// Direction along X and Z from the axis Y to a point, and the distance. On the axis any direction will do.
#[inline(always)]
fn axial<N: Number>(point: Vec3Wide<N>) -> ((N, N), N) {
    let from_axis = (point.x * point.x + point.z * point.z).square_root();
    let (zero, one) = (point.x.broadcast(0.0), point.x.broadcast(1.0));
    let is_off = zero.broadcast(SHORTEST).is_below(from_axis);
    let scale = one / from_axis;
    (((point.x * scale).select(is_off, one), (point.z * scale).select(is_off, zero)), from_axis)
}

/// So far from the axis, and so far along it.
#[inline(always)]
fn outward<N: Number>((x, z): (N, N), out: N, up: N) -> Vec3Wide<N> {
    Vec3Wide { x: x * out, y: up, z: z * out }
}
