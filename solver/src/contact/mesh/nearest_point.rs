//! The nearest places of faces, eight at a time.

use fearless_simd::{f32x8, prelude::*};

use crate::{
    contact::mesh::BlockCache,
    geometry::closest_point,
    layout::{
        points::Block,
        simd::{Vec3x8, lane},
    },
    shape::solid::field::SignedDistance,
};

/// Shares by which lengths of nearest places may differ that are one and the same, but for rounding.
const SAME: f32 = 1e-5;

/// Below this length (m) nothing has a direction.
const SHORTEST: f32 = 1e-18;

/// The nearest place of the faces that each particle of a block knows.
pub(crate) struct NearestPoint<S: Simd> {
    pub sample: SignedDistance<f32x8<S>>,
    /// Weights of the face's corners there.
    weights: Vec3x8<S>,
    /// Number of that face.
    number: f32x8<S>,
}

/// Finds the nearest places from `place`.
#[inline(always)]
pub(crate) fn nearest<S: Simd>(
    simd: S,
    place: Vec3x8<S>,
    faces: &[[Block; 3]],
    known: &BlockCache,
    is_closed: bool,
) -> NearestPoint<S> {
    let zero = f32x8::splat(simd, 0.0);
    let nothing = Vec3x8::splat(simd, [0.0; 3]);
    let mut squared = f32x8::splat(simd, f32::MAX);
    let mut steep = f32x8::splat(simd, -1.0);
    let (mut between, mut outward, mut weights) = (nothing, nothing, nothing);
    let mut number = zero;
    for (k, [a, b, c]) in faces.iter().enumerate() {
        let (a, b, c) = (Vec3x8::load(simd, a), Vec3x8::load(simd, b), Vec3x8::load(simd, c));
        let at = closest_point::on_triangle_without_branches(place, [a, b, c]);
        let way = place - (a * at.x + b * at.y + c * at.z);
        let normal = (b - a).cross(c - a);
        let length = way.dot(way);
        let along = normal.dot(way);
        let steepness = along * along / normal.dot(normal);
        // Of faces that share the nearest place, the one that looks towards the particle knows the side that it is on.
        let is_same = length.simd_le(squared * (1.0 + SAME)) & steepness.simd_gt(steep);
        let is_nearer = length.simd_lt(squared * (1.0 - SAME)) | is_same;
        squared = is_nearer.select(length, squared);
        steep = is_nearer.select(steepness, steep);
        between = way.or(is_nearer, between);
        outward = normal.or(is_nearer, outward);
        weights = at.or(is_nearer, weights);
        number = is_nearer.select(f32x8::splat(simd, k as f32), number);
    }
    let length = squared.sqrt();
    let one = f32x8::splat(simd, 1.0);
    let has_direction = length.simd_gt(SHORTEST);
    let direction = (between * (one / length)).or(has_direction, outward * (one / outward.dot(outward).sqrt()));
    let is_behind = outward.dot(between).simd_lt(zero) & has_direction;
    let (distance, normal) = match is_closed {
        true => (is_behind.select(-length, length), (nothing - direction).or(is_behind, direction)),
        false => (length, direction),
    };
    let distance = distance + lane(simd, &known.beyond);
    NearestPoint { sample: SignedDistance { distance, normal }, weights, number }
}

impl<S: Simd> NearestPoint<S> {
    /// How far the nearest places have come within the substep, in the frame of the mesh, m.
    #[inline(always)]
    pub fn way_from(&self, simd: S, then: &[[Block; 3]], now: &[[Block; 3]]) -> Vec3x8<S> {
        let mut way = Vec3x8::splat(simd, [0.0; 3]);
        for (k, (then, now)) in then.iter().zip(now).enumerate() {
            let come = |corner: usize| Vec3x8::load(simd, &now[corner]) - Vec3x8::load(simd, &then[corner]);
            let face = come(0) * self.weights.x + come(1) * self.weights.y + come(2) * self.weights.z;
            way = face.or(self.number.simd_eq(k as f32), way);
        }
        way
    }
}
