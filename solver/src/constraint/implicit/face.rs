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
