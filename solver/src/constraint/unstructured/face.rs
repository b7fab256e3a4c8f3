//! Triangles of cloth.
//!
//! ```text
//!           c               wu = u1 (xb - xa) + u2 (xc - xa): a step along the warp, deformed
//!         /   \             wv = v1 (xb - xa) + v2 (xc - xa): one along the weft
//!       a ----- b           C  = (|wu| - 1, |wv| - 1, wu·wv)
//! ```
//!
//! The strains of Baraff and Witkin, "Large Steps in Cloth Simulation" (1998), with the matrix K of a sheet (see
//! [`Moduli`]) between them, and its stress K (C + τ dC/dt). All three are solved together in XPBD's form (see
//! [`spring`](crate::constraint::unstructured::spring)): with the triangle's area A and P = A h² K,
//!
//! (P (1 + τ/h) J W Jᵀ + 1) lambda = -P (C + τ/h J Δx)
//!
//! where J are the gradients. The matrix K = L D Lᵀ has G/Cu as the only other element of L, so strains Lᵀ C have nothing
//! but D between them: what warp and weft have in common is then in the gradients. Elimination of what is left divides by
//! numbers of one or more only, whatever the stiffness and the triangle.

use bevy_math::Vec3A;
use fearless_simd::{dispatch, f32x8, prelude::*};

use crate::{
    constraint::strand::law::DirectionModuli,
    layout::{
        points::apart,
        simd::{LANES, SHORTEST, SimdLevel, Vec3x8, lane},
    },
    material::{Moduli, SpringConstants, SpringLaw},
    particles::gathered::GatheredParticles,
    topology::{Face, Grain},
};

/// Factor on the diagonal of J W Jᵀ. Where a triangle has collapsed, its strains can't all be undone along the gradients
/// that it has now: with this it doesn't try. Of what is very stiff, a hundredth is left for the next substep.
const CAUTION: f32 = 1.01;

/// Solves the faces of one batch, which share no particle.
pub(crate) fn solve(
    gathered: &mut GatheredParticles,
    faces: &[Face],
    grid: &[DirectionModuli; 2],
    simd_level: SimdLevel,
) {
    let level = simd_level.level();
    if grid[0].damping > 0.0 {
        dispatch!(level, simd => solve_batch::<_, true>(simd, gathered, faces, grid));
    } else {
        dispatch!(level, simd => solve_batch::<_, false>(simd, gathered, faces, grid));
    }
}

#[inline(always)]
fn solve_batch<S: Simd, const DAMPED: bool>(
    simd: S,
    gathered: &mut GatheredParticles,
    faces: &[Face],
    grid: &[DirectionModuli; 2],
) {
    let (groups, rest) = faces.as_chunks::<LANES>();
    for faces in groups {
        solve_gathered::<S, DAMPED>(simd, gathered, faces, grid);
    }
    if !rest.is_empty() {
        let mut faces = [Face { particles: [gathered.dummy(); 3], ..Face::default() }; LANES];
        faces[..rest.len()].copy_from_slice(rest);
        solve_gathered::<S, DAMPED>(simd, gathered, &faces, grid);
    }
}

/// What eight faces are made of.
struct FaceStress<S: Simd> {
    warp: [f32x8<S>; 2],
    weft: [f32x8<S>; 2],
    area: f32x8<S>,
}

#[inline(always)]
fn solve_gathered<S: Simd, const DAMPED: bool>(
    simd: S,
    gathered: &mut GatheredParticles,
    faces: &[Face; LANES],
    grid: &[DirectionModuli; 2],
) {
    let [f0, f1, f2, f3, f4, f5, f6, f7] = faces;
    macro_rules! each {
        ($field:ident [$i:literal]) => {
            [
                f0.$field[$i],
                f1.$field[$i],
                f2.$field[$i],
                f3.$field[$i],
                f4.$field[$i],
                f5.$field[$i],
                f6.$field[$i],
                f7.$field[$i],
            ]
        };
    }
    let (a, b, c) = (each!(particles[0]), each!(particles[1]), each!(particles[2]));
    let eight = [&row(f0), &row(f1), &row(f2), &row(f3), &row(f4), &row(f5), &row(f6), &row(f7)];
    let [u1, u2, v1, v2] = apart(simd, eight);
    let cut = FaceStress {
        warp: [u1, u2],
        weft: [v1, v2],
        area: lane(simd, &[f0.area, f1.area, f2.area, f3.area, f4.area, f5.area, f6.area, f7.area]),
    };
    let corners =
        [gathered.end::<S, DAMPED>(simd, &a), gathered.end::<S, DAMPED>(simd, &b), gathered.end::<S, DAMPED>(simd, &c)];
    let before = [corners[0].previous, corners[1].previous, corners[2].previous];
    let masses = [corners[0].inverse_mass, corners[1].inverse_mass, corners[2].inverse_mass];
    let now = [corners[0].position, corners[1].position, corners[2].position];
    let [at_a, at_b, at_c] = solve_abreast::<S, DAMPED>(simd, now, before, masses, cut, grid);
    gathered.put(&a, at_a, masses[0]);
    gathered.put(&b, at_b, masses[1]);
    gathered.put(&c, at_c, masses[2]);
}

