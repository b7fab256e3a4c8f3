//! The ellipsoid: what a ball is under a scale that isn't the same along all axes.
//!
//! ```text
//!              n
//!              ^   . p        x is the place on the surface that is nearest to p, n the normal there:
//!              |  .
//!      . - - - x - - .        p = x + t (x_i / r_i²)    so    x_i = r_i² p_i / (t + r_i²)
//!    '    .            '
//!   (      r_i          )     and t is the largest root of    G(t) = sum (r_i p_i / (t + r_i²))² = 1
//! ```
//!
//! Eberly, "Distance from a point to an ellipse, an ellipsoid, or a hyperellipsoid" (2013), whose `s`, the root less the pole
//! next to it, is what is solved for: near the middle of something thin, t itself has no digits left.

use bevy_math::Vec3;
use bevy_reflect::Reflect;

use crate::{
    layout::{number::Number, simd::Vec3Wide},
    shape::solid::field::{SignedDistance, SignedDistanceField},
};

/// A ball that is drawn out or flattened along X, Y and Z: an egg, a cushion, a head.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Debug, Clone, PartialEq)]
pub struct Ellipsoid {
    /// Half of its lengths along its axes, m, greater than 0. The shortest counts as a millionth of the longest at least.
    pub half_size: Vec3,
}

/// The shortest that a half may be of the longest, so that no square overflows.
const THINNEST: f32 = 1e-6;

/// How near to the middle of its shortest axis a place may be, in lengths of the longest half: from the very middle, both sides
/// are as far, and one is chosen.
const NEAREST_TO_MIDDLE: f32 = 1e-12;

/// Iterations at most. Random places in and around ellipsoids of up to 20:1 took two to three in the mean and 11 at most, where
/// the curvature's centre lies; after 12, distances of 100:1 are off by 1e-6 of the longest half.
const ITERATIONS: u32 = 12;

/// The G at which the root is near enough. The error of the distance is of the second order in that of the root.
const CLOSE: f32 = 1.0 + 1e-5;

impl Ellipsoid {
    /// Whether it is a ball, but for what rounding makes of scales along a chain of parents.
    pub fn is_ball(&self) -> bool {
        const ROUNDING: f32 = 1e-4;
        self.half_size.min_element() >= (1.0 - ROUNDING) * self.half_size.max_element()
    }

    /// The lesser and the greater radius of curvature where it is most pointed, m: at the ends of its longest axis.
    pub(crate) fn tip_radii(&self) -> [f32; 2] {
        let ([a, b, c], _) = self.sorted();
        [c * c / a, b * b / a]
    }

    /// Its halves, the longest first, and the number of the axis that each is on.
    pub(crate) fn sorted(&self) -> ([f32; 3], [usize; 3]) {
        let mut axes = [0, 1, 2];
        axes.sort_by(|&i, &j| self.half_size[j].total_cmp(&self.half_size[i]));
        (axes.map(|axis| self.half_size[axis]), axes)
    }
}

