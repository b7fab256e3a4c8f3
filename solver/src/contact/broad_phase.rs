//! Which obstacles a cloth may touch, and with which of its particles.
//!
//! Particles stand in stretches of some blocks, patches of a lattice. Of each stretch it is known how far it was from each
//! obstacle at some moment; until it has come that far since, none of its particles can touch it.

use core::ops::Range;

use bevy_math::{Isometry3d, Vec3A};
use fearless_simd::{dispatch, f32x8, prelude::*};

use crate::{
    contact::{
        body::Bodies,
        particle::{CandidateRanges, ccd},
    },
    input::{BodyDisplacement, MAX_TIME_STEP, Obstacle, Skin, StepContext, WindSource},
    layout::{
        points::Block,
        simd::{SimdLevel, Vec3x8, lane},
    },
    particles::{
        Particles,
        lanes::{Lanes, Run},
    },
    shape::{MeshShape, Shape},
};

/// Blocks in a stretch.
pub(crate) const STRETCH: usize = 8;

/// The way that a cloth may gain on an obstacle within a step by what pulls and pushes at it, m.
const GAINED: f32 = 0.01;

/// What is known of the obstacles around a cloth.
#[derive(Clone, Debug, Default)]
pub(crate) struct BroadPhase {
    /// Those that may be touched.
    pub(crate) obstacles: Vec<NearObstacle>,
    /// Stretches that may touch them, obstacle after obstacle.
    reachable: Vec<CandidateRange>,
    /// Where the particles were when that was found, m.
    start: Vec<Block>,
    /// Ball around the free ones of each stretch there.
    balls: Vec<BoundingSphere>,
    /// How far the free ones of each stretch are from there, m.
    moved: Vec<f32>,
    /// How far they may come without touching anything else, m.
    known: f32,
}

/// An obstacle that may be touched.
#[derive(Clone, Debug)]
pub(crate) struct NearObstacle {
    /// Its number among the obstacles.
    pub obstacle: usize,
    /// Where it was when the particles were at their start.
    pose: Isometry3d,
    /// How far it had come off its path by then.
    displacement: BodyDisplacement,
    /// The farthest from its origin that anything happens, m.
    far: f32,
    /// Its stretches.
    reachable: Range<usize>,
}

/// A stretch that may touch an obstacle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CandidateRange {
    pub stretch: usize,
    /// Distance between the two at least, m, that they came nearer than which they would touch.
    pub clearance: f32,
}

/// A ball around points.
#[derive(Clone, Copy, Debug)]
struct BoundingSphere {
    centre: Vec3A,
    /// Radius, m; negative around nothing.
    radius: f32,
}

impl BoundingSphere {
    /// Around the box between two corners.
    fn around(low: Vec3A, high: Vec3A) -> Self {
        if low.cmple(high).all() {
            Self { centre: (low + high) / 2.0, radius: low.distance(high) / 2.0 }
        } else {
            Self { centre: Vec3A::ZERO, radius: f32::NEG_INFINITY }
        }
    }
}

/// The region that a cloth may reach within a step: what is outside of it can't touch the cloth.
#[derive(Clone, Copy, Debug)]
pub struct StepReach {
    /// Corners of the box around the particles, pins, hands and skin, m.
    low: Vec3A,
    high: Vec3A,
    /// How far beyond it something may be touched, m.
    distance: f32,
}

impl StepReach {
    /// The reach of a step. What `ctx` has of obstacles doesn't matter.
    pub fn new(particles: &Particles, ctx: &StepContext) -> Self {
        let ends = ctx.pin_motions.iter().map(|anchor| anchor.end).chain(ctx.grabs.iter().map(|grab| grab.end));
        let on_skin = ctx.skin.into_iter().flat_map(Skin::ways).map(|[_, end]| end);
        let places = particles.position.iter().copied().chain(ends).chain(on_skin);
        let (low, high) =
            places.fold((Vec3A::INFINITY, Vec3A::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
        let fastest = particles.velocity.iter().map(|v| v.length_squared()).fold(0.0, f32::max).sqrt();
        // A step ahead, and once more for what it gains in speed.
        let distance = ctx.contact_distance() + 2.0 * fastest * ctx.dt.min(MAX_TIME_STEP) + GAINED;
        Self { low, high, distance }
    }

    /// Whether an obstacle that is rounded by so much (m) may be touched on its way from one pose to the other.
    pub fn includes(&self, shape: &Shape, [start, end]: [&Isometry3d; 2], rounding: f32) -> bool {
        let Self { low, high, distance } = *self;
        let way = start.translation.distance(end.translation) + rounding;
        let radius = shape.reach();
        if !radius.is_finite() {
            let Shape::Solid(solid) = shape else { return true };
            let cloth = BoundingSphere::around(low, high);
            let is_reached = |pose: &Isometry3d| {
                solid.surface(pose.inverse().transform_point(cloth.centre)).distance - cloth.radius <= distance + way
            };
            // What turns sweeps over more than it covers at both ends.
            return start.rotation != end.rotation || is_reached(start) || is_reached(end);
        }
        start.translation.distance(start.translation.clamp(low, high)) - radius <= distance + way
    }

    /// Whether anything within a box may be touched, given its corners, m.
    pub fn meets(&self, [low, high]: [Vec3A; 2]) -> bool {
        let distance = Vec3A::splat(self.distance);
        ((self.low - distance).cmple(high) & low.cmple(self.high + distance)).all()
    }

    /// Whether a wind may move the cloth: it blows, and where the cloth may be.
    pub fn is_in_wind(&self, wind: &WindSource) -> bool {
        let BoundingSphere { centre, radius } = BoundingSphere::around(self.low, self.high);
        wind.velocity != Vec3A::ZERO && wind.region.depth(centre) > -(radius + self.distance)
    }

    /// Corners of the box around the particles, and what holds them: its least and greatest coordinates, m.
    pub fn bounds(&self) -> [Vec3A; 2] {
        [self.low, self.high]
    }
}

/// Obstacles that are so near that the cloth may touch them within a step.
pub(crate) fn near_obstacles<'a>(
    particles: &Particles,
    ctx: &StepContext<'a>,
) -> impl Iterator<Item = &'a Obstacle> + Clone {
    let reach = (!ctx.obstacles.is_empty()).then(|| StepReach::new(particles, ctx));
    let includes = move |obstacle: &&Obstacle| {
        let Obstacle { shape, start, end, rounding, .. } = obstacle;
        reach.is_some_and(|reach| reach.includes(shape, [start, end], *rounding))
    };
    ctx.obstacles.iter().filter(includes)
}