/// Weights of the steps of one face.
#[inline(always)]
fn row(face: &Face) -> [f32; 4] {
    [face.warp[0], face.warp[1], face.weft[0], face.weft[1]]
}

/// Steps along warp and weft.
#[inline(always)]
fn steps<S: Simd>([a, b, c]: [Vec3x8<S>; 3], cut: &FaceStress<S>) -> [Vec3x8<S>; 2] {
    let (ab, ac) = (b - a, c - a);
    [ab * cut.warp[0] + ac * cut.warp[1], ab * cut.weft[0] + ac * cut.weft[1]]
}

/// Where the corners of eight faces are moved to.
#[inline(always)]
fn solve_abreast<S: Simd, const DAMPED: bool>(
    simd: S,
    now: [Vec3x8<S>; 3],
    before: [Vec3x8<S>; 3],
    [wa, wb, wc]: [f32x8<S>; 3],
    cut: FaceStress<S>,
    [warp, weft]: &[DirectionModuli; 2],
) -> [Vec3x8<S>; 3] {
    let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
    let least = f32x8::splat(simd, SHORTEST);
    let [u, v] = steps(now, &cut);
    let (uu, vv, uv) = (u.dot(u), v.dot(v), u.dot(v));
    let (length_u, length_v) = (uu.sqrt().max(least), vv.sqrt().max(least));
    let (per_u, per_v) = (one / length_u, one / length_v);
    let (mut strain_u, mut strain_v, mut shear) = (length_u - 1.0, length_v - 1.0, uv);

    // The matrix, and its factors.
    let stiffness_u = warp.secant(simd, strain_u);
    let stiffness_v = weft.secant(simd, strain_v);
    let g = f32x8::splat(simd, warp.shear);
    let coupling = g / stiffness_u.max(f32x8::splat(simd, f32::MIN_POSITIVE));
    let area = cut.area;
    let (p1, p2, p3) = (stiffness_u * area, (stiffness_v - g * coupling).max(zero) * area, g * area);

    let (mut d1, mut d2, mut d3) = (p1, p2, p3);
    if DAMPED {
        let [u_before, v_before] = steps(before, &cut);
        let (du, dv) = (u - u_before, v - v_before);
        let damping = warp.damping;
        strain_u += u.dot(du) * per_u * damping;
        strain_v += v.dot(dv) * per_v * damping;
        shear += (du.dot(v) + u.dot(dv)) * damping;
        let factor = 1.0 + damping;
        (d1, d2, d3) = (p1 * factor, p2 * factor, p3 * factor);
    }
    let (r1, r2, r3) = (p1 * (strain_u + coupling * strain_v), p2 * strain_v, p3 * shear);

    // J W Jᵀ, with s the sums of the weights' products over the masses.
    let (ua, va) = (cut.warp[0] + cut.warp[1], cut.weft[0] + cut.weft[1]);
    let (ub, uc, vb, vc) = (cut.warp[0], cut.warp[1], cut.weft[0], cut.weft[1]);
    let su = ua * ua * wa + ub * ub * wb + uc * uc * wc;
    let sv = va * va * wa + vb * vb * wb + vc * vc * wc;
    let suv = ua * va * wa + ub * vb * wb + uc * vc * wc;
    let s12 = suv * uv * per_u * per_v;
    let s13 = su * uv * per_u + suv * length_u;
    let s23 = suv * length_v + sv * uv * per_v;
    let s33 = su * vv + sv * uu + suv * uv * 2.0;
    let s11 = su + coupling * (s12 * 2.0 + coupling * sv);
    let s13 = s13 + coupling * s23;
    let s12 = s12 + coupling * sv;

    let (s11, s22, s33) = (s11 * CAUTION, sv * CAUTION, s33 * CAUTION);
    let per_1 = one / (d1 * s11 + 1.0);
    let (y1, e12, e13) = (r1 * per_1, d1 * s12 * per_1, d1 * s13 * per_1);
    let t22 = (s22 - s12 * e12).max(zero);
    let t23 = s23 - s12 * e13;
    let per_2 = one / (d2 * t22 + 1.0);
    let (y2, e23) = ((r2 - d2 * s12 * y1) * per_2, d2 * t23 * per_2);
    let t33 = (s33 - s13 * e13 - t23 * e23).max(zero);
    let y3 = (r3 - d3 * (s13 * y1 + t23 * y2)) / (d3 * t33 + 1.0);
    let l2 = y2 - e23 * y3;
    let l1 = y1 - e12 * l2 - e13 * y3;

    // Less lambda, along the gradients.
    let along_u = u * (l1 * per_u) + v * y3;
    let along_v = v * ((coupling * l1 + l2) * per_v) + u * y3;
    [
        now[0] + (along_u * ua + along_v * va) * wa,
        now[1] - (along_u * ub + along_v * vb) * wb,
        now[2] - (along_u * uc + along_v * vc) * wc,
    ]
}

