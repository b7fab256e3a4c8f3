//! How springs side by side answer to being stretched.

use fearless_simd::{f32x8, prelude::*};

use crate::{
    layout::simd::{LANES, Lane, SHORTEST, Wide, lane},
    material::{Moduli, SpringConstants},
    topology::{Grain, Spring},
};

/// k h² and c h of springs that are alike in a substep of h seconds, kg.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scaled {
    pub k: f32,
    pub c: f32,
}

impl Scaled {
    pub fn new(constants: SpringConstants, h: f32) -> Self {
        Self { k: constants.stiffness * h * h, c: constants.damping * h }
    }

    /// Whether such springs do anything.
    pub fn acts(&self) -> bool {
        self.k + self.c > 0.0
    }
}

/// What some springs side by side follow.
pub(crate) trait WideSpringLaw<S: Simd, F: Wide<S>>: Copy {
    /// k h² and c h (kg) of springs of these lengths, at rest and now, m.
    fn scaled(self, simd: S, rest: F, length: F) -> [F; 2];
}

impl<S: Simd, F: Wide<S>> WideSpringLaw<S, F> for Scaled {
    #[inline(always)]
    fn scaled(self, simd: S, _: F, _: F) -> [F; 2] {
        [F::splat(simd, self.k), F::splat(simd, self.c)]
    }
}

/// Each spring with a k h² and a c h of its own.
impl<S: Simd, F: Wide<S>> WideSpringLaw<S, F> for [F; 2] {
    #[inline(always)]
    fn scaled(self, _: S, _: F, _: F) -> [F; 2] {
        self
    }
}

/// What the strands of a sheet follow along one of its directions, in a substep of h seconds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DirectionModuli {
    /// C h², kg.
    pub stretch: f32,
    /// G h², kg.
    pub shear: f32,
    /// Half of the growth with the strain: the secant's.
    half_stiffening: f32,
    compression: f32,
    /// Damping over stiffness, over h.
    pub damping: f32,
}

impl DirectionModuli {
    fn new(moduli: &Moduli, grain: Grain, h: f32) -> Self {
        let i = grain.index();
        Self {
            stretch: moduli.stretch[i] * h * h,
            shear: moduli.shear * h * h,
            half_stiffening: 0.5 * moduli.stiffening[i],
            compression: moduli.compression,
            damping: moduli.stretch_damping / h,
        }
    }

    /// Along both directions, by [`Grain::index`].
    pub fn both(moduli: &Moduli, h: f32) -> [Self; 2] {
        [Grain::Warp, Grain::Weft].map(|grain| Self::new(moduli, grain, h))
    }

    /// Tension over strain of a sheet along this direction, times h², at strains side by side, kg.
    #[inline(always)]
    pub fn secant<S: Simd, F: Wide<S>>(&self, simd: S, strain: F) -> F {
        let threads = (self.stretch - self.shear).max(0.0);
        let taut = strain * (self.half_stiffening * threads) + (threads + self.shear);
        let pressed = F::splat(simd, self.compression * threads + self.shear);
        strain.simd_gt(F::splat(simd, 0.0)).select(taut, pressed)
    }

    /// The slope of the tension by the strain, times h², at strains side by side, kg.
    #[inline(always)]
    pub fn tangent<S: Simd, F: Wide<S>>(&self, simd: S, strain: F) -> F {
        let threads = (self.stretch - self.shear).max(0.0);
        let taut = strain * (2.0 * self.half_stiffening * threads) + (threads + self.shear);
        let pressed = F::splat(simd, self.compression * threads + self.shear);
        strain.simd_gt(F::splat(simd, 0.0)).select(taut, pressed)
    }

    /// The same without what only strands do: stiffen, and give way where they are pressed together.
    pub fn linear(self) -> Self {
        Self { half_stiffening: 0.0, compression: 1.0, ..self }
    }
}

/// What some springs of a sheet's strands follow.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShareLaw<F> {
    /// k h² over the rest length, kg/m.
    per_length: F,
    half_stiffening: F,
    compression: f32,
    damping: f32,
}

impl<S: Simd, F: Wide<S>> WideSpringLaw<S, F> for ShareLaw<F> {
    #[inline(always)]
    fn scaled(self, _: S, rest: F, length: F) -> [F; 2] {
        let Self { per_length, half_stiffening, compression, damping } = self;
        // k (1 + s ε/2) as k/L (L + s (l - L)/2), with s = 0 where it is pressed together.
        let taut = rest + (length - rest) * half_stiffening;
        let k = per_length * length.simd_gt(rest).select(taut, rest * compression);
        [k, k * damping]
    }
}

impl<F> ShareLaw<F> {
    /// Of springs with a k h² over the rest length (kg/m) that are along the warp where that part of them is the larger.
    #[inline(always)]
    fn along<S: Simd>(
        simd: S,
        [warp, weft]: [F; 2],
        per_length: F,
        [along_warp, along_weft]: [DirectionModuli; 2],
    ) -> Self
    where
        F: Wide<S>,
    {
        let stiffening = |grading: DirectionModuli| F::splat(simd, grading.half_stiffening);
        let half_stiffening = warp.simd_ge(weft).select(stiffening(along_warp), stiffening(along_weft));
        Self { per_length, half_stiffening, compression: along_warp.compression, damping: along_warp.damping }
    }
}

