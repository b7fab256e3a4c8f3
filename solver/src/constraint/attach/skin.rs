//! Skin: particles stay near where an animated mesh has them, and off its inside.
//!
//! ```text
//!   t = lerp(s0, s1)        n = normalize(lerp(n0, n1))          ' = at the start of the substep
//!   pull      x += (k (t - x) + c ((t - t') - (x - x'))) / (1 + k + c)     k = (2 pi f h)², c = 2 zeta 2 pi f h
//!   distance  |x - t| > D      =>  x = t + D (x - t) / |x - t|
//!   backstop  |x - q| < r      =>  x = q + r (x - q) / |x - q|              q = t - (b + r) n
//! ```
//!
//! The pull is an implicit Euler step of a damped spring between each particle and its place, with an own frequency instead of a
//! stiffness: its mass cancels out. Distance and backstop are the motion and separation constraints of NvCloth, the max distance
//! and backstop of Unreal Engine. What came into the backstop within the substep leaves at once; what was inside before leaves no
//! faster than it would an obstacle, and gains no speed by it.
//!
//! **Tethers and levels.** Skinning stretches meshes by a quarter at the joints of common models: more than cloth gives. The skin
//! comes after what holds the cloth by its length, and wins. Coarse levels leave particles alone that it holds within less than
//! an edge: otherwise they draw what hangs from a stretched mesh together, and springs there are strained by 19 % instead of
//! 0.05 %. Tethers stay as they are: they draw all particles to the same side of their limits, so that cloth is strained as
//! evenly as the mesh. Lengthened to what the mesh asks for they leave that to the springs, a few of which are then stretched by
//! up to seven times their length.
//!
//! **Obstacles** come after the skin, and then its largest distances once more: where a body's capsule and what is painted contradict
//! each other, what is painted holds. Else cloth is torn between the two: next to a collar within a capsule it is stretched
//! twenty times.
//!
//! Strands aren't helped by another clamp before them: in cloth that a fast mesh holds within half an edge, strain is then the same
//! to some hundredths of itself, in some scenes more and in others less.

use core::{f32::consts::TAU, ops::Range};

use bevy_math::Vec3A;
use fearless_simd::{dispatch, f32x8, mask32x8, prelude::*};

use crate::{
    constraint::attach::skin::backstop::Backstop8,
    input::{FARTHEST, Skin, SkinLimits, StepContext},
    layout::{
        order::Order,
        points::Points,
        simd::{SimdLevel, Vec3x8, lane},
    },
    particles::lanes::Run,
};

mod backstop;
mod predict;

/// The animated mesh in a step, laid out as the particles are.
#[derive(Clone, Debug, Default)]
pub(crate) struct SkinPoints {
    /// Whether there is one.
    is_there: bool,
    /// Places at the start and the end of the step, m.
    places: [Points; 2],
    /// Normals then; only where there are backstops.
    normals: [Points; 2],
}

impl SkinPoints {
    /// Takes over the mesh of a step of a cloth in this `order`.
    pub fn begin(&mut self, ctx: &StepContext, order: Order, simd_level: SimdLevel) {
        let skin = ctx.skin.filter(|skin| skin.is_of(order));
        self.is_there = skin.is_some();
        let Some(skin) = skin else { return };
        let has_backstop = skin.has_backstop();
        for (i, pose) in [skin.start, skin.end].into_iter().enumerate() {
            self.places[i].load(order, &pose.place, simd_level);
            if has_backstop {
                self.normals[i].load(order, &pose.normal, simd_level);
            }
        }
    }

    /// The mesh's normal at a slot in a part (0..=1) of the step, of any length. Only where there are backstops.
    fn normal(&self, slot: usize, part: f32) -> Vec3A {
        self.normals[0].get(slot).lerp(self.normals[1].get(slot), part)
    }

    /// The skin of a step, if there is one that holds anything.
    pub fn of<'a>(&self, ctx: &StepContext<'a>) -> Option<Skin<'a>> {
        ctx.skin.filter(|_| self.is_there)
    }

    /// Where the mesh has the particle in a slot at the start and the end of the step, m.
    fn way(&self, slot: usize) -> [Vec3A; 2] {
        [self.places[0].get(slot), self.places[1].get(slot)]
    }

    /// What holds the cloth in the part `span` (0..=1) of the step, a substep of `h` seconds.
    pub fn solver<'a>(
        &'a self,
        ctx: &StepContext<'a>,
        span: Range<f32>,
        h: f32,
        simd_level: SimdLevel,
    ) -> Option<SkinSolver<'a>> {
        let skin = self.of(ctx)?;
        Some(SkinSolver {
            limits: skin.limits,
            points: self,
            span,
            pull: skin.pulling().map(|[frequency, damping]| Pull::new(frequency, damping, h)),
            has_backstops: true,
            parting: ctx.settings.max_depenetration_velocity * h,
            friction: ctx.material.friction,
            simd_level,
        })
    }
}

