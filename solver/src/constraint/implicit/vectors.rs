//! Vectors of one point a particle, [x, y, z, 0], and their products.
//!
//! Sums are added up in a fixed order, whatever the instruction set.

use bevy_math::{Vec3A, Vec4};
use fearless_simd::{f32x4, f32x8, prelude::*};

use crate::{
    layout::{points::Points, simd::LANES},
    linear::sparse_rows::SparseRows,
    particles::lanes::Lanes,
    topology::{Topology, two_grid::Stiffness},
};

/// A particle that is so many times as heavy as its share of the cloth is held: by a pin, a hand or a body.
const HELD: f32 = 10.0;

/// Masses of the particles.
#[derive(Clone, Debug, Default)]
pub(super) struct Masses {
    /// Mass, kg, three times. Zero for a particle that is fixed, and for nobody.
    pub mass: Vec<[f32; 4]>,
    /// The particles that are fixed or much heavier than their cloth, in order.
    pub held: Vec<u32>,
}

impl Masses {
    /// Takes over the masses of a cloth of a `density`, kg/m².
    pub fn read(&mut self, lanes: &Lanes, topology: &Topology, density: f32) {
        self.held.clear();
        self.mass.clear();
        for (particle, area) in (0..).zip(&topology.areas) {
            let w = lanes.inverse_mass(lanes.order.slot(particle));
            let mass = if w > 0.0 { w.recip() } else { 0.0 };
            self.mass.push([mass, mass, mass, 0.0]);
            if w * density * area * HELD < 1.0 {
                self.held.push(particle);
            }
        }
        let count = (self.mass.len() + 1).next_multiple_of(2);
        self.mass.resize(count, [0.0; 4]);
    }

    /// Inverse mass of a particle, 1/kg: zero for one that is fixed.
    pub fn inverse(&self, particle: usize) -> f32 {
        let [mass, ..] = self.mass[particle];
        if mass > 0.0 { mass.recip() } else { 0.0 }
    }
}

/// Two points to a register.
#[inline(always)]
fn pairs(list: &[[f32; 4]]) -> impl Iterator<Item = &[f32; LANES]> {
    list.as_flattened().as_chunks().0.iter()
}

#[inline(always)]
fn pairs_mut(list: &mut [[f32; 4]]) -> impl Iterator<Item = &mut [f32; LANES]> {
    list.as_flattened_mut().as_chunks_mut().0.iter_mut()
}

#[inline(always)]
fn wide<S: Simd>(simd: S, values: &[f32; LANES]) -> f32x8<S> {
    f32x8::simd_from(simd, *values)
}

/// The way of free particles from `before` to `now`, and a free fall from there.
#[inline(always)]
pub(super) fn inertia<S: Simd>(
    simd: S,
    now: &[[f32; 4]],
    before: &[[f32; 4]],
    fall: &[[f32; 4]],
    masses: &Masses,
    inertia: &mut [[f32; 4]],
) {
    let zero = f32x8::splat(simd, 0.0);
    let all = pairs(now).zip(pairs(before)).zip(pairs(fall)).zip(pairs(&masses.mass)).zip(pairs_mut(inertia));
    for ((((now, before), fall), mass), inertia) in all {
        let is_free = wide(simd, mass).simd_gt(zero);
        *inertia = is_free.select(wide(simd, now) - wide(simd, before) + wide(simd, fall), zero).into();
    }
}

/// The residual: less two vectors, on free particles.
#[inline(always)]
pub(super) fn residual<S: Simd>(simd: S, [one, two]: [&[[f32; 4]]; 2], masses: &Masses, residual: &mut [[f32; 4]]) {
    let zero = f32x8::splat(simd, 0.0);
    for (((one, two), mass), residual) in pairs(one).zip(pairs(two)).zip(pairs(&masses.mass)).zip(pairs_mut(residual)) {
        let sum = wide(simd, one) + wide(simd, two);
        *residual = wide(simd, mass).simd_gt(zero).select(zero - sum, zero).into();
    }
}

/// `scale` (s²) times the `force` (N) on each free particle.
pub(super) fn scaled(force: &Points, scale: f32, masses: &Masses, scaled: &mut [[f32; 4]]) {
    for (i, (scaled, mass)) in scaled.iter_mut().zip(&masses.mass).enumerate() {
        let force = if mass[0] > 0.0 { force.get(i) * scale } else { Vec3A::ZERO };
        *scaled = extended(force);
    }
}

/// Adds the masses times a direction to a product with it, and leaves nothing of it at particles that are fixed.
#[inline(always)]
pub(super) fn add_masses<S: Simd>(simd: S, masses: &Masses, direction: &[[f32; 4]], product: &mut [[f32; 4]]) {
    let zero = f32x8::splat(simd, 0.0);
    for ((mass, direction), product) in pairs(&masses.mass).zip(pairs(direction)).zip(pairs_mut(product)) {
        let mass = wide(simd, mass);
        let sum = wide(simd, product) + mass * wide(simd, direction);
        *product = mass.simd_gt(zero).select(sum, zero).into();
    }
}