/// The strains of a face, one by one: what the forces of the textbook and the energy follow.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FaceStrain {
    warp: Vec3A,
    weft: Vec3A,
}

impl FaceStrain {
    /// Its steps along warp and weft between three points.
    pub fn new(face: &Face, [a, b, c]: [Vec3A; 3]) -> Self {
        let (ab, ac) = (b - a, c - a);
        let step = |[b, c]: [f32; 2]| ab * b + ac * c;
        Self { warp: step(face.warp), weft: step(face.weft) }
    }

    /// Strains along warp and weft, and of shear.
    fn strains(&self) -> [f32; 3] {
        [self.warp.length() - 1.0, self.weft.length() - 1.0, self.warp.dot(self.weft)]
    }

    /// Length over rest length along the direction in which it is stretched more.
    pub fn longest(&self) -> f32 {
        self.warp.length().max(self.weft.length())
    }

    /// Energy over the area, J/m².
    pub fn energy(&self, moduli: &Moduli) -> f32 {
        let [u, v, shear] = self.strains();
        let [along_u, along_v] = [thread(moduli, Grain::Warp), thread(moduli, Grain::Weft)];
        along_u.energy(1.0, u) + along_v.energy(1.0, v) + 0.5 * moduli.shear * ((u + v) * (u + v) + shear * shear)
    }

    /// Forces on the second and third corner of a face, N, with its corners' velocities (m/s) in `rates`. The first
    /// corner takes what is left.
    ///
    /// A face that is stretched to more than `longest` times its length gets no stiffer from there on: what a step in time
    /// is to be stable with has to be known before it.
    pub fn forces(&self, face: &Face, moduli: &Moduli, rates: &Self, longest: f32) -> [Vec3A; 2] {
        let [u, v, _] = self.strains();
        let (along_u, along_v) = (self.warp.normalize_or_zero(), self.weft.normalize_or_zero());
        let damped = |strain: f32, rate: f32| strain + moduli.stretch_damping * rate;
        let secant = |grain, strain: f32| thread(moduli, grain).secant(strain.min(longest - 1.0));
        let [k_u, k_v] = [secant(Grain::Warp, u), secant(Grain::Weft, v)];
        // The stiffness against shear grows with the square of the stretch.
        let kept = (longest / (u.max(v) + 1.0)).min(1.0);
        let (warp, weft) = (self.warp * kept, self.weft * kept);
        let (u, v) = (damped(u, along_u.dot(rates.warp)), damped(v, along_v.dot(rates.weft)));
        let shear = damped(warp.dot(weft), warp.dot(rates.weft) + weft.dot(rates.warp));
        let g = moduli.shear;
        let (tension_u, tension_v) = (k_u * u + g * (u + v), k_v * v + g * (u + v));
        let (stress_u, stress_v) = (along_u * tension_u + weft * (g * shear), along_v * tension_v + warp * (g * shear));
        [0, 1].map(|i| (stress_u * face.warp[i] + stress_v * face.weft[i]) * -face.area)
    }
}

