//! All chance of a scene: it follows from a seed.

use core::ops::RangeInclusive;

use bevy::prelude::*;
use fastrand::Rng;

/// Share of the scenes whose settings stay within their documented ranges.
const IN_RANGE: f32 = 0.75;

/// Share of the settings of other scenes that are anything.
const ANYTHING: f32 = 0.04;

/// The same of those that are valid, and far beyond their documented range.
const EXTREME: f32 = 0.1;

/// Makes all choices of a scene.
#[derive(Debug)]
pub struct Dice {
    rng: Rng,
    is_in_range: bool,
}

impl Dice {
    pub fn of_seed(seed: u64) -> Self {
        let mut rng = Rng::with_seed(seed);
        let is_in_range = rng.f32() < IN_RANGE;
        Self { rng, is_in_range }
    }

    /// Whether settings stay within their documented ranges.
    pub fn is_in_range(&self) -> bool {
        self.is_in_range
    }

    /// True in this share of all cases.
    pub fn chance(&mut self, share: f32) -> bool {
        self.rng.f32() < share
    }

    /// The same in scenes whose settings leave their ranges; never in others.
    pub fn wild(&mut self, share: f32) -> bool {
        !self.is_in_range && self.chance(share)
    }

    pub fn count(&mut self, range: RangeInclusive<u32>) -> u32 {
        self.rng.u32(range)
    }

    pub fn one_of<T: Copy, const N: usize>(&mut self, all: [T; N]) -> T {
        all[self.rng.usize(..N)]
    }

    /// One of a list, where it has any.
    pub fn any<T: Clone>(&mut self, all: &[T]) -> Option<T> {
        (!all.is_empty()).then(|| all[self.rng.usize(..all.len())].clone())
    }

    /// Each value as likely as another.
    pub fn within(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.rng.f32()
    }

    /// Each order of magnitude as likely as another. Both are greater than zero.
    pub fn spread(&mut self, low: f32, high: f32) -> f32 {
        low * ops::powf(high / low, self.rng.f32())
    }

    /// The value of a setting that is documented to be from `low`, which isn't negative, to `high`.
    pub fn setting(&mut self, low: f32, high: f32) -> f32 {
        let least = if low > 0.0 { low } else { high * 1e-3 };
        let value = if low == 0.0 && self.chance(0.15) { 0.0 } else { self.spread(least, high) };
        if self.wild(ANYTHING) {
            self.anything()
        } else if self.wild(EXTREME) {
            value * ops::powf(10.0, self.within(-6.0, 6.0))
        } else {
            value
        }
    }

    /// A number that nobody means.
    pub fn anything(&mut self) -> f32 {
        let tiny = [0.0, -0.0, 1e-30, f32::MIN_POSITIVE, f32::from_bits(1), -1e-6];
        let large = [1e6, 1e12, 1e19, 1e30, f32::MAX, -1.0];
        let none = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
        match self.count(0..=2) {
            0 => self.one_of(tiny),
            1 => self.one_of(large),
            _ => self.one_of(none),
        }
    }

    /// A unit vector.
    pub fn direction(&mut self) -> Vec3 {
        self.vector(1.0).normalize_or(Vec3::Y)
    }

    /// A vector in a box around zero.
    pub fn vector(&mut self, most: f32) -> Vec3 {
        Vec3::new(self.within(-most, most), self.within(-most, most), self.within(-most, most))
    }

    pub fn turn(&mut self) -> Quat {
        let axis = self.direction();
        Quat::from_axis_angle(axis, self.within(0.0, core::f32::consts::TAU))
    }
}
