//! Backstops: spheres beneath the animated mesh that particles stay out of.
//!
//! ```text
//!             n ^
//!      --------t--------        p = x - t      L = b + r      q = t - L n      s = |x - q| = |p + L n|
//!              | b    x
//!            .---.   /          depth = r - s = -(b² + 2 b r + p·p + 2 L p·n) / (r + s)
//!           (  q---'
//!            '---'              the last form loses nothing where r is large
//! ```
//!
//! Where a particle can't be pushed straight out and stay within its largest distance D of t, it goes to where both spheres meet:
//!
//! x = t - a n + sqrt(D² - a²) u,    a = (b² + 2 b r + D²) / (2 L),    u: unit vector of what of p is across n

use fearless_simd::{f32x8, mask32x8, prelude::*};

use crate::{
    constraint::attach::skin::{Held8, between},
    input::SkinBlock,
    layout::{
        points::Block,
        simd::{SHORTEST, Vec3x8, lane},
    },
};

/// Below this share of their lengths a normal between two others has no direction: the mesh is turned over within a step.
const LEAST_NORMAL: f32 = 1e-3;

/// Backstops of eight particles in a substep.
pub(super) struct Backstop8<S: Simd> {
    /// Distance and radius, m.
    distance: f32x8<S>,
    radius: f32x8<S>,
    /// The mesh's unit normals, and those before the substep.
    normal: Vec3x8<S>,
    normal_before: Vec3x8<S>,
    /// Which particles have one.
    is_there: mask32x8<S>,
}

/// How particles are to backstops.
struct Nearest8<S: Simd> {
    /// How deep they are inside, m.
    depth: f32x8<S>,
    /// The straight way out.
    out: Vec3x8<S>,
}

impl<S: Simd> Backstop8<S> {
    /// Those of some limits, where the mesh has the `normals` at the ends of the step, in the part `span` (0..=1) of it.
    #[inline(always)]
    pub fn new(simd: S, limit: &SkinBlock, [from, to]: [&Block; 2], span: [f32; 2]) -> Self {
        let (from, to) = (Vec3x8::load(simd, from), Vec3x8::load(simd, to));
        let radius = lane(simd, &limit.backstop_radius);
        let (before, now) = (between(simd, from, to, span[0]), between(simd, from, to, span[1]));
        let least = from.dot(from).max(to.dot(to)) * (LEAST_NORMAL * LEAST_NORMAL);
        let ((before, has_before), (normal, has_normal)) = (unit(simd, before, least), unit(simd, now, least));
        Self {
            distance: lane(simd, &limit.backstop_distance),
            radius,
            normal,
            normal_before: before.or(has_before, normal),
            is_there: has_normal & radius.simd_gt(f32x8::splat(simd, 0.0)),
        }
    }

    /// How places are to backstops below `target`s.
    #[inline(always)]
    fn nearest(&self, place: Vec3x8<S>, target: Vec3x8<S>, normal: Vec3x8<S>) -> Nearest8<S> {
        let Self { distance, radius, .. } = *self;
        let (beside, length) = (place - target, distance + radius);
        let from_centre = beside + normal * length;
        let far = from_centre.dot(from_centre).sqrt();
        let above = distance * (distance + radius * 2.0) + beside.dot(beside) + beside.dot(normal) * length * 2.0;
        // At the centre all ways out are the same.
        let out = (from_centre * (1.0 / far)).or(far.simd_gt(SHORTEST), normal);
        Nearest8 { depth: -above / (radius + far), out }
    }

    /// Keeps particles out, and no farther than `most` (m) from their places: with friction by how far they are pushed, and by no
    /// more than `parting` (m) where they were inside before.
    #[inline(always)]
    pub fn keep_out(&self, it: &mut Held8<S>, most: f32x8<S>, parting: f32, friction: f32) {
        let Nearest8 { depth, out } = self.nearest(it.place, it.target, self.normal);
        let before = self.nearest(it.before, it.target_before, self.normal_before);
        let (was_inside, is_inside) = (before.depth.max(0.0), depth.max(0.0));
        let is_deep = was_inside.simd_gt(parting);
        let touches = it.is_held & self.is_there & (depth.simd_gt(0.0) | is_deep);
        if touches.all_false() {
            return;
        }
        // As at obstacles: what leaves by itself needs that much less of a push, and none that makes it too fast.
        let old_depth = was_inside.min(is_inside);
        let left = was_inside - old_depth;
        let (penetration, parted) = (is_inside - old_depth, old_depth.min((-left + parting).max(0.0)));
        let clamped = is_deep.select((was_inside - depth - parting).max(0.0), depth * 0.0);
        let slide = (it.place - it.before) - (it.target - it.target_before);
        let slide = slide - out * slide.dot(out);
        let (squared, hold) = (slide.dot(slide), penetration * friction);
        let held = (slide * (hold / squared.sqrt())).or(squared.simd_gt(hold * hold), slide);
        let push = out * (penetration + parted - clamped) - held;
        it.place = (it.place + push).or(touches, it.place);
        it.before = (it.before + out * parted).or(touches, it.before);
        self.stay_near(it, most, touches & parted.simd_ge(old_depth));
        it.clamp(most);
    }

    /// Takes those that `are_out` of their backstops, but farther than `most` (m) from their places, to where both are kept.
    #[inline(always)]
    fn stay_near(&self, it: &mut Held8<S>, most: f32x8<S>, are_out: mask32x8<S>) {
        let Self { distance, radius, normal, .. } = *self;
        let beside = it.place - it.target;
        let are_beyond = are_out & beside.dot(beside).simd_gt(most * most);
        if are_beyond.all_false() {
            return;
        }
        let across = beside - normal * beside.dot(normal);
        let width = across.dot(across).sqrt();
        let below = (distance * (distance + radius * 2.0) + most * most) / ((distance + radius) * 2.0);
        let aside = (most * most - below * below).max(0.0).sqrt();
        let edge = it.target - normal * below + across * (aside / width);
        it.place = edge.or(are_beyond & width.simd_gt(SHORTEST), it.place);
    }
}

/// Unit vectors, and which of them have a direction: those whose squared length is more than the `least`.
#[inline(always)]
fn unit<S: Simd>(simd: S, vector: Vec3x8<S>, least: f32x8<S>) -> (Vec3x8<S>, mask32x8<S>) {
    let squared = vector.dot(vector);
    let has_direction = squared.simd_gt(least) & squared.simd_lt(f32::INFINITY);
    (vector * (f32x8::splat(simd, 1.0) / squared.sqrt()), has_direction)
}
