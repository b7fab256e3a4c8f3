//! Triangles: the gradient of their energy, and the product of its second derivatives with a direction.
//!
//! ```text
//!           c               u = u1 (xb - xa) + u2 (xc - xa): a step along the warp, deformed
//!         /   \             v = v1 (xb - xa) + v2 (xc - xa): one along the weft
//!       a ----- b           strains (|u| - 1, |v| - 1, u·v), after Baraff and Witkin (1998)
//! ```
//!
//! With tensions T and the shear stress S of a sheet (see [`Moduli`](crate::material::Moduli)) and û, v̂ the directions of u and v,
//! the energy over the area changes by T û·δu + S v·δu + T v̂·δv + S u·δv. Its second derivatives are those of the strains'
//! squares, and T/|u| across u, which is what holds a taut cloth. Where the cloth is pressed together that would be negative,
//! and is left out.

use bevy_math::Vec3A;
use fearless_simd::{f32x8, prelude::*};

use crate::{
    constraint::strand::law::DirectionModuli,
    layout::simd::{Lane, SHORTEST, Vec3x8, lane},
    particles::gathered::{add, gather},
    topology::face_pack::FacePack,
};

/// What the second derivatives of eight faces are made of, times h² and their areas.
#[derive(Clone, Copy, Debug)]
pub(super) struct FaceTangent {
    /// Directions of warp and weft.
    pub along: [[Lane; 3]; 2],
    /// Lengths of a step along warp and weft, no unit.
    pub length: [Lane; 2],
    /// Stiffness along them, less that across, kg m².
    pub stiffness: [Lane; 2],
    /// Stiffness of their tension, kg m².
    pub tension: [Lane; 2],
}

impl FaceTangent {
    /// What the face in a lane answers with to a `way` of those of its corners that go along: these have the slopes `by_u` and
    /// `by_v` (1/m) along warp and weft, and `g` is G h² times its area, kg m². The same as
    /// [`WideTangent::multiply`], for one.
    pub fn resist(&self, lane: usize, way: Vec3A, [by_u, by_v]: [f32; 2], g: f32) -> Vec3A {
        let Self { along, length, stiffness, tension } = self;
        let [u, v] = along.map(|axes| Vec3A::from_array(axes.map(|lanes| lanes[lane])));
        let [[lu, lv], [ku, kv], [tu, tv]] = [length, stiffness, tension].map(|both| both.map(|lanes| lanes[lane]));
        let (du, dv) = (way * by_u, way * by_v);
        let (eu, ev) = (u.dot(du), v.dot(dv));
        let shear = (u.dot(dv) * lu + v.dot(du) * lv) * g;
        let on_u = u * (eu * ku + ev * g) + v * (shear * lv) + du * tu;
        let on_v = v * (ev * kv + eu * g) + u * (shear * lu) + dv * tv;
        on_u * by_u + on_v * by_v
    }
}

/// Where the particles are, m: now, before the substep, and the way of those that are free.
#[derive(Clone, Copy)]
pub(super) struct Places<'a> {
    pub now: &'a [[f32; 4]],
    pub before: &'a [[f32; 4]],
    pub inertia: &'a [[f32; 4]],
}

/// What is added up, kg m.
pub(super) struct Sums<'a> {
    pub gradient: &'a mut [[f32; 4]],
    /// The second derivatives times the inertia.
    pub product: &'a mut [[f32; 4]],
}

/// Adds up what all faces have, and collects their tangents.
#[inline(always)]
pub(super) fn linearise<S: Simd, const DAMPED: bool>(
    simd: S,
    packs: &[FacePack],
    laws: &[DirectionModuli; 2],
    places: Places,
    sums: Sums,
    tangents: &mut Vec<FaceTangent>,
) {
    let Places { now, before, inertia } = places;
    for pack in packs {
        let sides = Sides::new(simd, pack);
        let [u, v] = sides.steps_of(simd, now, pack);
        let [du, dv] = sides.steps_of(simd, inertia, pack);
        let rates = if DAMPED {
            let [u_before, v_before] = sides.steps_of(simd, before, pack);
            Some([u - u_before, v - v_before])
        } else {
            None
        };
        let (gradient, tangent) = stress(simd, [u, v], rates, laws, sides.area);
        sides.add(simd, gradient, pack, sums.gradient);
        let wide = WideTangent::load(simd, &tangent);
        sides.add(simd, wide.multiply([du, dv], sides.area * coupling(laws[0])), pack, sums.product);
        tangents.push(tangent);
    }
}

