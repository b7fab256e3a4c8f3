//! Particles at the faces of meshes, eight at a time.
//!
//! Each block of particles knows the faces that it may come to meet, in the frame of the mesh, for as long as all of its
//! particles are on the ways that it took them to be on. Then it looks for faces anew.

use core::ops::Range;
use std::sync::{Arc, Weak};

use bevy_math::{Isometry3d, Vec3A};
use fearless_simd::{f32x8, prelude::*};

use crate::{
    contact::{
        body::Bodies,
        mesh::{
            candidates::{CacheKey, EmptyBall},
            planes::Plane,
        },
        particle::{
            ccd::{Correction, ObstacleSweep},
            query::DistanceQuery,
        },
    },
    geometry::bvh::bounds::BvhBounds,
    input::StepContext,
    layout::{
        points::Block,
        simd::{LANES, Lane, Vec3x8, lane},
    },
    particles::lanes::Run,
    shape::{DeformedPoints, MeshShape, TriangleMesh, solid::field::SignedDistance},
};

pub(crate) mod candidates;
pub(crate) mod ccd;
pub(crate) mod nearest_point;
pub(crate) mod planes;

/// Distance that cloth keeps from triangles at least, m. Nearer, rounding decides which side it is on.
pub(crate) const LEAST: f32 = 0.0002;

/// The faces of one mesh that the particles of a cloth may meet.
#[derive(Clone, Debug, Default)]
pub(crate) struct MeshContacts {
    /// The mesh that the blocks know.
    mesh: Weak<TriangleMesh>,
    blocks: Vec<BlockCache>,
    /// Where the points of a mesh that moves within its frame are when the substep begins, and when it ends, m.
    then: Vec<Vec3A>,
    now: Vec<Vec3A>,
    /// Boxes around the ways of its triangles in the step.
    places: BvhBounds,
    /// Whether the step has met the mesh.
    is_begun: bool,
}

/// What one block knows.
#[derive(Clone, Debug, Default)]
pub(crate) struct BlockCache {
    /// Where the particles were at the moment `span.start` of the step, m, and how far they go within a step if nothing stops
    /// them.
    start: Block,
    way: Block,
    /// The part of the step that it knows faces for.
    span: Range<f32>,
    /// By how much particles may come off their ways, m.
    slack: f32,
    /// What it has looked for last, on this mesh.
    sought: Option<CacheKey>,
    /// The faces that each of its particles may meet, and how far they are from the middle of its way, m.
    found: [Vec<(f32, u32)>; LANES],
    /// Faces of all particles; where one has fewer than another, the first of them again.
    faces: Vec<[u32; LANES]>,
    /// Their corners when the substep ends, and, of a mesh that moves within its frame, when it begins, m.
    now: Vec<[Block; 3]>,
    then: Vec<[Block; 3]>,
    /// How often particles are brought to the surface: out of one face, they may come into another.
    passes: u32,
    /// The planes of the faces, where these are flat to each other; none elsewhere. Those of faces that form a hollow are turned
    /// over.
    planes: Vec<Plane>,
    /// 1, or -1 where the faces form a hollow.
    side: Lane,
    /// Where each particle has last been seen far from all faces.
    clear: [EmptyBall; LANES],
    /// By how much farther a particle is taken to be, m: those that have no faces are far from all.
    beyond: Lane,
}

/// A point of a block.
fn lane_of([x, y, z]: &Block, i: usize) -> Vec3A {
    Vec3A::new(x[i], y[i], z[i])
}

fn set_lane([x, y, z]: &mut Block, i: usize, value: Vec3A) {
    (x[i], y[i], z[i]) = value.into();
}

impl MeshContacts {
    /// Begins a step: nothing is known yet.
    pub fn begin(&mut self) {
        self.is_begun = false;
    }

    fn begin_at(&mut self, MeshShape { mesh, deformed }: &MeshShape, block_count: usize) {
        self.blocks.resize_with(block_count, BlockCache::default);
        // What is clear of a mesh stays so, as long as the mesh stays the same.
        let met = Arc::downgrade(mesh);
        let is_same = deformed.is_none() && self.mesh.ptr_eq(&met);
        for known in &mut self.blocks {
            known.span = 0.0..0.0;
            if !is_same {
                known.clear = [EmptyBall::default(); LANES];
                known.sought = None;
            }
        }
        self.mesh = met;
    }

    /// What is to be seen of a mesh in the part `span` of the step.
    pub(crate) fn query<'a>(
        &'a mut self,
        shape: &'a MeshShape,
        ctx: &StepContext,
        (bodies, obstacle): (&Bodies, usize),
        sweep: &ObstacleSweep,
        span: Range<f32>,
        block_count: usize,
    ) -> MeshDistanceQuery<'a> {
        let MeshShape { mesh, deformed } = shape;
        let is_new = !core::mem::replace(&mut self.is_begun, true);
        if is_new {
            self.begin_at(shape, block_count);
        }
        let Self { blocks, then, now, places, .. } = self;
        let (points, places) = match deformed {
            None => ([&*mesh.points; 2], &mesh.places),
            Some(DeformedPoints { ends: [from, to], .. }) => {
                if is_new {
                    candidates::follow(places, &mesh.surface, from, to);
                }
                for (points, t) in [(&mut *then, span.start), (&mut *now, span.end)] {
                    points.clear();
                    points.extend(from.iter().zip(&**to).map(|(from, &to)| from.lerp(to, t)));
                }
                ([&**then, &**now], &*places)
            }
        };
        let dt = ctx.dt.min(crate::input::MAX_TIME_STEP);
        let [_, end] = bodies.poses_ahead(ctx, obstacle, span.start..1.0, dt);
        MeshDistanceQuery {
            mesh,
            points,
            is_deformed: deformed.is_some(),
            places,
            blocks,
            block: 0,
            sweep: *sweep,
            gravity: ctx.gravity,
            end,
            span,
            dt,
        }
    }
}