/// The laws of springs that lie anywhere.
pub(crate) trait GatherLaws: Copy {
    fn law<S: Simd>(&self, simd: S, springs: &[Spring; LANES]) -> impl WideSpringLaw<S, f32x8<S>>;
}

impl GatherLaws for Scaled {
    #[inline(always)]
    fn law<S: Simd>(&self, _: S, _: &[Spring; LANES]) -> impl WideSpringLaw<S, f32x8<S>> {
        *self
    }
}

/// Springs of a sheet, by [`Grain::index`].
impl GatherLaws for [DirectionModuli; 2] {
    #[inline(always)]
    fn law<S: Simd>(&self, simd: S, springs: &[Spring; LANES]) -> impl WideSpringLaw<S, f32x8<S>> {
        let [along_warp, along_weft] = *self;
        let (mut rest, mut shares) = (Lane::default(), [Lane::default(); 3]);
        for (i, spring) in springs.iter().enumerate() {
            rest[i] = spring.rest;
            (shares[0][i], shares[1][i], shares[2][i]) = spring.share.into();
        }
        let [warp, weft, shear] = [lane(simd, &shares[0]), lane(simd, &shares[1]), lane(simd, &shares[2])];
        let k = warp * along_warp.stretch + weft * along_weft.stretch + shear * along_warp.shear;
        let per_length = k.max(f32x8::splat(simd, 0.0)) / lane(simd, &rest).max(f32x8::splat(simd, SHORTEST));
        ShareLaw::along(simd, [warp, weft], per_length, *self)
    }
}

/// The laws of strands side by side, spring after spring.
pub(crate) trait StrandLaws<S: Simd, F: Wide<S>>: Copy {
    type WideSpringLaw: WideSpringLaw<S, F>;

    /// Whether slack springs are without effect. Else taut ones pull along the direction that they have after the move.
    const ONLY_PULLS: bool;

    /// The law of the springs after node `at`, and of those of a second pack after node `at + stride`.
    fn at(&self, simd: S, at: usize, stride: usize) -> Self::WideSpringLaw;

    /// Factor on the rest lengths of what only pulls, 1 or more.
    #[inline(always)]
    fn rest_scale(&self) -> f32 {
        1.0
    }
}

impl<S: Simd, F: Wide<S>> StrandLaws<S, F> for Scaled {
    type WideSpringLaw = Self;

    const ONLY_PULLS: bool = false;

    #[inline(always)]
    fn at(&self, _: S, _: usize, _: usize) -> Self {
        *self
    }
}

/// Springs that pull where they are too long, and do nothing else: for levels, whose nodes are heavy and far apart, so
/// that they turn little.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TensionOnly {
    pub spring: Scaled,
    /// Factor on the rest lengths, 1 or more.
    pub rest_scale: f32,
}

impl<S: Simd, F: Wide<S>> StrandLaws<S, F> for TensionOnly {
    type WideSpringLaw = Scaled;

    const ONLY_PULLS: bool = true;

    #[inline(always)]
    fn at(&self, _: S, _: usize, _: usize) -> Scaled {
        self.spring
    }

    #[inline(always)]
    fn rest_scale(&self) -> f32 {
        self.rest_scale
    }
}

/// Strands of a sheet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GridStrandLaws<'a> {
    /// Parts of C and of -G that each spring has, over its rest length, 1/m.
    pub shares: &'a [[Lane; 2]],
    pub grading: DirectionModuli,
}

impl<S: Simd, F: Wide<S>> StrandLaws<S, F> for GridStrandLaws<'_> {
    type WideSpringLaw = ShareLaw<F>;

    const ONLY_PULLS: bool = false;

    #[inline(always)]
    fn at(&self, simd: S, at: usize, stride: usize) -> ShareLaw<F> {
        let DirectionModuli { stretch, shear, half_stiffening, compression, damping } = self.grading;
        let lanes = self.shares.as_flattened();
        let part = |i: usize| F::load(simd, lanes, 2 * at + i, 2 * stride);
        let k = part(0) * stretch - part(1) * shear;
        // A cell that is very long and narrow would need springs that push apart.
        let per_length = k.max(F::splat(simd, 0.0));
        ShareLaw { per_length, half_stiffening: F::splat(simd, half_stiffening), compression, damping }
    }
}

/// Strands of a sheet that go along any direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GatheredStrandLaws<'a> {
    /// Parts of Cu, Cv and -G that each spring has, over its rest length, 1/m.
    pub shares: &'a [[Lane; 3]],
    /// By [`Grain::index`].
    pub gradings: [DirectionModuli; 2],
}

impl<S: Simd, F: Wide<S>> StrandLaws<S, F> for GatheredStrandLaws<'_> {
    type WideSpringLaw = ShareLaw<F>;

    const ONLY_PULLS: bool = false;

    #[inline(always)]
    fn at(&self, simd: S, at: usize, stride: usize) -> ShareLaw<F> {
        let [along_warp, along_weft] = self.gradings;
        let lanes = self.shares.as_flattened();
        let part = |i: usize| F::load(simd, lanes, 3 * at + i, 3 * stride);
        let (warp, weft) = (part(0), part(1));
        let k = warp * along_warp.stretch + weft * along_weft.stretch - part(2) * along_warp.shear;
        ShareLaw::along(simd, [warp, weft], k.max(F::splat(simd, 0.0)), self.gradings)
    }
}
