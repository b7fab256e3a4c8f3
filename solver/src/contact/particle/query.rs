//! What the particles of a block see of an obstacle.

use bevy_math::Vec3A;
use fearless_simd::{f32x8, prelude::*};

use crate::{
    contact::particle::ccd::{Correction, ObstacleSweep},
    layout::simd::Vec3x8,
    particles::lanes::Run,
    shape::solid::field::{SignedDistance, SignedDistanceField},
};

/// An obstacle as the particles of a block see it, from places in its own frame (m).
pub(crate) trait DistanceQuery {
    /// Turns to a block, whose particles are at `local` places at the end of the substep. Says whether there is anything to see.
    fn turn_to<S: Simd>(&mut self, simd: S, block: usize, run: &Run, local: Vec3x8<S>) -> bool;

    /// How often the block's particles are brought to the surface: out of one part of it, they may come into another.
    fn passes(&self) -> u32;

    /// The surface as it is at the end of the substep.
    fn sample<S: Simd>(&self, simd: S, local: Vec3x8<S>) -> SignedDistance<f32x8<S>>;

    /// The surface as it was at its start.
    fn seen_before<S: Simd>(&self, simd: S, local: Vec3x8<S>) -> SignedDistance<f32x8<S>>;

    /// What is seen after what was seen before, if the surface goes through between the two wherever both are in front of one that
    /// is thin: it is then seen from the side that the particle was on.
    fn keep_side<S: Simd>(
        &self,
        simd: S,
        before: SignedDistance<f32x8<S>>,
        after: SignedDistance<f32x8<S>>,
    ) -> SignedDistance<f32x8<S>>;

    /// How far the nearest places of the surface have gone in between within the obstacle's frame, m.
    fn own_way<S: Simd>(&self, simd: S, local: Vec3x8<S>) -> Vec3x8<S>;

    /// The correction of the particle in lane `i` that went from `previous` to `position` and sees another side of the shape
    /// than before: it came through something thin or sharp, or went by. Seen from the new side, it would be left on the wrong
    /// one.
    fn correction(&self, i: usize, sweep: &ObstacleSweep, position: Vec3A, previous: Vec3A) -> Option<Correction>;
}

/// A solid, which is one for all particles.
pub(crate) struct UniformField<F>(pub F);

impl<F: SignedDistanceField> DistanceQuery for UniformField<F> {
    #[inline(always)]
    fn turn_to<S: Simd>(&mut self, _: S, _: usize, _: &Run, _: Vec3x8<S>) -> bool {
        true
    }

    #[inline(always)]
    fn passes(&self) -> u32 {
        1
    }

    #[inline(always)]
    fn sample<S: Simd>(&self, _: S, local: Vec3x8<S>) -> SignedDistance<f32x8<S>> {
        self.0.sample(local)
    }

    #[inline(always)]
    fn seen_before<S: Simd>(&self, _: S, local: Vec3x8<S>) -> SignedDistance<f32x8<S>> {
        self.0.sample(local)
    }

    #[inline(always)]
    fn keep_side<S: Simd>(
        &self,
        _: S,
        _: SignedDistance<f32x8<S>>,
        after: SignedDistance<f32x8<S>>,
    ) -> SignedDistance<f32x8<S>> {
        after
    }

    #[inline(always)]
    fn own_way<S: Simd>(&self, simd: S, _: Vec3x8<S>) -> Vec3x8<S> {
        Vec3x8::splat(simd, [0.0; 3])
    }

    fn correction(&self, _: usize, sweep: &ObstacleSweep, position: Vec3A, previous: Vec3A) -> Option<Correction> {
        sweep.correction(&self.0, position, previous)
    }
}
