//! The physical constants of a cloth, as the solver reads them.

use crate::topology::{Grain, Spring, SpringKind};

/// What a cloth is made of. All values are finite and not negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Areal density, kg/m². Greater than zero.
    pub density: f32,
    /// How it answers to being deformed.
    pub elasticity: Elasticity,
    /// Damping of the velocity, 1/s.
    pub damping: f32,
    /// Thickness, m.
    pub thickness: f32,
    /// Coulomb friction against obstacles, no unit.
    pub friction: f32,
    /// Drag coefficient, no unit.
    pub drag: f32,
    /// Lift coefficient, no unit.
    pub lift: f32,
}

/// How a cloth answers to being deformed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Elasticity {
    /// By springs that are alike, whatever the size of the mesh's cells. Constants by [`SpringKind::index`].
    Springs([SpringConstants; 3]),
    /// By what a laboratory measures, whatever the mesh.
    Moduli(Moduli),
}

/// Constants of one kind of spring.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpringConstants {
    /// Stiffness k of Hooke's law, N/m. Zero switches the kind off.
    pub stiffness: f32,
    /// Damping along the spring, N·s/m.
    pub damping: f32,
}

/// Moduli of a sheet: forces over the width that they act on, N/m.
///
/// In its plane the sheet answers to strains εu along the warp, εv along the weft and the shear angle γ with
///
/// ```text
///   ┌ Tu ┐   ┌ Cu  G   0 ┐ ┌ εu ┐
///   │ Tv │ = │ G   Cv  0 │ │ εv │
///   └ S  ┘   └ 0   0   G ┘ └ γ  ┘
/// ```
///
/// One constant G serves as shear modulus and as what couples warp and weft: that is what springs along threads and
/// diagonals amount to (Cauchy's relation), so springs and triangles can be the same sheet.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moduli {
    /// Cu and Cv by [`Grain::index`], N/m. Not smaller than G.
    pub stretch: [f32; 2],
    /// G, N/m.
    pub shear: f32,
    /// By how much the threads' part C - G grows with their strain, by [`Grain::index`], no unit: tension is
    /// (C - G)(ε + s ε²/2).
    pub stiffening: [f32; 2],
    /// Share of C - G that is left of threads that are pressed together, 0..=1.
    pub compression: f32,
    /// Bending rigidity, N·m.
    pub bending: f32,
    /// Retardation time of the stretch, s: the damping over the stiffness.
    pub stretch_damping: f32,
    /// Retardation time of bending, s.
    pub bend_damping: f32,
}

impl Moduli {
    /// Makes the sheet that gives back what a laboratory measures on strips with free sides: `pulled`, the force over
    /// width and strain along warp and weft, N/m, and its growth with the strain, `stiffening` (no unit).
    ///
    /// A strip that is pulled along the warp gets narrower until nothing pulls across: Tv = 0 gives
    /// Tu / εu = Cu - G²/Dv, with Dv = G + compression · (Cv - G), as the weft is pressed together. The other way round
    /// the same. None where that would need C < G, which is where `shear` is more than [`most_shear`](Self::most_shear).
    pub fn from_strips(pulled: [f32; 2], shear: f32, stiffening: [f32; 2], compression: f32) -> Option<Self> {
        let mut moduli = Self { stretch: pulled.map(|k| k + shear), shear, compression, ..Self::default() };
        // Each round leaves a small part of the error: that of a second is mostly too small for the numbers.
        for _ in 0..64 {
            moduli.stretch = [0, 1].map(|i| pulled[i] + moduli.narrowing(i));
        }
        let threads = moduli.stretch.map(|c| c - shear);
        // Of a strip, only the threads' part stiffens.
        let growth = |i: usize| if threads[i] > 0.0 { stiffening[i] * pulled[i] / threads[i] } else { 0.0 };
        moduli.stiffening = [growth(0), growth(1)];
        (shear <= Self::most_shear(pulled)).then_some(moduli)
    }

    /// What strips with free sides take along warp and weft, N/m: what [`from_strips`](Self::from_strips) was given.
    pub fn pulled(&self) -> [f32; 2] {
        [0, 1].map(|i| self.stretch[i] - self.narrowing(i))
    }

    /// What a strip along one direction takes less because it may get narrower, N/m: G²/D.
    fn narrowing(&self, along: usize) -> f32 {
        let pressed = self.shear + self.compression * (self.stretch[1 - along] - self.shear);
        if pressed > 0.0 { self.shear * self.shear / pressed } else { 0.0 }
    }

    /// The largest shear modulus (N/m) that goes with strips of such stiffness: k K / (K - k) for the smaller k and the
    /// larger K. Infinite where both are equal.
    pub fn most_shear([warp, weft]: [f32; 2]) -> f32 {
        let (smaller, larger) = (warp.min(weft), warp.max(weft));
        smaller / (larger - smaller) * larger
    }

    /// Bending rigidity, N·m, and its damping, N·m·s.
    pub fn rigidity(&self) -> SpringConstants {
        SpringConstants { stiffness: self.bending, damping: self.bending * self.bend_damping }
    }

    /// Stiffness of a spring at its rest length, N/m.
    pub fn of_spring(&self, spring: &Spring) -> f32 {
        let [warp, weft, shear] = spring.share;
        // A cell that is very long and narrow would need springs that push apart.
        (warp * self.stretch[0] + weft * self.stretch[1] + shear * self.shear).max(0.0)
    }
}

