//! Points and directions in blocks of eight, component by component, so that eight can be worked on side by side.

use bevy_math::{Vec3A, Vec4};
use fearless_simd::{dispatch, f32x4, f32x8, prelude::*};

use crate::layout::{
    order::{Band, Order},
    simd::{LANES, Lane, SimdLevel, lane},
};

/// Eight points or directions: all x, all y, all z.
pub type Block = [Lane; 3];

/// Points or directions of all slots.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Points(pub Vec<Block>);

impl Points {
    /// Makes room for `count` blocks.
    pub fn resize(&mut self, count: usize) {
        self.0.resize(count, Block::default());
    }

    /// A point or direction.
    #[inline]
    pub fn get(&self, slot: usize) -> Vec3A {
        let [x, y, z] = &self.0[slot / LANES];
        let lane = slot % LANES;
        Vec3A::new(x[lane], y[lane], z[lane])
    }

    /// Changes a point or direction.
    #[inline]
    pub fn set(&mut self, slot: usize, value: Vec3A) {
        let [x, y, z] = &mut self.0[slot / LANES];
        let lane = slot % LANES;
        (x[lane], y[lane], z[lane]) = (value.x, value.y, value.z);
    }

    /// Hands one point for each particle back.
    pub fn store(&self, order: Order, points: &mut [Vec3A], simd_level: SimdLevel) {
        for band in order.bands() {
            let blocks = &self.0[band.blocks()];
            dispatch!(simd_level.level(), simd => store_blocks(simd, blocks, band, &mut points[band.particles()]));
        }
    }

    /// Takes over one point for each particle.
    pub fn load(&mut self, order: Order, points: &[Vec3A], simd_level: SimdLevel) {
        self.resize(order.block_count());
        for band in order.bands() {
            let blocks = &mut self.0[band.blocks()];
            dispatch!(simd_level.level(), simd => load_blocks(simd, blocks, band, &points[band.particles()]));
        }
    }
}

#[inline(always)]
pub(crate) fn load_blocks<S: Simd>(simd: S, blocks: &mut [Block], band: Band, points: &[Vec3A]) {
    for (some, block) in band.particles_of_blocks().zip(blocks) {
        let points = &points[some];
        let mut rows = [[0.0; 4]; LANES];
        for (row, &point) in rows.iter_mut().zip(points) {
            *row = Vec4::from((point, 0.0)).to_array();
        }
        let [a, b, c, d, e, f, g, h] = &rows;
        let [x, y, z, _] = apart(simd, [a, b, c, d, e, f, g, h]);
        *block = [x.into(), y.into(), z.into()];
    }
}

#[inline(always)]
pub(crate) fn store_blocks<S: Simd>(simd: S, blocks: &[Block], band: Band, points: &mut [Vec3A]) {
    for (some, [x, y, z]) in band.particles_of_blocks().zip(blocks) {
        let (x, y, z) = (lane(simd, x), lane(simd, y), lane(simd, z));
        let rows = together([x, y, z, z]);
        for (point, row) in points[some].iter_mut().zip(rows) {
            *point = Vec3A::from_vec4(Vec4::from_array(row));
        }
    }
}

/// Eight rows of four numbers become four lanes.
#[inline(always)]
pub(crate) fn apart<S: Simd>(simd: S, [a, b, c, d, e, f, g, h]: [&[f32; 4]; LANES]) -> [f32x8<S>; 4] {
    // Spelled out: the compiler doesn't take the closure of an array's `map` along to the instruction set chosen.
    let [x, y, z, w] = transpose_four([row(simd, a), row(simd, b), row(simd, c), row(simd, d)]);
    let [xs, ys, zs, ws] = transpose_four([row(simd, e), row(simd, f), row(simd, g), row(simd, h)]);
    [x.combine(xs), y.combine(ys), z.combine(zs), w.combine(ws)]
}

#[inline(always)]
fn row<S: Simd>(simd: S, values: &[f32; 4]) -> f32x4<S> {
    f32x4::simd_from(simd, *values)
}

/// And back.
#[inline(always)]
pub(crate) fn together<S: Simd>([x, y, z, w]: [f32x8<S>; 4]) -> [[f32; 4]; LANES] {
    let ((x, xs), (y, ys), (z, zs), (w, ws)) = (x.split(), y.split(), z.split(), w.split());
    let ([a, b, c, d], [e, f, g, h]) = (transpose_four([x, y, z, w]), transpose_four([xs, ys, zs, ws]));
    [a.into(), b.into(), c.into(), d.into(), e.into(), f.into(), g.into(), h.into()]
}

/// Rows to columns, by two perfect shuffles.
#[inline(always)]
fn transpose_four<S: Simd>([a, b, c, d]: [f32x4<S>; 4]) -> [f32x4<S>; 4] {
    let ((ac_low, ac_high), (bd_low, bd_high)) = (a.interleave(c), b.interleave(d));
    let ((x, y), (z, w)) = (ac_low.interleave(bd_low), ac_high.interleave(bd_high));
    [x, y, z, w]
}
