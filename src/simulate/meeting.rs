//! Which cloths may touch each other within a step.

use bevy::{
    ecs::query::QueryData,
    math::{
        Vec3A,
        bounding::{Aabb3d, BoundingVolume, IntersectsVolume},
    },
    prelude::*,
};

use crate::{
    cloth::InForce,
    solver::MAX_TIME_STEP,
    state::{
        ClothAttachments, ClothReport, ClothSleepingDisabled, ClothState, ClothStatus, Skinning, Sleep, StepInput,
    },
};

/// All of a cloth that a step reads and writes.
#[derive(QueryData)]
#[query_data(mutable)]
pub(crate) struct Stepped {
    pub entity: Entity,
    pub status: &'static mut ClothStatus,
    pub state: &'static mut ClothState,
    pub attachments: &'static ClothAttachments,
    pub in_force: &'static InForce,
    pub input: &'static mut StepInput,
    pub report: &'static mut ClothReport,
    pub skinning: &'static Skinning,
    pub sleep: &'static mut Sleep,
    pub is_sleeping_disabled: Has<ClothSleepingDisabled>,
}

/// By how much particles may gain on each other within a step beyond their speed, m.
const GAINED: f32 = 0.02;

/// Puts cloths that may touch each other within `dt` seconds together, in the order of their entities.
pub(super) fn group<'w, 's>(ready: Vec<SteppedItem<'w, 's>>, dt: f32) -> Vec<Vec<SteppedItem<'w, 's>>> {
    let (mut meeting, alone): (Vec<_>, Vec<_>) =
        ready.into_iter().partition(|cloth| cloth.in_force.solver.self_collision);
    meeting.sort_unstable_by_key(|cloth| cloth.entity);
    let boxes: Vec<Option<Aabb3d>> = meeting.iter().map(|cloth| reached(cloth, dt)).collect();
    let filter = |i: usize| meeting[i].in_force.solver.collision_filter;
    // The first of each cloth's group.
    let mut leader: Vec<usize> = (0..meeting.len()).collect();
    for i in 0..meeting.len() {
        for j in 0..i {
            let (Some(one), Some(other)) = (&boxes[i], &boxes[j]) else { continue };
            if leader[i] != leader[j] && filter(i).meets(filter(j)) && one.intersects(other) {
                let (first, last) = (leader[i].min(leader[j]), leader[i].max(leader[j]));
                leader.iter_mut().filter(|leader| **leader == last).for_each(|leader| *leader = first);
            }
        }
    }
    let mut groups: Vec<Vec<SteppedItem>> = meeting.iter().map(|_| Vec::new()).collect();
    for (cloth, leader) in meeting.into_iter().zip(leader) {
        groups[leader].push(cloth);
    }
    groups.retain(|group| !group.is_empty());
    groups.extend(alone.into_iter().map(|cloth| vec![cloth]));
    groups
}

/// Box around what a cloth may reach within a step, in the world; none of a cloth that is nowhere.
fn reached(SteppedItem { state, in_force, sleep, .. }: &SteppedItem, dt: f32) -> Option<Aabb3d> {
    let (particles, dt) = (&state.particles, dt.min(MAX_TIME_STEP));
    let around_moving = || {
        let ends = |(&place, &velocity): (&Vec3A, &Vec3A)| [place, place + velocity * dt];
        let mut places = particles.position.iter().zip(&particles.velocity).flat_map(ends);
        let first = places.next()?;
        Some(places.fold([first; 2], |[low, high], p| [low.min(p), high.max(p)]))
    };
    let origin = Vec3A::from(state.origin);
    let [low, high] = sleep.reach.map(|reach| reach.bounds()).or_else(around_moving)?.map(|corner| origin + corner);
    let bounds = Aabb3d { min: low, max: high };
    // Far from the world's origin, places are rounded.
    let distance = in_force.solver.self_distance_on(&state.topology);
    let margin = distance + GAINED + 1e-6 * origin.abs().max_element();
    (low.is_finite() && high.is_finite()).then(|| bounds.grow(Vec3A::splat(margin)))
}
