//! A direction of search, and conjugate ones after it.

use fearless_simd::{Level, dispatch};

use crate::constraint::implicit::vectors;

/// A direction of search.
#[derive(Clone, Debug, Default)]
pub(super) struct Direction {
    /// The way of each particle, m.
    pub way: Vec<[f32; 4]>,
    /// The matrix times it, kg m.
    pub product: Vec<[f32; 4]>,
    /// One over their inner product, 1/(kg m²). Zero for a direction that leads nowhere.
    pub per_curvature: f32,
}

impl Direction {
    /// Leads nowhere.
    pub fn clear(&mut self) {
        self.way.fill([0.0; 4]);
        self.product.fill([0.0; 4]);
        self.per_curvature = 0.0;
    }

    /// How far to go along it, as a share of it.
    pub fn step(&mut self, level: Level, residual: &[[f32; 4]]) -> f32 {
        let Self { way, product, per_curvature } = self;
        let [curvature, slope] = dispatch!(level, simd => vectors::dot_both(simd, way, [product, residual]));
        *per_curvature = if curvature > f32::MIN_POSITIVE { curvature.recip() } else { 0.0 };
        slope * *per_curvature
    }

    /// Goes that far: the correction grows, and the residual shrinks.
    pub fn go(&mut self, level: Level, [correction, residual]: [&mut [[f32; 4]]; 2]) {
        let step = self.step(level, residual);
        let Self { way, product, .. } = self;
        dispatch!(level, simd => vectors::advance(simd, step, [way, product], [correction, residual]));
    }

    /// Turns it to the `next` way, made conjugate to where it led and to another direction.
    pub fn turn_to(&mut self, level: Level, next: &[[f32; 4]], other: &Self) {
        let Self { way, product, per_curvature } = self;
        let [back, along] = dispatch!(level, simd => vectors::dot_both(simd, next, [product, &other.product]));
        let parts = [-back * *per_curvature, -along * other.per_curvature];
        dispatch!(level, simd => vectors::turn(simd, next, parts, &other.way, way));
    }
}