/// Adds the second derivatives times a direction.
#[inline(always)]
pub(super) fn multiply<S: Simd>(
    simd: S,
    packs: &[FacePack],
    tangents: &[FaceTangent],
    law: DirectionModuli,
    direction: &[[f32; 4]],
    product: &mut [[f32; 4]],
) {
    for (pack, tangent) in packs.iter().zip(tangents) {
        let sides = Sides::new(simd, pack);
        let steps = sides.steps_of(simd, direction, pack);
        let pull = WideTangent::load(simd, tangent).multiply(steps, sides.area * coupling(law));
        sides.add(simd, pull, pack, product);
    }
}

/// G h² with its damping, kg.
pub(super) fn coupling(law: DirectionModuli) -> f32 {
    law.shear * (1.0 + law.damping)
}

/// Derivatives of the energy by both steps, and what the second ones are made of.
#[inline(always)]
fn stress<S: Simd>(
    simd: S,
    [u, v]: [Vec3x8<S>; 2],
    rates: Option<[Vec3x8<S>; 2]>,
    [warp, weft]: &[DirectionModuli; 2],
    area: f32x8<S>,
) -> ([Vec3x8<S>; 2], FaceTangent) {
    let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
    let shortest = f32x8::splat(simd, SHORTEST);
    let (length_u, length_v) = (u.dot(u).sqrt().max(shortest), v.dot(v).sqrt().max(shortest));
    let (per_u, per_v) = (one / length_u, one / length_v);
    let (along_u, along_v) = (u * per_u, v * per_v);
    let (mut strain_u, mut strain_v, mut shear) = (length_u - one, length_v - one, u.dot(v));
    let (secant_u, secant_v) = (warp.secant(simd, strain_u), weft.secant(simd, strain_v));
    let (slope_u, slope_v) = (warp.tangent(simd, strain_u), weft.tangent(simd, strain_v));
    if let Some([du, dv]) = rates {
        strain_u += along_u.dot(du) * warp.damping;
        strain_v += along_v.dot(dv) * warp.damping;
        shear += (du.dot(v) + u.dot(dv)) * warp.damping;
    }
    let g = warp.shear;
    let tension_u = (secant_u * strain_u + strain_v * g) * area;
    let tension_v = (secant_v * strain_v + strain_u * g) * area;
    let shear = shear * g * area;
    let gradient = [along_u * tension_u + v * shear, along_v * tension_v + u * shear];
    let (taut_u, taut_v) = (tension_u.max(zero) * per_u, tension_v.max(zero) * per_v);
    let damped = area * (1.0 + warp.damping);
    let tangent = FaceTangent {
        along: [
            [along_u.x.into(), along_u.y.into(), along_u.z.into()],
            [along_v.x.into(), along_v.y.into(), along_v.z.into()],
        ],
        length: [length_u.into(), length_v.into()],
        stiffness: [(slope_u * damped - taut_u).into(), (slope_v * damped - taut_v).into()],
        tension: [taut_u.into(), taut_v.into()],
    };
    (gradient, tangent)
}

/// Weights of the sides of eight faces, 1/m, and their areas, m².
struct Sides<S: Simd> {
    warp: [f32x8<S>; 2],
    weft: [f32x8<S>; 2],
    area: f32x8<S>,
}

impl<S: Simd> Sides<S> {
    #[inline(always)]
    fn new(simd: S, pack: &FacePack) -> Self {
        let [u1, u2] = &pack.warp;
        let [v1, v2] = &pack.weft;
        Self {
            warp: [lane(simd, u1), lane(simd, u2)],
            weft: [lane(simd, v1), lane(simd, v2)],
            area: lane(simd, &pack.area),
        }
    }

