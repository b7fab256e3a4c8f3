//! The nearest places of faces, eight at a time.

use fearless_simd::{f32x8, prelude::*};

use crate::{
    contact::mesh::BlockCache,
    layout::{
        number::Number,
        points::Block,
        simd::{Vec3Wide, Vec3x8, lane},
    },
    shape::solid::field::SignedDistance,
};

/// Shares by which lengths of nearest places may differ that are one and the same, but for rounding.
const SAME: f32 = 1e-5;

/// Below this length (m) nothing has a direction.
const SHORTEST: f32 = 1e-18;

/// The nearest place of the faces that each particle of a block knows.
pub(crate) struct NearestPoint<S: Simd> {
    pub sample: SignedDistance<f32x8<S>>,
    /// Weights of the face's corners there.
    weights: Vec3x8<S>,
    /// Number of that face.
    number: f32x8<S>,
}

/// Finds the nearest places from `place`.
#[inline(always)]
pub(crate) fn nearest<S: Simd>(
    simd: S,
    place: Vec3x8<S>,
    faces: &[[Block; 3]],
    known: &BlockCache,
    is_closed: bool,
) -> NearestPoint<S> {
    let zero = f32x8::splat(simd, 0.0);
    let nothing = Vec3x8::splat(simd, [0.0; 3]);
    let mut squared = f32x8::splat(simd, f32::MAX);
    let mut steep = f32x8::splat(simd, -1.0);
    let (mut between, mut outward, mut weights) = (nothing, nothing, nothing);
    let mut number = zero;
    for (k, [a, b, c]) in faces.iter().enumerate() {
        let (a, b, c) = (Vec3x8::load(simd, a), Vec3x8::load(simd, b), Vec3x8::load(simd, c));
        let at = on_triangle(place, [a, b, c]);
        let way = place - (a * at.x + b * at.y + c * at.z);
        let normal = (b - a).cross(c - a);
        let length = way.dot(way);
        let along = normal.dot(way);
        let steepness = along * along / normal.dot(normal);
        // Of faces that share the nearest place, the one that looks towards the particle knows the side that it is on.
        let is_same = length.simd_le(squared * (1.0 + SAME)) & steepness.simd_gt(steep);
        let is_nearer = length.simd_lt(squared * (1.0 - SAME)) | is_same;
        squared = is_nearer.select(length, squared);
        steep = is_nearer.select(steepness, steep);
        between = way.or(is_nearer, between);
        outward = normal.or(is_nearer, outward);
        weights = at.or(is_nearer, weights);
        number = is_nearer.select(f32x8::splat(simd, k as f32), number);
    }
    let length = squared.sqrt();
    let one = f32x8::splat(simd, 1.0);
    let has_direction = length.simd_gt(SHORTEST);
    let direction = (between * (one / length)).or(has_direction, outward * (one / outward.dot(outward).sqrt()));
    let is_behind = outward.dot(between).simd_lt(zero) & has_direction;
    let (distance, normal) = match is_closed {
        true => (is_behind.select(-length, length), (nothing - direction).or(is_behind, direction)),
        false => (length, direction),
    };
    let distance = distance + lane(simd, &known.beyond);
    NearestPoint { sample: SignedDistance { distance, normal }, weights, number }
}

impl<S: Simd> NearestPoint<S> {
    /// How far the nearest places have come within the substep, in the frame of the mesh, m.
    #[inline(always)]
    pub fn way_from(&self, simd: S, then: &[[Block; 3]], now: &[[Block; 3]]) -> Vec3x8<S> {
        let mut way = Vec3x8::splat(simd, [0.0; 3]);
        for (k, (then, now)) in then.iter().zip(now).enumerate() {
            let come = |corner: usize| Vec3x8::load(simd, &now[corner]) - Vec3x8::load(simd, &then[corner]);
            let face = come(0) * self.weights.x + come(1) * self.weights.y + come(2) * self.weights.z;
            way = face.or(self.number.simd_eq(k as f32), way);
        }
        way
    }
}

/// Weights of the corners of a triangle at its place closest to `p`: its inside where `p` is above that, else the closest of
/// its edges. Without branches, see [`on_triangle`](crate::geometry::closest_point::on_triangle).
#[inline(always)]
fn on_triangle<N: Number>(p: Vec3Wide<N>, [a, b, c]: [Vec3Wide<N>; 3]) -> Vec3Wide<N> {
    let (zero, one) = (p.x.broadcast(0.0), p.x.broadcast(1.0));
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (bb, cc, bc) = (ab.dot(ab), ac.dot(ac), ab.dot(ac));
    let (pb, pc) = (ab.dot(ap), ac.dot(ap));
    // Cramer's rule for the foot of the perpendicular.
    let whole = one / (bb * cc - bc * bc);
    let (v, w) = ((cc * pb - bc * pc) * whole, (bb * pc - bc * pb) * whole);
    let u = one - v - w;
    // Along each edge, and how far from it, but for the height above the plane, which is the same for all.
    let clamped = |share: N| share.at_least(zero).at_most(one);
    let edge = bb - bc - bc + cc;
    let (t_ab, t_ac) = (clamped(pb / bb), clamped(pc / cc));
    let t_bc = clamped((pc - pb + bb - bc) / edge);
    let from_a = |v: N, w: N| {
        // |ap - v ab - w ac|² less |ap|².
        v * (v * bb - (pb + pb)) + w * (w * cc - (pc + pc)) + (v * w) * (bc + bc)
    };
    let (far_ab, far_ac, far_bc) = (from_a(t_ab, zero), from_a(zero, t_ac), from_a(one - t_bc, t_bc));
    let is_ac = far_ac.is_below(far_ab);
    let far = far_ac.select(is_ac, far_ab);
    let is_bc = far_bc.is_below(far);
    let edge_v = (one - t_bc).select(is_bc, zero.select(is_ac, t_ab));
    let edge_w = t_bc.select(is_bc, t_ac.select(is_ac, zero));
    let is_inside = zero.is_below(u) & zero.is_below(v) & zero.is_below(w);
    let (v, w) = (v.select(is_inside, edge_v), w.select(is_inside, edge_w));
    Vec3Wide { x: one - v - w, y: v, z: w }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::closest_point;
    use bevy_math::Vec3A;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = Vec3A> {
        prop::array::uniform3(-1.0_f32..1.0).prop_map(Vec3A::from)
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn places_without_branches_are_those_with(p in point(), corners in prop::array::uniform3(point())) {
            let [a, b, c] = corners;
            prop_assume!((b - a).cross(c - a).length() > 0.01);
            let at = |weights: Vec3A| a * weights.x + b * weights.y + c * weights.z;
            let expected = at(closest_point::on_triangle(p, corners));
            let found = at(on_triangle(p.into(), corners.map(Vec3Wide::from)).into());
            prop_assert!((p.distance(found) - p.distance(expected)).abs() < 1e-4, "{found} for {expected}");
        }
    }
}