/// Hooke's law of one spring, and how it departs from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringLaw {
    /// Stiffness and damping at rest length.
    pub constants: SpringConstants,
    /// By how much the stiffness grows with the strain, no unit: tension is k L (ε + s ε²/2).
    pub stiffening: f32,
    /// Share of the stiffness that is left where it is pressed together, 0..=1.
    pub compression: f32,
}

impl SpringLaw {
    /// Tension over change of length at a strain, N/m.
    pub fn secant(&self, strain: f32) -> f32 {
        let factor = if strain < 0.0 { self.compression } else { 1.0 + 0.5 * self.stiffening * strain };
        self.constants.stiffness * factor
    }

    /// Energy of a spring with length `rest` (m) at a strain, J.
    pub fn energy(&self, rest: f32, strain: f32) -> f32 {
        let factor = if strain < 0.0 { self.compression } else { 1.0 + self.stiffening * strain / 3.0 };
        0.5 * self.constants.stiffness * factor * (strain * rest) * (strain * rest)
    }
}

impl Material {
    /// A cloth without thickness, friction, damping and air.
    pub const fn bare(density: f32, elasticity: Elasticity) -> Self {
        Self { density, elasticity, damping: 0.0, thickness: 0.0, friction: 0.0, drag: 0.0, lift: 0.0 }
    }

    /// What one spring of a kind does.
    pub fn spring(&self, kind: SpringKind, spring: &Spring) -> SpringLaw {
        match &self.elasticity {
            Elasticity::Springs(constants) => {
                SpringLaw { constants: constants[kind.index()], stiffening: 0.0, compression: 1.0 }
            }
            Elasticity::Moduli(moduli) => {
                let stiffness = moduli.of_spring(spring);
                let constants = SpringConstants { stiffness, damping: stiffness * moduli.stretch_damping };
                if kind == SpringKind::Structural {
                    let stiffening = moduli.stiffening[spring.grain().index()];
                    SpringLaw { constants, stiffening, compression: moduli.compression }
                } else {
                    SpringLaw { constants, stiffening: 0.0, compression: 1.0 }
                }
            }
        }
    }

    /// Whether anything in it damps its deformation.
    pub fn is_damped(&self) -> bool {
        match &self.elasticity {
            Elasticity::Springs(constants) => constants.iter().any(|constants| constants.damping > 0.0),
            Elasticity::Moduli(moduli) => moduli.stretch_damping + moduli.bend_damping > 0.0,
        }
    }

    /// By how much of its length a cloth that hangs by few points is stretched at most by its weight while it swings, for
    /// each metre of its length, 1/m. Zero for springs, which are whatever they are.
    ///
    /// A strip that hangs by its edge is stretched by ρ g L / k at the top. Hung by two corners, cloth of 1 m was measured to
    /// be stretched three to six times as much along its geodesics to them, farther than 10 cm away (jersey; stiffer cloth
    /// more yet, where that is far too little to be seen).
    pub fn stretch_under_weight(&self, gravity: f32) -> f32 {
        const BY_FEW_POINTS: f32 = 6.0;
        self.moduli().map_or(0.0, |moduli| {
            let softest = moduli.pulled().into_iter().fold(f32::INFINITY, f32::min);
            BY_FEW_POINTS * self.density * gravity / softest.max(f32::MIN_POSITIVE)
        })
    }

    /// The moduli, if it is made of such.
    pub fn moduli(&self) -> Option<&Moduli> {
        match &self.elasticity {
            Elasticity::Springs(_) => None,
            Elasticity::Moduli(moduli) => Some(moduli),
        }
    }

    /// The stiffest that a strand is, N/m: on a square grid, that of a spring.
    pub fn strand_stiffness(&self) -> SpringConstants {
        match &self.elasticity {
            Elasticity::Springs([structural, ..]) => *structural,
            Elasticity::Moduli(moduli) => {
                let stiffness = moduli.stretch[Grain::Warp.index()].max(moduli.stretch[Grain::Weft.index()]);
                SpringConstants { stiffness, damping: stiffness * moduli.stretch_damping }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_strip_gives_back_what_was_measured() {
        for compression in [1.0, 0.3, 0.0] {
            for (k, shear) in [([33.0, 69.0], 37.0), ([4000.0, 4000.0], 50.0), ([411.0, 2028.0], 53.0)] {
                let moduli = Moduli::from_strips(k, shear, [0.0; 2], compression).unwrap();
                for (pulled, k) in moduli.pulled().into_iter().zip(k) {
                    assert!((pulled / k - 1.0).abs() < 1e-4, "{k} {compression}");
                }
            }
        }
        // The springs of a square grid of jersey.
        let jersey = Moduli::from_strips([33.0, 69.0], 37.0, [0.0; 2], 1.0).unwrap();
        assert!((jersey.stretch[0] - 37.0 - 9.9).abs() < 0.1 && (jersey.stretch[1] - 37.0 - 61.2).abs() < 0.1);
    }

    #[test]
    fn what_springs_cannot_do_is_refused() {
        assert!((Moduli::most_shear([10.0, 30.0]) - 15.0).abs() < 1e-4);
        assert!(Moduli::from_strips([10.0, 30.0], 14.9, [0.0; 2], 1.0).is_some());
        assert_eq!(Moduli::from_strips([10.0, 30.0], 15.1, [0.0; 2], 1.0), None);
        assert!(Moduli::from_strips([10.0, 10.0], 1e6, [0.0; 2], 1.0).is_some());
    }
}