    /// Steps along warp and weft between what the corners have in a list.
    #[inline(always)]
    fn steps_of(&self, simd: S, list: &[[f32; 4]], pack: &FacePack) -> [Vec3x8<S>; 2] {
        let [a, b, c] = &pack.particles;
        // Spelled out: a closure isn't taken along to the instruction set chosen.
        let [ax, ay, az, _] = gather(simd, list, a);
        let [bx, by, bz, _] = gather(simd, list, b);
        let [cx, cy, cz, _] = gather(simd, list, c);
        let a = Vec3x8 { x: ax, y: ay, z: az };
        let (ab, ac) = (Vec3x8 { x: bx, y: by, z: bz } - a, Vec3x8 { x: cx, y: cy, z: cz } - a);
        [ab * self.warp[0] + ac * self.warp[1], ab * self.weft[0] + ac * self.weft[1]]
    }

    /// Adds to the corners what derivatives by both steps are at them.
    #[inline(always)]
    fn add(&self, simd: S, [by_u, by_v]: [Vec3x8<S>; 2], pack: &FacePack, sums: &mut [[f32; 4]]) {
        let at_b = by_u * self.warp[0] + by_v * self.weft[0];
        let at_c = by_u * self.warp[1] + by_v * self.weft[1];
        let [a, b, c] = &pack.particles;
        add(simd, sums, a, Vec3x8::splat(simd, [0.0; 3]) - (at_b + at_c));
        add(simd, sums, b, at_b);
        add(simd, sums, c, at_c);
    }
}

/// A tangent in registers.
struct WideTangent<S: Simd> {
    along: [Vec3x8<S>; 2],
    length: [f32x8<S>; 2],
    stiffness: [f32x8<S>; 2],
    tension: [f32x8<S>; 2],
}

impl<S: Simd> WideTangent<S> {
    #[inline(always)]
    fn load(simd: S, tangent: &FaceTangent) -> Self {
        let FaceTangent { along: [u, v], length: [lu, lv], stiffness: [ku, kv], tension: [tu, tv] } = tangent;
        Self {
            along: [Vec3x8::load(simd, u), Vec3x8::load(simd, v)],
            length: [lane(simd, lu), lane(simd, lv)],
            stiffness: [lane(simd, ku), lane(simd, kv)],
            tension: [lane(simd, tu), lane(simd, tv)],
        }
    }

    /// Derivatives by both steps of the quadratic form at steps `du` and `dv`, where G times the area is `g`.
    #[inline(always)]
    fn multiply(&self, [du, dv]: [Vec3x8<S>; 2], g: f32x8<S>) -> [Vec3x8<S>; 2] {
        let Self { along: [u, v], length: [lu, lv], stiffness: [ku, kv], tension: [tu, tv] } = *self;
        let (eu, ev) = (u.dot(du), v.dot(dv));
        let shear = (u.dot(dv) * lu + v.dot(du) * lv) * g;
        [u * (eu * ku + ev * g) + v * (shear * lv) + du * tu, v * (ev * kv + eu * g) + u * (shear * lu) + dv * tv]
    }
}

#[cfg(test)]
mod tests {
    use fearless_simd::dispatch;
    use proptest::{collection, prop_assert, prop_assert_eq, proptest, test_runner::Config};

    use super::*;
    use crate::{
        constraint::unstructured::face::{
            FaceStrain,
            tests::{FACE, JERSEY, state},
        },
        layout::simd::SimdLevel,
        material::Moduli,
        topology::Face,
    };

    const H: f32 = 0.01;

    /// Eleven copies of the face, each at corners of its own, in two packs.
    fn packs() -> Vec<FacePack> {
        let face = |i: u32| Face { particles: [3 * i, 3 * i + 1, 3 * i + 2], ..FACE };
        let faces: Vec<Face> = (0..11).map(face).collect();
        faces.chunks(8).map(|faces| FacePack::new(faces, 33)).collect()
    }

    fn list(points: [Vec3A; 3]) -> Vec<[f32; 4]> {
        let points = points.map(|p| [p.x, p.y, p.z, 1.0]);
        points.into_iter().cycle().take(33).chain([[0.0; 4]]).collect()
    }

    fn points(list: &[[f32; 4]]) -> [Vec3A; 3] {
        assert!(list[..33].chunks(3).all(|three| three == &list[..3]) && list[33] == [0.0; 4]);
        [0, 1, 2].map(|i| Vec3A::from_slice(&list[i]))
    }