/// What is of the threads alone along one direction, over the width: C - G.
fn thread(moduli: &Moduli, grain: Grain) -> SpringLaw {
    let stiffness = moduli.stretch[grain.index()] - moduli.shear;
    SpringLaw {
        constants: SpringConstants { stiffness, damping: 0.0 },
        stiffening: moduli.stiffening[grain.index()],
        compression: moduli.compression,
    }
}

#[cfg(test)]
mod tests {
    use proptest::{
        arbitrary::any, array, collection, prop_assert, prop_assert_eq, prop_oneof, proptest, strategy::Just,
        test_runner::Config,
    };

    use super::*;

    const JERSEY: Moduli = Moduli {
        stretch: [80.0, 150.0],
        shear: 37.0,
        stiffening: [3.0, 8.0],
        compression: 0.3,
        bending: 0.0,
        stretch_damping: 0.02,
        bend_damping: 0.0,
    };

    /// The triangle (0, 0), (1, 0), (0.3, 0.8), with the weft along x and the warp along y.
    const FACE: Face = Face { particles: [0, 1, 2], warp: [-0.375, 1.25], weft: [1.0, 0.0], area: 0.4 };

    /// Its corners where the plane is deformed: steps along weft and warp become these.
    fn deformed(weft: Vec3A, warp: Vec3A) -> [Vec3A; 3] {
        [Vec3A::ZERO, weft, weft * 0.3 + warp * 0.8]
    }

    #[test]
    fn a_strained_face_has_the_stress_of_the_sheet() {
        let linear = Moduli { stiffening: [0.0; 2], compression: 1.0, ..JERSEY };
        let (warp, weft, angle) = (2e-3, -1e-3, 3e-3);
        // Of shear alone, half to each side.
        let corners = deformed(Vec3A::new(1.0 + weft, angle / 2.0, 0.0), Vec3A::new(angle / 2.0, 1.0 + warp, 0.0));
        let at_rest = FaceStrain::new(&FACE, [Vec3A::ZERO; 3]);
        let forces = FaceStrain::new(&FACE, corners).forces(&FACE, &linear, &at_rest, f32::MAX);
        // Virtual work: the stress is the sum of forces times places over the area.
        let stress = |i: usize, j: usize| -> f32 {
            let sum: f32 = forces.iter().zip(&corners[1..]).map(|(force, p)| force[i] * p[j]).sum();
            -sum / FACE.area
        };
        let [cu, cv, g] = [linear.stretch[0], linear.stretch[1], linear.shear];
        for (stress, expected) in [
            (stress(1, 1), cu * warp + g * weft),
            (stress(0, 0), g * warp + cv * weft),
            (stress(0, 1), g * angle),
            (stress(1, 0), g * angle),
        ] {
            assert!((stress / expected - 1.0).abs() < 0.02, "{stress} {expected}");
        }
    }

    fn state(noise: &[f32]) -> ([Vec3A; 3], [Vec3A; 3]) {
        let by = |i: usize| Vec3A::from_slice(&noise[3 * i..]);
        let corners = deformed(Vec3A::new(0.8, 0.6, 0.0), Vec3A::new(-0.6, 0.8, 0.0));
        ([0, 1, 2].map(|i| corners[i] + by(i) * 0.3), [3, 4, 5].map(by))
    }

    /// Where the corners come in a substep of `h` seconds.
    fn solved(
        corners: [Vec3A; 3],
        before: [Vec3A; 3],
        masses: [f32; 3],
        moduli: &Moduli,
        h: f32,
        simd_level: SimdLevel,
    ) -> [Vec3A; 3] {
        let list = |points: [Vec3A; 3]| -> Vec<[f32; 4]> {
            let points = [0, 1, 2].map(|i| [points[i].x, points[i].y, points[i].z, masses[i]]);
            points.into_iter().chain([[0.0; 4]]).collect()
        };
        let mut gathered = GatheredParticles { now: list(corners), before: list(before) };
        solve(&mut gathered, &[FACE], &DirectionModuli::both(moduli, h), simd_level);
        [0, 1, 2].map(|i| Vec3A::from_slice(&gathered.now[i]))
    }

