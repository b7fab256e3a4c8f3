//! The closest points of the two pairs of features that meshes touch with first: a point and a triangle, two edges.
//!
//! That of a point and a triangle is here twice. [`on_triangle`] asks in front of which corner, side or face the point is, and
//! stops at the first answer: the faster one for a single point, and finite where a triangle has no area. Eight points side by
//! side would take eight ways through it; for them, `on_triangle_without_branches` works out all sides and the inside, and
//! chooses. Both agree but for rounding, and neither may take the other's place: steps would have other bits.

use bevy_math::Vec3A;

use crate::layout::{number::Number, simd::Vec3Wide};

/// Weights of the corners of the triangle `[a, b, c]` at its place closest to `p`. Ericson, "Real-Time Collision
/// Detection" (2005), section 5.1.5: in front of which corner, side or face `p` is. All are finite and 1 in sum, but for
/// rounding; of a triangle with next to no area, which is all rounding, some may be below 0.
#[inline]
pub fn on_triangle(p: Vec3A, [a, b, c]: [Vec3A; 3]) -> Vec3A {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return Vec3A::X;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return Vec3A::Y;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let v = share(d1, d1 - d3);
        return Vec3A::new(1.0 - v, v, 0.0);
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return Vec3A::Z;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let w = share(d2, d2 - d6);
        return Vec3A::new(1.0 - w, 0.0, w);
    }
    let va = d3 * d6 - d5 * d4;
    let (along, back) = (d4 - d3, d5 - d6);
    if va <= 0.0 && along >= 0.0 && back >= 0.0 {
        let w = share(along, along + back);
        return Vec3A::new(0.0, 1.0 - w, w);
    }
    let whole = va + vb + vc;
    let (v, w) = (share(vb, whole), share(vc, whole));
    Vec3A::new(1.0 - v - w, v, w)
}

/// Weights of the corners of a triangle at its place closest to `p`: its inside where `p` is above that, else the closest of
/// its edges. Of a triangle without area, the weights needn't be finite.
#[inline(always)]
pub(crate) fn on_triangle_without_branches<N: Number>(p: Vec3Wide<N>, [a, b, c]: [Vec3Wide<N>; 3]) -> Vec3Wide<N> {
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

/// The place of a triangle that is closest to `p`.
#[inline]
pub fn place_on_triangle(p: Vec3A, [a, b, c]: [Vec3A; 3]) -> Vec3A {
    let weights = on_triangle(p, [a, b, c]);
    a * weights.x + b * weights.y + c * weights.z
}

/// How far along each of the edges `[a, b]` and `[c, d]` they are closest, 0..=1. Ericson, section 5.1.9.
#[inline]
pub fn on_edges([a, b]: [Vec3A; 2], [c, d]: [Vec3A; 2]) -> (f32, f32) {
    /// Edges whose sine is less than the root of this are parallel: any place will do.
    const PARALLEL: f32 = 1e-6;
    let (u, v, r) = (b - a, d - c, a - c);
    let (uu, vv, uv) = (u.length_squared(), v.length_squared(), u.dot(v));
    let (ur, vr) = (u.dot(r), v.dot(r));
    let cross = uu * vv - uv * uv;
    let s = if cross > PARALLEL * uu * vv { ((uv * vr - ur * vv) / cross).clamp(0.0, 1.0) } else { 0.5 };
    let t = share(uv * s + vr, vv);
    let along = t.clamp(0.0, 1.0);
    // Where the other edge ends first, the place on this one moves along.
    let s = if t == along { s } else { share(uv * along - ur, uu).clamp(0.0, 1.0) };
    (s, along)
}

/// A part of a whole; none of nothing.
#[inline]
fn share(part: f32, whole: f32) -> f32 {
    if whole == 0.0 { 0.0 } else { part / whole }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = Vec3A> {
        prop::array::uniform3(-1.0_f32..1.0).prop_map(Vec3A::from)
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn no_place_on_a_triangle_is_closer(p in point(), corners in prop::array::uniform3(point())) {
            let [a, b, c] = corners;
            let at = |weights: Vec3A| a * weights.x + b * weights.y + c * weights.z;
            let weights = on_triangle(p, corners);
            prop_assert!(weights.min_element() >= -1e-4 && (weights.element_sum() - 1.0).abs() < 1e-4);
            let distance = at(weights).distance(p);
            for i in 0..=20 {
                for j in 0..=20 - i {
                    let (v, w) = (i as f32 / 20.0, j as f32 / 20.0);
                    prop_assert!(at(Vec3A::new(1.0 - v - w, v, w)).distance(p) > distance - 1e-4);
                }
            }
        }

        #[test]
        fn places_without_branches_are_those_with(p in point(), corners in prop::array::uniform3(point())) {
            let [a, b, c] = corners;
            prop_assume!((b - a).cross(c - a).length() > 0.01);
            let at = |weights: Vec3A| a * weights.x + b * weights.y + c * weights.z;
            let expected = at(on_triangle(p, corners));
            let found = at(on_triangle_without_branches(p.into(), corners.map(Vec3Wide::from)).into());
            prop_assert!((p.distance(found) - p.distance(expected)).abs() < 1e-4, "{found} for {expected}");
        }

        #[test]
        fn a_triangle_without_area_has_finite_weights(p in point(), ends in prop::array::uniform2(point()), at in 0.0_f32..1.0) {
            let [a, b] = ends;
            prop_assert!(on_triangle(p, [a, b, a.lerp(b, at)]).is_finite());
        }

        #[test]
        fn no_two_places_on_edges_are_closer(first in prop::array::uniform2(point()), other in prop::array::uniform2(point())) {
            let at = |[a, b]: [Vec3A; 2], s: f32| a.lerp(b, s);
            let (s, t) = on_edges(first, other);
            prop_assert!((0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t));
            let distance = at(first, s).distance(at(other, t));
            for i in 0..=20 {
                for j in 0..=20 {
                    let apart = at(first, i as f32 / 20.0).distance(at(other, j as f32 / 20.0));
                    prop_assert!(apart > distance - 1e-4, "{apart} for {distance}");
                }
            }
        }
    }

    #[test]
    fn what_has_no_size_has_a_closest_place_too() {
        let (p, q) = (Vec3A::ONE, Vec3A::X);
        assert!(on_triangle(p, [q; 3]).is_finite());
        let needle = [Vec3A::ZERO, Vec3A::X, Vec3A::X * 0.5];
        assert_eq!(place_on_triangle(Vec3A::new(0.25, 1.0, 0.0), needle), Vec3A::X * 0.25);
        let (s, t) = on_edges([p, p], [q, q]);
        assert!(s.is_finite() && t.is_finite());
        // Parallel edges beside each other.
        let (s, t) = on_edges([Vec3A::ZERO, Vec3A::X], [Vec3A::Y, Vec3A::Y + Vec3A::X]);
        assert!((s - t).abs() < 1e-6);
    }
}