impl Obstacle {
    /// Corners of a box around all places where a cloth may touch it within the step, however it turns, m. Infinite where there
    /// is none.
    pub fn bounds(&self) -> [Vec3A; 2] {
        let way = self.start.translation.distance(self.end.translation);
        let reach = Vec3A::splat(self.shape.reach() + self.rounding + way);
        [self.start.translation - reach, self.start.translation + reach]
    }

    /// Centre and radius of a ball around it at the start of the step, m, that holds it as well however it turns. None where
    /// there is none.
    pub(crate) fn ball(&self) -> Option<(Vec3A, f32)> {
        let radius = self.shape.reach();
        radius.is_finite().then_some((self.start.translation, radius))
    }
}

impl Shape {
    /// Radius of a ball around the origin that holds all of it, m. Infinite where there is none.
    fn reach(&self) -> f32 {
        match self {
            Self::Solid(solid) => solid.reach(),
            Self::Mesh(MeshShape { mesh, deformed: None }) => {
                let [low, high] = mesh.bounds();
                low.abs().max(high.abs()).length()
            }
            Self::Mesh(MeshShape { deformed: Some(points), .. }) => points.reach,
        }
    }

    /// Distance of a place in its own frame that it has at least, m; negative inside.
    fn distance(&self, place: Vec3A) -> f32 {
        match self {
            Self::Solid(solid) => solid.surface(place).distance,
            Self::Mesh(MeshShape { mesh, deformed: None }) => {
                let [low, high] = mesh.bounds();
                place.distance(place.clamp(low, high))
            }
            Self::Mesh(_) => f32::NEG_INFINITY,
        }
    }
}

impl BroadPhase {
    /// Begins a step: nothing is known yet.
    pub fn begin(&mut self) {
        self.known = f32::NEG_INFINITY;
    }

    /// Follows the particles in the part `span` of the step, and finds out anew what is near where one has come too far.
    pub fn follow(
        &mut self,
        lanes: &mut Lanes,
        ctx: &StepContext,
        span: Range<f32>,
        bodies: &Bodies,
        simd_level: SimdLevel,
    ) {
        let stretches = lanes.inverse_mass.len().div_ceil(STRETCH);
        self.moved.resize(stretches, 0.0);
        let run = lanes.whole();
        if self.known >= 0.0 {
            self.measure(&run, simd_level);
            if self.farthest(bodies) <= self.known {
                return;
            }
        }
        self.start.clear();
        self.start.extend_from_slice(run.previous);
        self.measure(&run, simd_level);
        self.find(&run, ctx, span, bodies, simd_level);
    }

    /// How far any particle has come, and any obstacle off its path, m.
    fn farthest(&self, bodies: &Bodies) -> f32 {
        let of_obstacles = self.obstacles.iter().map(|near| {
            let displacement = bodies.displacements[near.obstacle];
            displacement.shift.distance(near.displacement.shift)
                + ccd::turn_between(displacement.turn, near.displacement.turn, near.far)
        });
        self.moved.iter().copied().chain(of_obstacles).fold(0.0, f32::max)
    }

    fn measure(&mut self, run: &Run, simd_level: SimdLevel) {
        let Self { moved, start, .. } = self;
        dispatch!(simd_level.level(), simd => measure(simd, moved, start, run));
    }