    /// Gradient and product with a direction, N and N, of the corners of one face.
    fn linearised(
        corners: [Vec3A; 3],
        before: [Vec3A; 3],
        direction: [Vec3A; 3],
        moduli: &Moduli,
        simd_level: SimdLevel,
    ) -> [[Vec3A; 3]; 2] {
        let (packs, laws) = (packs(), DirectionModuli::both(moduli, H));
        let (now, before, inertia) = (list(corners), list(before), list(direction));
        let (mut gradient, mut product, mut tangents) = (vec![[0.0; 4]; 34], vec![[0.0; 4]; 34], Vec::new());
        let places = Places { now: &now, before: &before, inertia: &inertia };
        let sums = Sums { gradient: &mut gradient, product: &mut product };
        dispatch!(simd_level.level(), simd => {
            if moduli.stretch_damping > 0.0 {
                linearise::<_, true>(simd, &packs, &laws, places, sums, &mut tangents);
            } else {
                linearise::<_, false>(simd, &packs, &laws, places, sums, &mut tangents);
            }
        });
        let mut again = vec![[0.0; 4]; 34];
        dispatch!(simd_level.level(), simd => multiply(simd, &packs, &tangents, laws[0], &inertia, &mut again));
        assert_eq!(again, product, "the product that is made on the way is that of the tangents");
        [points(&gradient), points(&product)].map(|of| of.map(|p| p / (H * H)))
    }

    proptest! {
        #![proptest_config(Config { failure_persistence: None, ..Config::default() })]

        #[test]
        fn the_gradient_is_the_force_of_the_textbook_and_the_product_symmetric(
            noise in collection::vec(-1.0_f32..1.0, 36),
        ) {
            let (corners, velocities) = state(&noise);
            let before = [0, 1, 2].map(|i| corners[i] - velocities[i] * H);
            let (one, _) = state(&noise[9..]);
            let (other, _) = state(&noise[18..]);
            let [gradient, product] = linearised(corners, before, one, &JERSEY, SimdLevel::Best);
            let rates = FaceStrain::new(&FACE, velocities);
            let [b, c] = FaceStrain::new(&FACE, corners).forces(&FACE, &JERSEY, &rates, f32::MAX);
            let size = 1.0 + b.length() + c.length();
            for (gradient, force) in gradient.into_iter().zip([-(b + c), b, c]) {
                prop_assert!((gradient + force).length() < 1e-3 * size, "{gradient} {force}");
            }
            let [_, back] = linearised(corners, before, other, &JERSEY, SimdLevel::Best);
            let dot = |p: &[Vec3A; 3], q: &[Vec3A; 3]| p.iter().zip(q).map(|(p, q)| p.dot(*q)).sum::<f32>();
            let (there, back, stiffness) = (dot(&product, &other), dot(&back, &one), dot(&product, &one));
            prop_assert!((there - back).abs() < 1e-3 * (1.0 + there.abs()), "{there} {back}");
            prop_assert!(stiffness > -1e-3, "{stiffness}");
            let baseline = linearised(corners, before, one, &JERSEY, SimdLevel::Baseline);
            prop_assert_eq!(baseline, [gradient, product]);
        }
    }

    #[test]
    fn the_product_is_the_slope_of_the_gradient_where_the_cloth_is_taut_and_square() {
        let moduli = Moduli { stretch_damping: 0.0, ..JERSEY };
        let corners = [Vec3A::ZERO, Vec3A::X * 1.1, Vec3A::X * 0.33 + Vec3A::Y * 0.96];
        let way = [Vec3A::new(0.1, 0.4, -0.7), Vec3A::new(-0.3, 0.2, 0.5), Vec3A::new(0.6, -0.1, 0.3)];
        let gradient = |share: f32| {
            let moved = [0, 1, 2].map(|i| corners[i] + way[i] * share);
            linearised(moved, moved, way, &moduli, SimdLevel::Best)[0]
        };
        let [_, product] = linearised(corners, corners, way, &moduli, SimdLevel::Best);
        let (more, less) = (gradient(1e-3), gradient(-1e-3));
        for i in 0..3 {
            let slope = (more[i] - less[i]) / 2e-3;
            assert!((slope - product[i]).length() < 0.01 * product[i].length(), "{slope} {}", product[i]);
        }
    }
}