    proptest! {
        #![proptest_config(Config { failure_persistence: None, ..Config::default() })]

        #[test]
        fn forces_are_the_slope_of_the_energy(noise in collection::vec(-1.0_f32..1.0, 18)) {
            let (corners, velocities) = state(&noise);
            let rates = FaceStrain::new(&FACE, velocities);
            let bare = Moduli { stretch_damping: 0.0, ..JERSEY };
            let [b, c] = FaceStrain::new(&FACE, corners).forces(&FACE, &bare, &rates, f32::MAX);
            for (i, force) in [-(b + c), b, c].into_iter().enumerate() {
                for axis in [Vec3A::X, Vec3A::Y, Vec3A::Z] {
                    let energy = |way: f32| {
                        let mut corners = corners;
                        corners[i] += axis * way;
                        FaceStrain::new(&FACE, corners).energy(&bare) * FACE.area
                    };
                    let slope = (energy(2e-3) - energy(-2e-3)) / 4e-3;
                    prop_assert!((slope + force.dot(axis)).abs() < 0.2, "{slope} {force}");
                }
            }
            let [p, q] = FaceStrain::new(&FACE, corners).forces(&FACE, &JERSEY, &rates, f32::MAX);
            let work = (p - b).dot(velocities[1] - velocities[0]) + (q - c).dot(velocities[2] - velocities[0]);
            prop_assert!(work <= 1e-3, "{work}");
        }

        #[test]
        fn a_short_substep_moves_by_the_force_of_the_textbook(noise in collection::vec(-1.0_f32..1.0, 18)) {
            let (corners, velocities) = state(&noise);
            let h = 5e-4;
            let masses = [2.0, 1.0, 0.5];
            let before = [0, 1, 2].map(|i| corners[i] - velocities[i] * h);
            let rates = FaceStrain::new(&FACE, velocities);
            let [b, c] = FaceStrain::new(&FACE, corners).forces(&FACE, &JERSEY, &rates, f32::MAX);
            let moved = solved(corners, before, masses, &JERSEY, h, SimdLevel::Best);
            for i in 0..3 {
                let expected = [-(b + c), b, c][i] * masses[i] * h * h;
                let size = (b.length() + c.length()) * h * h;
                prop_assert!((moved[i] - corners[i] - expected).length() < 0.03 * size + 1e-6, "{expected}");
            }
            let baseline = solved(corners, before, masses, &JERSEY, h, SimdLevel::Baseline);
            prop_assert_eq!(moved, baseline);
        }

        #[test]
        fn whatever_the_stiffness_nothing_gets_away(
            noise in collection::vec(-1.0_f32..1.0, 18),
            stretch in array::uniform2(0.0_f32..9.0),
            shear in 0.0_f32..1.0,
            masses in array::uniform3(prop_oneof![Just(0.0_f32), Just(1e-3), Just(1e7)]),
            flat in any::<bool>(),
        ) {
            let stretch = stretch.map(|power| bevy_math::ops::powf(10.0, power) - 1.0);
            let shear = shear * stretch[0].min(stretch[1]);
            let moduli = Moduli { stretch, shear, ..JERSEY };
            let (corners, velocities) = state(&noise);
            let corners = if flat { [corners[0], corners[0], corners[1]] } else { corners };
            let before = [0, 1, 2].map(|i| corners[i] - velocities[i] * 0.01);
            let moved = solved(corners, before, masses, &moduli, 0.01, SimdLevel::Best);
            for i in 0..3 {
                prop_assert!(moved[i].distance(corners[i]) < 20.0, "{} {}", corners[i], moved[i]);
                prop_assert!(masses[i] > 0.0 || moved[i] == corners[i]);
            }
        }
    }

    #[test]
    fn one_solve_of_a_very_stiff_face_leaves_no_strain() {
        let linear = Moduli { stretch: [1e9, 2e9], shear: 5e8, compression: 1.0, stiffening: [0.0; 2], ..JERSEY };
        let bare = Moduli { stretch_damping: 0.0, ..linear };
        let corners = deformed(Vec3A::new(1.01, 0.02, 0.0), Vec3A::new(-0.01, 0.99, 0.0));
        let moved = solved(corners, corners, [1.0; 3], &bare, 0.01, SimdLevel::Best);
        let [u, v, shear] = FaceStrain::new(&FACE, moved).strains();
        assert!(u.abs() < 6e-4 && v.abs() < 6e-4 && shear.abs() < 1e-3, "{u} {v} {shear}");
    }
}
