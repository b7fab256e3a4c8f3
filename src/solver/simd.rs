//! Eight particles side by side.
//!
//! The instruction set is chosen when the program runs. All of them give the same bits: every lane does what a single
//! number would, with square roots and divisions that are exact, and nothing is fused.

use core::ops::{Add, Mul, Sub};

use fearless_simd::{f32x8, mask32x8, prelude::*};

use super::lanes::Block;

/// Particles in a block.
pub const LANES: usize = 8;

/// One number for each particle of a block.
pub type Lane = [f32; LANES];

/// Below this length (m) a spring has no direction and rests.
pub(super) const SHORTEST: f32 = 1e-9;

/// Which instructions a step uses. The bits are the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Instructions {
    /// The widest that the processor has.
    #[default]
    Best,
    /// Those that every processor of the architecture has.
    Baseline,
}

impl Instructions {
    pub(super) fn level(self) -> fearless_simd::Level {
        match self {
            Self::Best => fearless_simd::Level::new(),
            Self::Baseline => fearless_simd::Level::baseline(),
        }
    }
}

/// Eight points or directions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vec3x8<S: Simd> {
    pub x: f32x8<S>,
    pub y: f32x8<S>,
    pub z: f32x8<S>,
}

impl<S: Simd> Vec3x8<S> {
    #[inline(always)]
    pub fn splat(simd: S, [x, y, z]: [f32; 3]) -> Self {
        Self { x: f32x8::splat(simd, x), y: f32x8::splat(simd, y), z: f32x8::splat(simd, z) }
    }

    #[inline(always)]
    pub fn load(simd: S, [x, y, z]: &Block) -> Self {
        Self { x: lane(simd, x), y: lane(simd, y), z: lane(simd, z) }
    }

    #[inline(always)]
    pub fn store(self, block: &mut Block) {
        *block = [self.x.into(), self.y.into(), self.z.into()];
    }

    /// Each lane's neighbour: lanes 1 to 7 of `self`, and lane 0 of `next`.
    #[inline(always)]
    pub fn ahead(self, next: Self) -> Self {
        Self { x: self.x.slide::<1>(next.x), y: self.y.slide::<1>(next.y), z: self.z.slide::<1>(next.z) }
    }

    /// Each lane's other neighbour: lane 7 of `self`, and lanes 0 to 6 of `next`.
    #[inline(always)]
    pub fn behind(self, next: Self) -> Self {
        Self { x: self.x.slide::<7>(next.x), y: self.y.slide::<7>(next.y), z: self.z.slide::<7>(next.z) }
    }

    #[inline(always)]
    pub fn dot(self, other: Self) -> f32x8<S> {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// `self` where `mask` is set, else `other`.
    #[inline(always)]
    pub fn or(self, mask: mask32x8<S>, other: Self) -> Self {
        Self { x: mask.select(self.x, other.x), y: mask.select(self.y, other.y), z: mask.select(self.z, other.z) }
    }
}

impl<S: Simd> Add for Vec3x8<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl<S: Simd> Sub for Vec3x8<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

impl<S: Simd> Mul<f32x8<S>> for Vec3x8<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f32x8<S>) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}

#[inline(always)]
pub(super) fn lane<S: Simd>(simd: S, values: &Lane) -> f32x8<S> {
    f32x8::simd_from(simd, *values)
}

/// Rows to columns, by three perfect shuffles.
#[inline(always)]
pub(super) fn transpose<S: Simd>(mut rows: [f32x8<S>; LANES]) -> [f32x8<S>; LANES] {
    for _ in 0..3 {
        let mut shuffled = rows;
        for i in 0..LANES / 2 {
            (shuffled[2 * i], shuffled[2 * i + 1]) = rows[i].interleave(rows[i + LANES / 2]);
        }
        rows = shuffled;
    }
    rows
}
