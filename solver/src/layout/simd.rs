//! Eight particles side by side.
//!
//! The instruction set is chosen when the program runs. All of them give the same bits: every lane does what a single
//! number would, with square roots and divisions that are exact, and nothing is fused.

use core::ops::{Add, Mul, Sub};

use fearless_simd::{f32x8, f32x16, prelude::*};

use crate::layout::points::Block;

/// Particles in a block.
pub const LANES: usize = 8;

/// One number for each particle of a block.
pub type Lane = [f32; LANES];

/// Below this length (m) a spring has no direction and rests.
pub(crate) const SHORTEST: f32 = 1e-9;

/// Which instructions a step uses. The bits are the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SimdLevel {
    /// The widest that the processor has.
    #[default]
    Best,
    /// Those that every processor of the architecture has.
    Baseline,
}

impl SimdLevel {
    pub(crate) fn level(self) -> fearless_simd::Level {
        match self {
            Self::Best => fearless_simd::Level::new(),
            Self::Baseline => fearless_simd::Level::baseline(),
        }
    }
}

/// Numbers side by side: the eight of a block, or the sixteen of two blocks at once.
///
/// Sixteen pay where each number waits for the one before, as along a strand: the units that divide would be idle.
pub(crate) trait Wide<S: Simd>: SimdFloat<S, Element = f32> {
    /// Takes over the lanes at `at`, and of two blocks also those `stride` further on.
    fn load(simd: S, lanes: &[Lane], at: usize, stride: usize) -> Self;

    /// Hands them back.
    fn store(self, lanes: &mut [Lane], at: usize, stride: usize);
}

impl<S: Simd> Wide<S> for f32x8<S> {
    #[inline(always)]
    fn load(simd: S, lanes: &[Lane], at: usize, _: usize) -> Self {
        lane(simd, &lanes[at])
    }

    #[inline(always)]
    fn store(self, lanes: &mut [Lane], at: usize, _: usize) {
        lanes[at] = self.into();
    }
}

impl<S: Simd> Wide<S> for f32x16<S> {
    #[inline(always)]
    fn load(simd: S, lanes: &[Lane], at: usize, stride: usize) -> Self {
        lane(simd, &lanes[at]).combine(lane(simd, &lanes[at + stride]))
    }

    #[inline(always)]
    fn store(self, lanes: &mut [Lane], at: usize, stride: usize) {
        let (first, second) = self.split();
        lanes[at] = first.into();
        lanes[at + stride] = second.into();
    }
}

/// Points or directions side by side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vec3Wide<F> {
    pub x: F,
    pub y: F,
    pub z: F,
}

/// Eight points or directions.
pub(crate) type Vec3x8<S> = Vec3Wide<f32x8<S>>;

impl<S: Simd> Vec3x8<S> {
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
}

impl<F> Vec3Wide<F> {
    #[inline(always)]
    pub fn splat<S: Simd>(simd: S, [x, y, z]: [f32; 3]) -> Self
    where
        F: Wide<S>,
    {
        Self { x: F::splat(simd, x), y: F::splat(simd, y), z: F::splat(simd, z) }
    }

    /// Takes over the block at `at`, and where there are two also that `stride` further on.
    #[inline(always)]
    pub fn load_at<S: Simd>(simd: S, blocks: &[Block], at: usize, stride: usize) -> Self
    where
        F: Wide<S>,
    {
        let (lanes, at, stride) = (blocks.as_flattened(), 3 * at, 3 * stride);
        Self {
            x: F::load(simd, lanes, at, stride),
            y: F::load(simd, lanes, at + 1, stride),
            z: F::load(simd, lanes, at + 2, stride),
        }
    }

    /// Hands it back.
    #[inline(always)]
    pub fn store_at<S: Simd>(self, blocks: &mut [Block], at: usize, stride: usize)
    where
        F: Wide<S>,
    {
        let (lanes, at, stride) = (blocks.as_flattened_mut(), 3 * at, 3 * stride);
        self.x.store(lanes, at, stride);
        self.y.store(lanes, at + 1, stride);
        self.z.store(lanes, at + 2, stride);
    }

    #[inline(always)]
    pub fn dot(self, other: Self) -> F
    where
        F: Add<Output = F> + Mul<Output = F>,
    {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline(always)]
    pub fn cross(self, other: Self) -> Self
    where
        F: Sub<Output = F> + Mul<Output = F> + Copy,
    {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }

    /// `self` where `mask` is set, else `other`.
    #[inline(always)]
    pub fn or<S: Simd>(self, mask: F::Mask, other: Self) -> Self
    where
        F: Wide<S>,
    {
        Self { x: mask.select(self.x, other.x), y: mask.select(self.y, other.y), z: mask.select(self.z, other.z) }
    }
}

impl<F: Add<Output = F>> Add for Vec3Wide<F> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl<F: Sub<Output = F>> Sub for Vec3Wide<F> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

impl<F: Mul<Output = F> + Copy> Mul<F> for Vec3Wide<F> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: F) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}

#[inline(always)]
pub(crate) fn lane<S: Simd>(simd: S, values: &Lane) -> f32x8<S> {
    f32x8::simd_from(simd, *values)
}

/// Rows to columns, by three perfect shuffles.
#[inline(always)]
pub(crate) fn transpose<S: Simd>(mut rows: [f32x8<S>; LANES]) -> [f32x8<S>; LANES] {
    for _ in 0..3 {
        let mut shuffled = rows;
        for i in 0..LANES / 2 {
            (shuffled[2 * i], shuffled[2 * i + 1]) = rows[i].interleave(rows[i + LANES / 2]);
        }
        rows = shuffled;
    }
    rows
}
