//! Faces that are flat to each other: the surface is the highest of their planes, or the lowest.

use fearless_simd::{f32x8, prelude::*};

use crate::{
    contact::mesh::{BlockCache, MeshDistanceQuery},
    layout::{
        points::Block,
        simd::{Lane, Vec3x8, lane},
    },
    shape::solid::field::SignedDistance,
};

/// Cosine of the angle between faces up to which the highest of their planes is the surface: beyond the edge between them, that
/// keeps particles off by 3 % of their distance more at most.
const EVEN: f32 = 0.9;

/// The most faces that are compared, each with all others: with more, that costs more than it saves.
const MOST: usize = 32;

/// How often particles are brought to a surface that isn't convex, at most.
const PASSES: u32 = 3;

/// By which share of its size a face may rise above another by rounding alone.
const ROUNDING: f32 = 1e-3;

/// Planes, eight at a time: all places p with n · p = c.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Plane {
    normal: Block,
    /// m
    offset: Lane,
}

impl MeshDistanceQuery<'_> {
    /// Finds out how the faces are to each other: whether the surface is the highest of their planes, or the lowest.
    #[inline(always)]
    pub(crate) fn survey<S: Simd>(&mut self, simd: S) {
        let is_closed = self.mesh.is_closed;
        let has_border = self.has_border();
        let BlockCache { now, planes, side, passes, beyond, .. } = &mut self.blocks[self.block];
        *passes = PASSES;
        planes.clear();
        if self.is_deformed || has_border || now.len() > MOST {
            return;
        }
        let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
        let (mut highest, mut lowest) = (zero, zero);
        let mut flattest = one;
        for (k, [a, b, c]) in now.iter().enumerate() {
            let corners = [Vec3x8::load(simd, a), Vec3x8::load(simd, b), Vec3x8::load(simd, c)];
            let [a, b, c] = corners;
            let outward = (b - a).cross(c - a);
            let outward = outward * (one / outward.dot(outward).sqrt());
            let offset = outward.dot(a);
            let rounding = (b - a).dot(b - a).sqrt() * ROUNDING;
            for (other, [p, q, r]) in planes.iter().zip(&now[..k]) {
                let (normal, height) = (Vec3x8::load(simd, &other.normal), lane(simd, &other.offset));
                flattest = flattest.min(normal.dot(outward));
                let (p, q, r) = (Vec3x8::load(simd, p), Vec3x8::load(simd, q), Vec3x8::load(simd, r));
                let (above, other_above) = (heights(normal, [a, b, c]), heights(outward, [p, q, r]));
                highest = highest.max((above.1 - height).max(other_above.1 - offset) - rounding);
                lowest = lowest.min((above.0 - height).min(other_above.0 - offset) + rounding);
            }
            let mut plane = Plane { offset: offset.into(), ..Plane::default() };
            outward.store(&mut plane.normal);
            planes.push(plane);
        }
        let far = lane(simd, beyond);
        let has_faces = far.simd_le(0.0);
        let (rises, falls) = (has_faces & highest.simd_gt(zero), has_faces & lowest.simd_lt(zero));
        if is_closed && !rises.any_true() {
            *passes = 1;
        }
        if (rises & falls | has_faces & flattest.simd_lt(EVEN)).any_true() {
            planes.clear();
        }
        let turned = rises.select(-one, one);
        *side = turned.into();
        for plane in planes {
            (Vec3x8::load(simd, &plane.normal) * turned).store(&mut plane.normal);
            // Those that have no faces are far from all.
            plane.offset = (lane(simd, &plane.offset) * turned - far).into();
        }
    }

    /// Whether one of the faces that the block knows has an edge that no other shares.
    fn has_border(&self) -> bool {
        let owned = &self.mesh.surface.owned;
        let ends_at = |&face: &u32| owned[face as usize].edges.iter().any(|&sharp| sharp >= 1.0);
        !self.mesh.is_closed && self.known().faces.as_flattened().iter().any(ends_at)
    }
}

/// The least and the greatest height of corners.
#[inline(always)]
fn heights<S: Simd>(upward: Vec3x8<S>, [a, b, c]: [Vec3x8<S>; 3]) -> (f32x8<S>, f32x8<S>) {
    let (a, b, c) = (upward.dot(a), upward.dot(b), upward.dot(c));
    (a.min(b).min(c), a.max(b).max(c))
}

/// The highest of the planes above or below places.
#[inline(always)]
pub(crate) fn highest<S: Simd>(
    simd: S,
    place: Vec3x8<S>,
    known: &BlockCache,
    is_closed: bool,
) -> SignedDistance<f32x8<S>> {
    let mut height = f32x8::splat(simd, f32::MIN);
    let mut normal = Vec3x8::splat(simd, [0.0; 3]);
    for plane in &known.planes {
        let upward = Vec3x8::load(simd, &plane.normal);
        let above = place.dot(upward) - lane(simd, &plane.offset);
        let is_higher = above.simd_gt(height);
        height = is_higher.select(above, height);
        normal = upward.or(is_higher, normal);
    }
    let side = match is_closed {
        true => lane(simd, &known.side),
        false => f32x8::splat(simd, 1.0).copysign(height),
    };
    SignedDistance { distance: height * side, normal: normal * side }
}
