//! Where an obstacle's frame is within one substep, eight times: no more is worked out than there is to.

use bevy::math::{Isometry3d, Mat3A, Vec3A};
use fearless_simd::prelude::*;

use super::sweep::Passage;
use crate::solver::simd::Vec3x8;

/// The frame of an obstacle within one substep.
pub(super) trait Course<S: Simd>: Copy {
    fn new(simd: S, passage: &Passage) -> Self;

    /// A point of the world in the frame as it is at the end.
    fn to_local(&self, point: Vec3x8<S>) -> Vec3x8<S>;

    /// The same as it was at the start.
    fn start_to_local(&self, point: Vec3x8<S>) -> Vec3x8<S>;

    /// A direction of the frame at the end, in the world.
    fn turned(&self, direction: Vec3x8<S>) -> Vec3x8<S>;

    /// A way past the surface's own at a local point.
    fn past(&self, way: Vec3x8<S>, at: Vec3x8<S>) -> Vec3x8<S>;
}

/// One that stays and isn't turned.
#[derive(Clone, Copy)]
pub(super) struct Shifted<S: Simd> {
    origin: Vec3x8<S>,
}

/// One that stays.
#[derive(Clone, Copy)]
pub(super) struct Turned<S: Simd> {
    x: Vec3x8<S>,
    y: Vec3x8<S>,
    z: Vec3x8<S>,
    origin: Vec3x8<S>,
}

/// One that moves.
#[derive(Clone, Copy)]
pub(super) struct Moving<S: Simd> {
    start: Turned<S>,
    end: Turned<S>,
    /// What leads from the start to the end.
    between: Turned<S>,
}

impl<S: Simd> Course<S> for Shifted<S> {
    #[inline(always)]
    fn new(simd: S, passage: &Passage) -> Self {
        Self { origin: Vec3x8::splat(simd, passage.end.translation.to_array()) }
    }

    #[inline(always)]
    fn to_local(&self, point: Vec3x8<S>) -> Vec3x8<S> {
        point - self.origin
    }

    #[inline(always)]
    fn start_to_local(&self, point: Vec3x8<S>) -> Vec3x8<S> {
        point - self.origin
    }

    #[inline(always)]
    fn turned(&self, direction: Vec3x8<S>) -> Vec3x8<S> {
        direction
    }

    #[inline(always)]
    fn past(&self, way: Vec3x8<S>, _: Vec3x8<S>) -> Vec3x8<S> {
        way
    }
}

impl<S: Simd> Turned<S> {
    #[inline(always)]
    fn of(simd: S, axes: &Mat3A, origin: Vec3A) -> Self {
        Self {
            x: Vec3x8::splat(simd, axes.x_axis.to_array()),
            y: Vec3x8::splat(simd, axes.y_axis.to_array()),
            z: Vec3x8::splat(simd, axes.z_axis.to_array()),
            origin: Vec3x8::splat(simd, origin.to_array()),
        }
    }

    #[inline(always)]
    fn at(simd: S, pose: &Isometry3d) -> Self {
        Self::of(simd, &Mat3A::from_quat(pose.rotation), pose.translation)
    }
}

impl<S: Simd> Course<S> for Turned<S> {
    #[inline(always)]
    fn new(simd: S, passage: &Passage) -> Self {
        Self::at(simd, &passage.end)
    }

    #[inline(always)]
    fn to_local(&self, point: Vec3x8<S>) -> Vec3x8<S> {
        let p = point - self.origin;
        Vec3x8 { x: self.x.dot(p), y: self.y.dot(p), z: self.z.dot(p) }
    }

    #[inline(always)]
    fn start_to_local(&self, point: Vec3x8<S>) -> Vec3x8<S> {
        self.to_local(point)
    }

    #[inline(always)]
    fn turned(&self, direction: Vec3x8<S>) -> Vec3x8<S> {
        self.x * direction.x + self.y * direction.y + self.z * direction.z
    }

    #[inline(always)]
    fn past(&self, way: Vec3x8<S>, _: Vec3x8<S>) -> Vec3x8<S> {
        way
    }
}

impl<S: Simd> Course<S> for Moving<S> {
    #[inline(always)]
    fn new(simd: S, passage: &Passage) -> Self {
        let Passage { start, end, .. } = passage;
        let turn = Mat3A::from_quat(end.rotation) - Mat3A::from_quat(start.rotation);
        let between = Turned::of(simd, &turn, end.translation - start.translation);
        Self { start: Turned::at(simd, start), end: Turned::at(simd, end), between }
    }

    #[inline(always)]
    fn to_local(&self, point: Vec3x8<S>) -> Vec3x8<S> {
        self.end.to_local(point)
    }

    #[inline(always)]
    fn start_to_local(&self, point: Vec3x8<S>) -> Vec3x8<S> {
        self.start.to_local(point)
    }

    #[inline(always)]
    fn turned(&self, direction: Vec3x8<S>) -> Vec3x8<S> {
        self.end.turned(direction)
    }

    #[inline(always)]
    fn past(&self, way: Vec3x8<S>, at: Vec3x8<S>) -> Vec3x8<S> {
        way - self.between.turned(at) - self.between.origin
    }
}