/// What the particles of a block see of a mesh.
pub(crate) struct MeshDistanceQuery<'a> {
    mesh: &'a TriangleMesh,
    /// When the substep begins, and when it ends.
    points: [&'a [Vec3A]; 2],
    is_deformed: bool,
    places: &'a BvhBounds,
    blocks: &'a mut [BlockCache],
    block: usize,
    sweep: ObstacleSweep,
    /// m/s²
    gravity: Vec3A,
    /// Pose of the mesh at the end of the step.
    end: Isometry3d,
    span: Range<f32>,
    /// Duration of the step, s.
    dt: f32,
}

impl MeshDistanceQuery<'_> {
    fn known(&self) -> &BlockCache {
        &self.blocks[self.block]
    }

    /// Corners of a face when the substep begins, or when it ends.
    fn corners(&self, points: &[Vec3A], face: u32) -> [Vec3A; 3] {
        self.mesh.surface.triangles[face as usize].map(|i| points[i as usize])
    }

    /// Takes the corners of the faces that the block knows to where they are in this substep.
    fn follow(&mut self) {
        let Self { mesh, points: [then, now], .. } = *self;
        let is_deformed = self.is_deformed;
        let known = &mut self.blocks[self.block];
        let side_by_side = |places: &[Vec3A], into: &mut Vec<[Block; 3]>| {
            into.clear();
            into.extend(known.faces.iter().map(|faces| {
                let mut corners = [Block::default(); 3];
                for (i, &face) in faces.iter().enumerate() {
                    for (corner, &point) in corners.iter_mut().zip(&mesh.surface.triangles[face as usize]) {
                        set_lane(corner, i, places[point as usize]);
                    }
                }
                corners
            }));
        };
        side_by_side(now, &mut known.now);
        if is_deformed {
            side_by_side(then, &mut known.then);
        }
    }
}

impl DistanceQuery for MeshDistanceQuery<'_> {
    fn passes(&self) -> u32 {
        self.known().passes
    }

    #[inline(always)]
    fn turn_to<S: Simd>(&mut self, simd: S, block: usize, run: &Run, local: Vec3x8<S>) -> bool {
        self.block = block;
        let BlockCache { start, way, span, slack, .. } = self.known();
        let since = f32x8::splat(simd, self.span.end - span.start);
        let off = local - Vec3x8::load(simd, start) - Vec3x8::load(simd, way) * since;
        let is_free = lane(simd, &run.inverse_mass[block]).simd_gt(0.0);
        let is_off = is_free & off.dot(off).simd_gt(slack * slack);
        if self.span.end > span.end || is_off.any_true() {
            self.look_around(simd, run);
        } else if self.is_deformed {
            self.follow();
        }
        !self.known().faces.is_empty()
    }

    #[inline(always)]
    fn sample<S: Simd>(&self, simd: S, local: Vec3x8<S>) -> SignedDistance<f32x8<S>> {
        let (known, is_closed) = (self.known(), self.mesh.is_closed);
        if known.planes.is_empty() {
            nearest_point::nearest(simd, local, &known.now, known, is_closed).sample
        } else {
            planes::highest(simd, local, known, is_closed)
        }
    }

    #[inline(always)]
    fn seen_before<S: Simd>(&self, simd: S, local: Vec3x8<S>) -> SignedDistance<f32x8<S>> {
        if !self.is_deformed {
            return self.sample(simd, local);
        }
        let known = self.known();
        nearest_point::nearest(simd, local, &known.then, known, self.mesh.is_closed).sample
    }

    #[inline(always)]
    fn keep_side<S: Simd>(
        &self,
        simd: S,
        before: SignedDistance<f32x8<S>>,
        after: SignedDistance<f32x8<S>>,
    ) -> SignedDistance<f32x8<S>> {
        // Near planes, nothing goes by without going through. Of what is closed, they know the side themselves.
        if self.known().planes.is_empty() {
            return after;
        }
        let side = f32x8::splat(simd, 1.0).copysign(before.normal.dot(after.normal));
        SignedDistance { distance: after.distance * side, normal: after.normal * side }
    }

    #[inline(always)]
    fn own_way<S: Simd>(&self, simd: S, local: Vec3x8<S>) -> Vec3x8<S> {
        if !self.is_deformed {
            return Vec3x8::splat(simd, [0.0; 3]);
        }
        let known = self.known();
        nearest_point::nearest(simd, local, &known.now, known, self.mesh.is_closed).way_from(
            simd,
            &known.then,
            &known.now,
        )
    }

    fn correction(&self, i: usize, sweep: &ObstacleSweep, position: Vec3A, previous: Vec3A) -> Option<Correction> {
        ccd::correction(self, i, sweep, position, previous)
    }
}
