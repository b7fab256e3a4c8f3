//! Where an obstacle's frame is within one substep, eight times: no more is worked out than there is to.

use bevy_math::{Isometry3d, Mat3A, Vec3A};
use fearless_simd::prelude::*;

use crate::{contact::particle::ccd::ObstacleSweep, layout::simd::Vec3x8};

/// The frame of an obstacle within one substep.
pub(crate) trait ObstacleFrame<S: Simd>: Copy {
    fn new(simd: S, sweep: &ObstacleSweep) -> Self;

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
pub(crate) struct TranslatedFrame<S: Simd> {
    origin: Vec3x8<S>,
}

/// One that stays.
#[derive(Clone, Copy)]
pub(crate) struct RotatedFrame<S: Simd> {
    x: Vec3x8<S>,
    y: Vec3x8<S>,
    z: Vec3x8<S>,
    origin: Vec3x8<S>,
}

/// One that moves.
#[derive(Clone, Copy)]
pub(crate) struct MovingFrame<S: Simd> {
    start: RotatedFrame<S>,
    end: RotatedFrame<S>,
    /// What leads from the start to the end.
    between: RotatedFrame<S>,
}

impl<S: Simd> ObstacleFrame<S> for TranslatedFrame<S> {
    #[inline(always)]
    fn new(simd: S, sweep: &ObstacleSweep) -> Self {
        Self { origin: Vec3x8::splat(simd, sweep.end.translation.to_array()) }
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

impl<S: Simd> RotatedFrame<S> {
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

impl<S: Simd> ObstacleFrame<S> for RotatedFrame<S> {
    #[inline(always)]
    fn new(simd: S, sweep: &ObstacleSweep) -> Self {
        Self::at(simd, &sweep.end)
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

impl<S: Simd> ObstacleFrame<S> for MovingFrame<S> {
    #[inline(always)]
    fn new(simd: S, sweep: &ObstacleSweep) -> Self {
        let ObstacleSweep { start, end, .. } = sweep;
        let turn = Mat3A::from_quat(end.rotation) - Mat3A::from_quat(start.rotation);
        let between = RotatedFrame::of(simd, &turn, end.translation - start.translation);
        Self { start: RotatedFrame::at(simd, start), end: RotatedFrame::at(simd, end), between }
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