/// The inner products of a vector with two others.
#[inline(always)]
pub(super) fn dot_both<S: Simd>(simd: S, a: &[[f32; 4]], [b, c]: [&[[f32; 4]]; 2]) -> [f32; 2] {
    let zero = f32x8::splat(simd, 0.0);
    let mut sums = [[zero; 2]; 2];
    // By turns, so that a sum doesn't wait for the one before.
    for (i, ((a, b), c)) in pairs(a).zip(pairs(b)).zip(pairs(c)).enumerate() {
        let a = wide(simd, a);
        sums[0][i % 2] += a * wide(simd, b);
        sums[1][i % 2] += a * wide(simd, c);
    }
    let [[b_even, b_odd], [c_even, c_odd]] = sums;
    let (of_b, of_c): ([f32; LANES], [f32; LANES]) = ((b_even + b_odd).into(), (c_even + c_odd).into());
    [of_b.iter().sum(), of_c.iter().sum()]
}

/// The `next` direction, and parts of the direction before it and of another one.
#[inline(always)]
pub(super) fn turn<S: Simd>(
    simd: S,
    next: &[[f32; 4]],
    [back, along]: [f32; 2],
    other: &[[f32; 4]],
    direction: &mut [[f32; 4]],
) {
    for ((next, other), direction) in pairs(next).zip(pairs(other)).zip(pairs_mut(direction)) {
        let parts = wide(simd, direction) * back + wide(simd, other) * along;
        *direction = (wide(simd, next) + parts).into();
    }
}

/// Goes a step along a direction: the correction grows by it, the residual shrinks by the product.
#[inline(always)]
pub(super) fn advance<S: Simd>(
    simd: S,
    step: f32,
    [direction, product]: [&[[f32; 4]]; 2],
    [correction, residual]: [&mut [[f32; 4]]; 2],
) {
    let all = pairs(direction).zip(pairs(product)).zip(pairs_mut(correction)).zip(pairs_mut(residual));
    for (((direction, product), correction), residual) in all {
        *correction = (wide(simd, correction) + wide(simd, direction) * step).into();
        *residual = (wide(simd, residual) - wide(simd, product) * step).into();
    }
}

/// Adds a part of a vector to another.
#[inline(always)]
pub(super) fn add_part<S: Simd>(simd: S, part: f32, more: &[[f32; 4]], sums: &mut [[f32; 4]]) {
    for (more, sum) in pairs(more).zip(pairs_mut(sums)) {
        *sum = (wide(simd, sum) + wide(simd, more) * part).into();
    }
}

/// Moves particles by ways (m), none farther than `most` (m).
pub(super) fn go(ways: &[[f32; 4]], most: f32, places: &mut [[f32; 4]]) {
    for (way, place) in ways.iter().zip(places) {
        let way = Vec3A::from_slice(way);
        let length = way.length();
        let share = if length <= most { 1.0 } else { most / length };
        // What isn't a number stays where it is.
        let way = if share > 0.0 { way * share } else { Vec3A::ZERO };
        place.iter_mut().zip(way.to_array()).for_each(|(place, way)| *place += way);
    }
}

/// Adds `k` times the matrix of all bends times a vector, whatever that is for all particles alike.
#[inline(always)]
pub(super) fn multiply_bends<S: Simd>(
    simd: S,
    matrix: &SparseRows<Stiffness>,
    k: f32,
    vector: &[[f32; 4]],
    product: &mut [[f32; 4]],
) {
    let nothing = f32x4::splat(simd, 0.0);
    for (i, product) in product.iter_mut().enumerate().take(matrix.len()) {
        let here = four(simd, &vector[i]);
        // By turns, so that a sum doesn't wait for the one before. Rows add up to zero: with differences, numbers are small
        // wherever the cloth is.
        let mut sums = [nothing; 4];
        let range = matrix.range(i);
        let (columns, values) = (matrix.columns(i), &matrix.values()[range]);
        let (fours, rest) = columns.as_chunks::<4>();
        let (values_of_fours, values_of_rest) = values.as_chunks::<4>();
        for (j, stiffness) in fours.iter().zip(values_of_fours) {
            sums[0] += (four(simd, &vector[j[0] as usize]) - here) * stiffness[0].bend;
            sums[1] += (four(simd, &vector[j[1] as usize]) - here) * stiffness[1].bend;
            sums[2] += (four(simd, &vector[j[2] as usize]) - here) * stiffness[2].bend;
            sums[3] += (four(simd, &vector[j[3] as usize]) - here) * stiffness[3].bend;
        }
        for (j, stiffness) in rest.iter().zip(values_of_rest) {
            sums[0] += (four(simd, &vector[*j as usize]) - here) * stiffness.bend;
        }
        let sum = (sums[0] + sums[1]) + (sums[2] + sums[3]);
        let [x, y, z, _] = (four(simd, product) + sum * k).into();
        *product = [x, y, z, 0.0];
    }
}

/// A point in a register.
#[inline(always)]
pub(super) fn four<S: Simd>(simd: S, point: &[f32; 4]) -> f32x4<S> {
    f32x4::simd_from(simd, *point)
}

/// A point, with nothing after it.
pub(super) fn extended(point: Vec3A) -> [f32; 4] {
    Vec4::from((point, 0.0)).to_array()
}

/// A point without what comes after it.
#[inline(always)]
pub(super) fn point(values: &[f32; 4]) -> Vec3A {
    Vec3A::from_vec4(Vec4::from_array(*values))
}