/// The factors of a pull in a substep, no unit.
#[derive(Clone, Copy, Debug)]
struct Pull {
    k: f32,
    c: f32,
}

impl Pull {
    /// Of an own frequency in Hz and a damping ratio, in a substep of `h` seconds.
    fn new(frequency: f32, damping: f32, h: f32) -> Self {
        let phase = TAU * frequency * h;
        Self { k: phase * phase, c: 2.0 * damping * phase }
    }
}

/// What a skin does in a substep.
#[derive(Clone, Debug)]
pub(crate) struct SkinSolver<'a> {
    limits: &'a SkinLimits,
    points: &'a SkinPoints,
    /// The part of the step.
    span: Range<f32>,
    pull: Option<Pull>,
    /// Whether backstops count.
    has_backstops: bool,
    /// Largest way out of a backstop of what was inside before, m.
    parting: f32,
    /// Coulomb friction on a backstop, no unit.
    friction: f32,
    simd_level: SimdLevel,
}

impl SkinSolver<'_> {
    /// The same that does nothing but hold particles within their largest distance: obstacles have moved them since.
    pub fn distances_only(self) -> Self {
        Self { pull: None, has_backstops: false, ..self }
    }

    /// Holds the particles of some blocks.
    pub fn solve(&self, run: &mut Run) {
        dispatch!(self.simd_level.level(), simd => self.solve_blocks(simd, run));
    }

    #[inline(always)]
    fn solve_blocks<S: Simd>(&self, simd: S, run: &mut Run) {
        let limits = &self.limits.blocks()[run.first..];
        let blocks = run.position.iter_mut().zip(&mut *run.previous).zip(&*run.inverse_mass).zip(limits);
        for (i, (((position, previous), w), limit)) in blocks.enumerate() {
            if !limit.is_limited && self.pull.is_none() {
                continue;
            }
            let [from, to] = &self.points.places;
            let (from, to) = (Vec3x8::load(simd, &from.0[run.first + i]), Vec3x8::load(simd, &to.0[run.first + i]));
            let is_free = lane(simd, w).simd_gt(f32x8::splat(simd, 0.0));
            let is_held = is_free & is_near(simd, from) & is_near(simd, to);
            if is_held.all_false() {
                continue;
            }
            let mut it = Held8 {
                place: Vec3x8::load(simd, position),
                before: Vec3x8::load(simd, previous),
                target: between(simd, from, to, self.span.end),
                target_before: between(simd, from, to, self.span.start),
                is_held,
            };
            if let Some(pull) = self.pull {
                it.pull(simd, pull);
            }
            let most = lane(simd, &limit.max_distance);
            it.clamp(most);
            if limit.has_backstop && self.has_backstops {
                let [from, to] = &self.points.normals;
                let normals = [&from.0[run.first + i], &to.0[run.first + i]];
                let backstop = Backstop8::new(simd, limit, normals, [self.span.start, self.span.end]);
                backstop.keep_out(&mut it, most, self.parting, self.friction);
                it.before.store(previous);
            }
            it.place.store(position);
        }
    }
}

/// Eight particles and their places on the mesh in a substep.
struct Held8<S: Simd> {
    /// Where they are, and where they were, m.
    place: Vec3x8<S>,
    before: Vec3x8<S>,
    /// Where the mesh has them, and had them, m.
    target: Vec3x8<S>,
    target_before: Vec3x8<S>,
    /// Which of them it holds.
    is_held: mask32x8<S>,
}

impl<S: Simd> Held8<S> {
    #[inline(always)]
    fn pull(&mut self, simd: S, Pull { k, c }: Pull) {
        let drift = (self.target - self.target_before) - (self.place - self.before);
        let [k, c] = [k / (1.0 + k + c), c / (1.0 + k + c)];
        let (k, c) = (f32x8::splat(simd, k), f32x8::splat(simd, c));
        let way = (self.target - self.place) * k + drift * c;
        self.place = (self.place + way).or(self.is_held, self.place);
    }

    /// Takes those that are farther than `most` (m) from their places back to that distance.
    #[inline(always)]
    fn clamp(&mut self, most: f32x8<S>) {
        let away = self.place - self.target;
        let squared = away.dot(away);
        let is_beyond = self.is_held & squared.simd_gt(most * most);
        if is_beyond.any_true() {
            self.place = (self.target + away * (most / squared.sqrt())).or(is_beyond, self.place);
        }
    }
}

/// Which places are such that they hold: what isn't a number is not.
#[inline(always)]
fn is_near<S: Simd>(simd: S, place: Vec3x8<S>) -> mask32x8<S> {
    place.dot(place).simd_le(f32x8::splat(simd, FARTHEST * FARTHEST))
}

/// The point at a part (0..=1) of the way between two: those themselves at its ends.
#[inline(always)]
fn between<S: Simd>(simd: S, from: Vec3x8<S>, to: Vec3x8<S>, part: f32) -> Vec3x8<S> {
    from * f32x8::splat(simd, 1.0 - part) + to * f32x8::splat(simd, part)
}
