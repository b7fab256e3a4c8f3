//! Triangles of cloth, one by one: what the forces of the textbook and the energy follow.
//!
//! ```text
//!           c               wu = u1 (xb - xa) + u2 (xc - xa): a step along the warp, deformed
//!         /   \             wv = v1 (xb - xa) + v2 (xc - xa): one along the weft
//!       a ----- b           C  = (|wu| - 1, |wv| - 1, wu·wv)
//! ```
//!
//! The strains of Baraff and Witkin, "Large Steps in Cloth Simulation" (1998), with the matrix K of a sheet (see
//! [`Moduli`]) between them, and its stress K (C + τ dC/dt).

use bevy_math::Vec3A;

use crate::{
    material::{Moduli, SpringConstants, SpringLaw},
    topology::{Face, Grain},
};

/// The strains of a face.
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
pub(crate) mod tests {
    use proptest::{collection, prop_assert, proptest, test_runner::Config};

    use super::*;

    pub const JERSEY: Moduli = Moduli {
        stretch: [80.0, 150.0],
        shear: 37.0,
        stiffening: [3.0, 8.0],
        compression: 0.3,
        bending: 0.0,
        stretch_damping: 0.02,
        bend_damping: 0.0,
    };

    /// The triangle (0, 0), (1, 0), (0.3, 0.8), with the weft along x and the warp along y.
    pub const FACE: Face = Face { particles: [0, 1, 2], warp: [-0.375, 1.25], weft: [1.0, 0.0], area: 0.4 };

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

    /// Its corners and their velocities, away from a turned rest by random numbers.
    pub fn state(noise: &[f32]) -> ([Vec3A; 3], [Vec3A; 3]) {
        let by = |i: usize| Vec3A::from_slice(&noise[3 * i..]);
        let corners = deformed(Vec3A::new(0.8, 0.6, 0.0), Vec3A::new(-0.6, 0.8, 0.0));
        ([0, 1, 2].map(|i| corners[i] + by(i) * 0.3), [3, 4, 5].map(by))
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
    }
}
