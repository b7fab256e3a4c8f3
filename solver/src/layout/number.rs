//! A number, or eight side by side: formulas that are written once for both.

use core::ops::{Add, BitAnd, Div, Mul, Neg, Not, Sub};

use bevy_math::Vec3A;
use fearless_simd::{f32x8, mask32x8, prelude::*};

use crate::layout::simd::Vec3Wide;

/// A number, or eight of them. The bits are the same.
pub(crate) trait Number:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f32, Output = Self>
    + Sub<f32, Output = Self>
    + Mul<f32, Output = Self>
{
    /// What a comparison of each gives.
    type Mask: Copy + BitAnd<Output = Self::Mask> + Not<Output = Self::Mask>;

    /// `value` in each place.
    fn broadcast(self, value: f32) -> Self;
    fn square_root(self) -> Self;
    fn absolute(self) -> Self;
    fn at_least(self, other: Self) -> Self;
    fn at_most(self, other: Self) -> Self;
    fn is_below(self, other: Self) -> Self::Mask;
    /// `self` where that is so, else `other`.
    fn select(self, so: Self::Mask, other: Self) -> Self;
    /// Whether it is so of any of them.
    fn is_any(so: Self::Mask) -> bool;
}

impl Number for f32 {
    type Mask = bool;

    #[inline(always)]
    fn broadcast(self, value: f32) -> Self {
        value
    }

    #[inline(always)]
    fn square_root(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn absolute(self) -> Self {
        self.abs()
    }

    #[inline(always)]
    fn at_least(self, other: Self) -> Self {
        self.max(other)
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> Self {
        self.min(other)
    }

    #[inline(always)]
    fn is_below(self, other: Self) -> bool {
        self < other
    }

    #[inline(always)]
    fn select(self, so: bool, other: Self) -> Self {
        if so { self } else { other }
    }

    #[inline(always)]
    fn is_any(so: bool) -> bool {
        so
    }
}

impl<S: Simd> Number for f32x8<S> {
    type Mask = mask32x8<S>;

    #[inline(always)]
    fn broadcast(self, value: f32) -> Self {
        Self::splat(self.simd, value)
    }

    #[inline(always)]
    fn square_root(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn absolute(self) -> Self {
        self.abs()
    }

    #[inline(always)]
    fn at_least(self, other: Self) -> Self {
        self.max(other)
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> Self {
        self.min(other)
    }

    #[inline(always)]
    fn is_below(self, other: Self) -> mask32x8<S> {
        self.simd_lt(other)
    }

    #[inline(always)]
    fn select(self, so: mask32x8<S>, other: Self) -> Self {
        so.select(self, other)
    }

    #[inline(always)]
    fn is_any(so: mask32x8<S>) -> bool {
        so.any_true()
    }
}

impl<N: Number> Vec3Wide<N> {
    /// `self` where that is so, else `other`.
    #[inline(always)]
    pub fn select(self, so: N::Mask, other: Self) -> Self {
        Self { x: self.x.select(so, other.x), y: self.y.select(so, other.y), z: self.z.select(so, other.z) }
    }
}

impl From<Vec3A> for Vec3Wide<f32> {
    #[inline(always)]
    fn from(v: Vec3A) -> Self {
        Self { x: v.x, y: v.y, z: v.z }
    }
}

impl From<Vec3Wide<f32>> for Vec3A {
    #[inline(always)]
    fn from(v: Vec3Wide<f32>) -> Self {
        Self::new(v.x, v.y, v.z)
    }
}