impl SignedDistanceField for Ellipsoid {
    /// Newton's method on 1 / sqrt(G), which is concave, and nearly a straight line in s: from below the root it comes nearer
    /// from below always (Moré and Sorensen, "Computing a trust region step", 1983). A lane that is near enough stays as it is,
    /// so the bits are the same whatever the others do.
    ///
    /// The distance is that of the plane with the normal which is found that touches the surface. None is farther away than the
    /// surface, so no error makes the distance greater than it is.
    #[inline(always)]
    fn sample<N: Number>(&self, point: Vec3Wide<N>) -> SignedDistance<N> {
        let some = point.x;
        let (one, middle) = (some.broadcast(1.0), some.broadcast(NEAREST_TO_MIDDLE));
        // In lengths of the longest half.
        let size = self.half_size.max_element();
        let r = (self.half_size / size).max(Vec3::splat(THINNEST));
        // r_i² less the least of them: zero along the shortest axis.
        let d = (r - r.min_element()) * (r + r.min_element());
        let off_middle = |p: N, d: f32| if d > 0.0 { p } else { middle.select(p.absolute().is_below(middle), p) };
        let p = point * some.broadcast(1.0 / size);
        let p = Vec3Wide { x: off_middle(p.x, d.x), y: off_middle(p.y, d.y), z: off_middle(p.z, d.z) };
        let rp = Vec3Wide { x: p.x.absolute() * r.x, y: p.y.absolute() * r.y, z: p.z.absolute() * r.z };
        // The roots of fewer or lesser summands: that of each alone, and that of all with the greatest d.
        let mut s = (rp.x - d.x).at_least(rp.y - d.y).at_least(rp.z - d.z);
        s = s.at_least(rp.dot(rp).square_root() - d.max_element());
        for _ in 0..ITERATIONS {
            let pole = Vec3Wide { x: one / (s + d.x), y: one / (s + d.y), z: one / (s + d.z) };
            let x = Vec3Wide { x: rp.x * pole.x, y: rp.y * pole.y, z: rp.z * pole.z };
            let g = x.dot(x);
            let is_below = some.broadcast(CLOSE).is_below(g);
            if !N::is_any(is_below) {
                break;
            }
            let x = Vec3Wide { x: x.x * x.x, y: x.y * x.y, z: x.z * x.z };
            s = (s + g * (g.square_root() - 1.0) / x.dot(pole)).select(is_below, s);
        }
        let out = Vec3Wide { x: p.x / (s + d.x), y: p.y / (s + d.y), z: p.z / (s + d.z) };
        let reached = Vec3Wide { x: out.x * r.x, y: out.y * r.y, z: out.z * r.z };
        let scale = one / out.dot(out).square_root();
        let distance = (p.dot(out) - reached.dot(reached).square_root()) * scale;
        SignedDistance { distance: distance * size, normal: out * scale }
    }
}

#[cfg(test)]
mod tests {
    use bevy_math::{DVec3, Vec3A};
    use fearless_simd::dispatch;

    use super::*;
    use crate::{
        layout::simd::{SimdLevel, Vec3x8},
        shape::Solid,
    };

    fn random(random: &mut fastrand::Rng, most: Vec3) -> Vec3 {
        let mut one = || 2.0 * random.f32() - 1.0;
        Vec3::new(one(), one(), one()) * most
    }

    /// Ellipsoids of up to 20:1 and of all proportions, and places in and around each: anywhere, on its axes, in the plane of
    /// its middle, and where the centres of its rim's curvature lie.
    fn cases() -> Vec<(Ellipsoid, Vec3)> {
        let mut rng = fastrand::Rng::with_seed(7);
        let mut cases = Vec::new();
        for i in 0..40_000 {
            let mut one = || bevy_math::ops::powf(20.0, -rng.f32());
            let half_size = match i / 8 % 4 {
                0 => Vec3::new(one(), 1.0, 1.0),
                1 => Vec3::new(1.0, one(), 1.0),
                2 => Vec3::new(one(), 1.0, 1.0) * Vec3::new(1.0, 0.05, 0.05),
                _ => Vec3::new(one(), one(), one()),
            };
            let axis = Vec3::AXES[rng.usize(..3)];
            let place = match i % 8 {
                0 => random(&mut rng, half_size),
                1 => random(&mut rng, Vec3::splat(2.0)),
                2 => random(&mut rng, Vec3::splat(20.0)),
                3 => random(&mut rng, 2.0 * half_size) * axis,
                4 => random(&mut rng, 1.5 * half_size) * (1.0 - axis),
                5 => random(&mut rng, Vec3::ONE).normalize_or(Vec3::X) * half_size * (0.95 + 0.1 * rng.f32()),
                6 => {
                    let ([a, b, c], axes) = Ellipsoid { half_size }.sorted();
                    let (sine, cosine) = bevy_math::ops::sin_cos(7.0 * rng.f32());
                    let mut place = Vec3::ZERO;
                    place[axes[0]] = (a * a - c * c) / a * cosine * (0.98 + 0.04 * rng.f32());
                    place[axes[1]] = (b * b - c * c) / b * sine * (0.98 + 0.04 * rng.f32());
                    place[axes[2]] = c * bevy_math::ops::powf(10.0, -6.0 * rng.f32());
                    place
                }
                _ => Vec3::ZERO,
            };
            cases.push((Ellipsoid { half_size }, place));
        }
        cases
    }

