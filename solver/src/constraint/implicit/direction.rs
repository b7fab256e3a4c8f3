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

    /// One over a curvature, 1/(kg m²), if there is one.
    pub fn per_curvature(curvature: f32) -> f32 {
        if curvature > f32::MIN_POSITIVE { curvature.recip() } else { 0.0 }
    }

    /// The curvature along it, kg m², and the slope, which goes down.
    pub fn measure(&self, level: Level, residual: &[[f32; 4]]) -> [f32; 2] {
        let Self { way, product, .. } = self;
        dispatch!(level, simd => vectors::dot_both(simd, way, [product, residual]))
    }

    /// How far to go along it, as a share of it.
    pub fn step(&self, level: Level, residual: &[[f32; 4]]) -> f32 {
        let [curvature, slope] = self.measure(level, residual);
        slope * Self::per_curvature(curvature)
    }

    /// Goes so far: the correction grows, and the residual shrinks.
    pub fn advance(&self, level: Level, step: f32, [correction, residual]: [&mut [[f32; 4]]; 2]) {
        let Self { way, product, .. } = self;
        dispatch!(level, simd => vectors::advance(simd, step, [way, product], [correction, residual]));
    }
}
