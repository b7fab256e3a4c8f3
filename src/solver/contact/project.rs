//! Particles out of solids, eight at a time.

use core::ops::Range;

use bevy::math::{Quat, Vec3A};
use fearless_simd::{dispatch, f32x8, prelude::*};

use super::{
    Shape, Solid,
    course::{Course, Moving, Shifted, Turned},
    near::{Reachable, STRETCH},
    solid::Field,
    sweep::Passage,
};
use crate::solver::{
    Scratch, StepContext,
    lanes::{Block, Run},
    simd::{Instructions, Vec3x8, lane},
};

/// Projects all free particles out of all solids within the part `span` (0..=1) of the step, a substep of `h` seconds.
/// Returns the number of contacts.
pub(in crate::solver) fn project(scratch: &mut Scratch, ctx: &StepContext, span: Range<f32>, h: f32) -> u32 {
    let Scratch { lanes, near, instructions, .. } = scratch;
    near.follow(lanes, ctx, span.clone(), *instructions);
    let mut run = lanes.whole();
    let mut contacts = 0;
    for number in 0..near.solids.len() {
        let obstacle = &ctx.obstacles[near.solids[number].obstacle];
        let Shape::Solid(solid) = obstacle.shape else { continue };
        let poses = [span.start, span.end].map(|t| obstacle.pose(t));
        let passage = Passage::new(solid, obstacle, poses, ctx, h);
        let stretches = near.stretches(number, poses);
        contacts += match &passage.solid {
            Solid::Sphere(field) => past(field, &passage, &mut run, stretches, *instructions),
            Solid::Cuboid(field) => past(field, &passage, &mut run, stretches, *instructions),
            Solid::Capsule(field) => past(field, &passage, &mut run, stretches, *instructions),
            Solid::TaperedCapsule(field) => past(field, &passage, &mut run, stretches, *instructions),
            Solid::Cylinder(field) => past(field, &passage, &mut run, stretches, *instructions),
            Solid::Cone(field) => past(field, &passage, &mut run, stretches, *instructions),
            Solid::HalfSpace(field) => past(field, &passage, &mut run, stretches, *instructions),
        };
    }
    contacts
}

/// Parts of a cloth that may come past an obstacle.
pub(super) struct Stretches<'a> {
    pub reachable: &'a [Reachable],
    /// How far each stretch has come off where it was, m.
    pub moved: &'a mut [f32],
    /// Where that was, m.
    pub start: &'a [Block],
    /// How far the obstacle has come since then at most, m.
    pub way: f32,
    /// The farthest from its origin that anything happens, m.
    pub far: f32,
}

fn past(field: &impl Field, passage: &Passage, run: &mut Run, stretches: Stretches, instructions: Instructions) -> u32 {
    let level = instructions.level();
    if passage.moves() {
        dispatch!(level, simd => past_stretches::<_, Moving<_>>(simd, field, passage, run, stretches))
    } else if passage.end.rotation == Quat::IDENTITY {
        dispatch!(level, simd => past_stretches::<_, Shifted<_>>(simd, field, passage, run, stretches))
    } else {
        dispatch!(level, simd => past_stretches::<_, Turned<_>>(simd, field, passage, run, stretches))
    }
}

#[inline(always)]
fn past_stretches<S: Simd, C: Course<S>>(
    simd: S,
    field: &impl Field,
    passage: &Passage,
    run: &mut Run,
    stretches: Stretches,
) -> u32 {
    let Passage { distance, friction, parting, .. } = passage;
    let course = C::new(simd, passage);
    let zero = f32x8::splat(simd, 0.0);
    let drift = passage.way(stretches.far);
    let mut contacts = 0;
    for reachable in stretches.reachable {
        let moved = &mut stretches.moved[reachable.stretch];
        if reachable.clearance > *moved + stretches.way {
            continue;
        }
        let mut farthest = zero;
        let first = reachable.stretch * STRETCH;
        for block in first..(first + STRETCH).min(run.position.len()) {
            let (place, before) = (Vec3x8::load(simd, &run.position[block]), Vec3x8::load(simd, &run.previous[block]));
            let local = course.to_local(place);
            let after = field.seen(local);
            // A particle that is farther away than it can have come this substep is left alone.
            let (depth, way) = (-after.distance + *distance, place - before);
            let beyond = (-depth - drift).max(zero);
            let is_free = lane(simd, &run.inverse_mass[block]).simd_gt(zero);
            let is_near = is_free & (beyond * beyond).simd_le(way.dot(way));
            if is_near.all_false() {
                continue;
            }
            let old = field.seen(course.start_to_local(before));
            let sees_the_same = old.normal.dot(after.normal).simd_gt(zero);
            let touches = is_near & sees_the_same & depth.simd_gt(zero);
            let mut swept = (is_near & !sees_the_same).to_bitmask();
            if touches.any_true() {
                let old_depth = (-old.distance + *distance).max(zero).min(depth);
                let (gained, parted) = (depth - old_depth, old_depth.min(*parting));
                let normal = course.turned(after.normal);
                let parting = normal * parted;
                let (now, left) = (place + normal * gained + parting, before + parting);
                let way = course.past(now - left, local + after.normal * depth);
                let slide = way - normal * way.dot(normal);
                let (squared, hold) = (slide.dot(slide), gained * *friction);
                let slides = squared.simd_gt(hold * hold);
                let mut held = slide;
                if slides.any_true() {
                    held = (slide * (hold / squared.sqrt())).or(slides, slide);
                }
                let now = (now - held).or(touches, place);
                now.store(&mut run.position[block]);
                left.or(touches, before).store(&mut run.previous[block]);
                let off = now - Vec3x8::load(simd, &stretches.start[block]);
                farthest = farthest.max(touches.select(off.dot(off), zero));
                contacts += touches.to_bitmask().count_ones();
            }
            while swept != 0 {
                let i = swept.trailing_zeros() as usize;
                swept &= swept - 1;
                if let Some(off) = sweep(passage, run, &stretches.start[block], block, i) {
                    farthest = farthest.max(off * off);
                    contacts += 1;
                }
            }
        }
        *moved = farthest.reduce_max().sqrt().max(*moved);
    }
    contacts
}

/// Takes one particle of a block, which may have come through the obstacle, back to where it came in. Says how far it is
/// then from its place in `start`, m, if it was.
#[cold]
#[inline(never)]
fn sweep(passage: &Passage, run: &mut Run, start: &Block, block: usize, i: usize) -> Option<f32> {
    let get = |[x, y, z]: &Block| Vec3A::new(x[i], y[i], z[i]);
    let (mut position, mut previous) = (get(&run.position[block]), get(&run.previous[block]));
    passage.correction(position, previous)?.apply(&mut position, &mut previous, passage.friction);
    for (points, value) in [(&mut run.position[block], position), (&mut run.previous[block], previous)] {
        (points[0][i], points[1][i], points[2][i]) = value.into();
    }
    Some(position.distance(get(start)))
}