    /// By halving, in f64.
    fn distance(Ellipsoid { half_size }: Ellipsoid, place: Vec3) -> f64 {
        let (r, mut p) = (half_size.as_dvec3(), place.as_dvec3().abs());
        let least = r.min_element();
        let d = r * r - least * least;
        p = DVec3::select(p.cmplt(DVec3::splat(1e-30)) & d.cmple(DVec3::ZERO), DVec3::splat(1e-30), p);
        let g = |s: f64| (r * p / (s + d)).length_squared();
        let mut low = (r * p - d).max_element();
        let mut high = low;
        while g(high) > 1.0 {
            high *= 2.0;
        }
        for _ in 0..200 {
            // First by orders of magnitude.
            let middle = if high > 2.0 * low { (low * high).sqrt() } else { (low + high) / 2.0 };
            *(if g(middle) > 1.0 { &mut low } else { &mut high }) = middle;
        }
        let x = r * r * p / (low + d);
        (p - x).length().copysign(low - least * least)
    }

    #[test]
    fn the_distance_is_that_of_the_nearest_place() {
        let mut worst = (0.0, 0.0);
        for (ellipsoid, place) in cases() {
            let size = f64::from(ellipsoid.half_size.max_element().max(place.abs().max_element()));
            let expected = distance(ellipsoid, place);
            let sample = Solid::Ellipsoid(ellipsoid).surface(place.into());
            let error = (f64::from(sample.distance) - expected).abs() / size;
            let foot = place - Vec3::from(sample.normal) * sample.distance;
            let off = distance(ellipsoid, foot).abs() / size;
            assert!(
                error < 1e-5 && off < 1e-5,
                "{ellipsoid:?} at {place}: {sample:?} for {expected}, its foot {off} off"
            );
            worst = (error.max(worst.0), off.max(worst.1));
        }
        println!("off by {:.1e} of the size, the foot by {:.1e}", worst.0, worst.1);
    }

    #[test]
    fn no_place_of_the_surface_is_nearer() {
        let mut rng = fastrand::Rng::with_seed(8);
        for (ellipsoid, place) in cases().into_iter().step_by(40) {
            let sample = Solid::Ellipsoid(ellipsoid).surface(place.into()).distance.abs();
            let places = (0..500).map(|_| random(&mut rng, Vec3::ONE).normalize_or(Vec3::X) * ellipsoid.half_size);
            let nearest = places.map(|on_surface| on_surface.distance(place)).fold(f32::MAX, f32::min);
            assert!(
                nearest > sample - 1e-5 * (1.0 + place.length()),
                "{ellipsoid:?} at {place}: {nearest} m, not {sample}"
            );
        }
    }

    #[test]
    fn one_place_and_eight_give_the_same_bits() {
        for cases in cases().chunks_exact(8) {
            let ellipsoid = cases[0].0;
            let block = [0, 1, 2].map(|axis| core::array::from_fn(|i| cases[i].1[axis]));
            let (mut distance, mut normal) = ([0.0; 8], [[0.0; 8]; 3]);
            dispatch!(SimdLevel::Best.level(), simd => {
                let sample = ellipsoid.sample(Vec3x8::load(simd, &block));
                distance = sample.distance.into();
                sample.normal.store(&mut normal);
            });
            for (i, (_, place)) in cases.iter().enumerate() {
                let one = ellipsoid.sample(Vec3Wide::from(Vec3A::from(*place)));
                let bits = |numbers: [f32; 4]| numbers.map(f32::to_bits);
                let eight = [distance[i], normal[0][i], normal[1][i], normal[2][i]];
                assert_eq!(bits(eight), bits([one.distance, one.normal.x, one.normal.y, one.normal.z]), "{place}");
            }
        }
    }

    #[test]
    fn a_flat_disc_of_no_thickness_is_touched_from_both_sides() {
        let disc = Solid::Ellipsoid(Ellipsoid { half_size: Vec3::new(0.5, 0.0, 0.5) });
        for (place, expected) in
            [(Vec3A::Y, 1.0), (Vec3A::new(0.2, -0.3, 0.1), 0.3), (Vec3A::X, 0.5), (Vec3A::ZERO, 0.0)]
        {
            let sample = disc.surface(place);
            assert!((sample.distance - expected).abs() < 1e-5, "{place}: {sample:?}");
            assert!(sample.normal.is_normalized(), "{place}: {sample:?}");
        }
    }
}