    /// Finds the obstacles and stretches that may touch each other in what is left of the step, from `span` on.
    fn find(&mut self, run: &Run, ctx: &StepContext, span: Range<f32>, bodies: &Bodies, simd_level: SimdLevel) {
        let Self { obstacles, reachable, start, balls, moved, .. } = self;
        balls.resize(moved.len(), BoundingSphere { centre: Vec3A::ZERO, radius: 0.0 });
        dispatch!(simd_level.level(), simd => enclose(simd, balls, start, run));
        let some = balls.iter().filter(|ball| ball.radius >= 0.0);
        let (low, high) = some.fold((Vec3A::INFINITY, Vec3A::NEG_INFINITY), |(low, high), ball| {
            (low.min(ball.centre - ball.radius), high.max(ball.centre + ball.radius))
        });
        let cloth = BoundingSphere::around(low, high);
        let left = (1.0 - span.start) / (span.end - span.start);
        let mut known = 2.0 * moved.iter().copied().fold(0.0, f32::max) * left + GAINED;
        let ways = ctx.obstacles.iter().map(|o| o.start.translation.distance(o.end.translation));
        known += ways.fold(0.0, f32::max);
        self.known = known;
        obstacles.clear();
        reachable.clear();
        obstacles.reserve(ctx.obstacles.len());
        for (obstacle, it) in ctx.obstacles.iter().enumerate() {
            let distance = ctx.contact_distance() + it.rounding;
            let (path, [pose, _]) = (it.pose(span.start), bodies.poses(ctx, obstacle, span.clone()));
            let far = pose.translation.distance(cloth.centre) + cloth.radius + known;
            // What cloth moves comes off its path.
            let off = if it.body.is_some() { known } else { 0.0 };
            // A ball around it holds it however it turns.
            let shift = path.translation.distance(it.end.translation) + off;
            let radius = it.shape.reach() + distance + shift;
            let gap = |ball: &BoundingSphere| pose.translation.distance(ball.centre) - ball.radius - radius;
            if gap(&cloth) > known {
                continue;
            }
            let way = ccd::way_between(&path, &it.end, far) + off;
            let to_local = pose.inverse();
            let first = reachable.len();
            // For all that it can be: a step doesn't allocate because the cloth comes nearer.
            reachable.reserve(balls.len());
            for (stretch, ball) in balls.iter().enumerate() {
                if ball.radius < 0.0 || gap(ball) > known {
                    continue;
                }
                let clearance = it.shape.distance(to_local.transform_point(ball.centre)) - ball.radius - distance;
                if clearance - way <= known {
                    reachable.push(CandidateRange { stretch, clearance });
                }
            }
            if reachable.len() > first {
                let displacement = bodies.displacements[obstacle];
                obstacles.push(NearObstacle { obstacle, pose, displacement, far, reachable: first..reachable.len() });
            }
        }
    }

    /// The stretches that an obstacle may touch.
    pub(crate) fn stretches(&mut self, number: usize) -> CandidateRanges<'_> {
        let NearObstacle { far, reachable, pose, .. } = &self.obstacles[number];
        CandidateRanges {
            reachable: &self.reachable[reachable.clone()],
            moved: &mut self.moved,
            start: &self.start,
            pose: *pose,
            far: *far,
        }
    }
}

#[inline(always)]
fn measure<S: Simd>(simd: S, moved: &mut [f32], start: &[Block], run: &Run) {
    let zero = f32x8::splat(simd, 0.0);
    let blocks = run.position.chunks(STRETCH).zip(start.chunks(STRETCH)).zip(run.inverse_mass.chunks(STRETCH));
    for (moved, ((position, start), inverse_mass)) in moved.iter_mut().zip(blocks) {
        let mut farthest = zero;
        for ((position, start), w) in position.iter().zip(start).zip(inverse_mass) {
            let off = Vec3x8::load(simd, position) - Vec3x8::load(simd, start);
            let is_free = lane(simd, w).simd_gt(zero);
            farthest = farthest.max(is_free.select(off.dot(off), zero));
        }
        *moved = farthest.reduce_max().sqrt();
    }
}

#[inline(always)]
fn enclose<S: Simd>(simd: S, balls: &mut [BoundingSphere], start: &[Block], run: &Run) {
    let zero = f32x8::splat(simd, 0.0);
    let (least, most) = (Vec3x8::splat(simd, [f32::INFINITY; 3]), Vec3x8::splat(simd, [f32::NEG_INFINITY; 3]));
    for (ball, (start, inverse_mass)) in
        balls.iter_mut().zip(start.chunks(STRETCH).zip(run.inverse_mass.chunks(STRETCH)))
    {
        let (mut low, mut high) = (least, most);
        for (start, w) in start.iter().zip(inverse_mass) {
            let place = Vec3x8::load(simd, start);
            let is_free = lane(simd, w).simd_gt(zero);
            let (inner, outer) = (place.or(is_free, least), place.or(is_free, most));
            low = Vec3x8 { x: low.x.min(inner.x), y: low.y.min(inner.y), z: low.z.min(inner.z) };
            high = Vec3x8 { x: high.x.max(outer.x), y: high.y.max(outer.y), z: high.z.max(outer.z) };
        }
        let low = Vec3A::new(low.x.reduce_min(), low.y.reduce_min(), low.z.reduce_min());
        let high = Vec3A::new(high.x.reduce_max(), high.y.reduce_max(), high.z.reduce_max());
        *ball = BoundingSphere::around(low, high);
    }
}
