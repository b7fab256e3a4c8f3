//! Intended jumps: what is put elsewhere keeps no memory of its way.

use bevy::{
    ecs::system::SystemParam,
    math::{Affine3A, Isometry3d, Vec3A},
    platform::{collections::HashMap, hash::FixedHasher},
    prelude::*,
};

use super::{FromLatestStep, Pass, PerPass, StepNumber, Steps, is_invertible};

/// From when on a move of an obstacle is taken for a teleport: where it is both farther and faster than this within one
/// step. It then sweeps nothing on its way.
///
/// It counts for every [`ClothCollider`](crate::prelude::ClothCollider), and for colliders of physics engines that their
/// user moves: of a body that forces move, its velocity tells. A game with faster obstacles, as bullets, sets more;
/// `f32::INFINITY` takes nothing for a teleport that [`teleport_collider`](crate::prelude::ClothCommands::teleport_collider)
/// hasn't asked for.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Resource, Default, Debug, Clone, PartialEq)]
pub struct ColliderTeleportThreshold {
    /// Distance in m. 1 by default.
    pub distance: f32,
    /// Speed in m/s. 60 by default.
    pub speed: f32,
}

impl Default for ColliderTeleportThreshold {
    fn default() -> Self {
        Self { distance: 1.0, speed: 60.0 }
    }
}

impl ColliderTeleportThreshold {
    /// Whether a way of so many metres within `dt` seconds is one that no game means as motion.
    pub(crate) fn is_exceeded(&self, way: f32, dt: f32) -> bool {
        way > self.distance && way > self.speed * dt
    }
}

/// What has been put elsewhere, and since which step. It counts once for each pass.
#[derive(Resource, Debug, Default)]
pub(crate) struct Teleported(HashMap<Entity, StepNumber, FixedHasher>);

impl Teleported {
    /// An entity has been put elsewhere since `step`, or is about to be.
    pub fn insert(&mut self, entity: Entity, step: StepNumber) {
        self.0.insert(entity, step);
    }

    /// Whether an entity has been put elsewhere between the step before `step`, of the same pass, and that one.
    pub fn contains(&self, entity: Entity, step: StepNumber) -> bool {
        self.0.get(&entity).is_some_and(|since| since.is_since_step_before(step))
    }

    /// Whether an entity has been put elsewhere within the latest two steps: a physics engine may come to know of it a step late.
    #[cfg(any(feature = "avian", feature = "rapier"))]
    pub fn contains_lately(&self, entity: Entity, step: StepNumber) -> bool {
        self.0.get(&entity).is_some_and(|since| since.is_since_two_steps_before(step))
    }
}

/// Forgets teleports that are done.
pub(crate) fn forget_teleports(mut teleported: ResMut<Teleported>, steps: Res<Steps>) {
    if !teleported.0.is_empty() {
        let is_known =
            |since: &StepNumber| Pass::BOTH.iter().any(|&pass| since.is_since_two_steps_before(steps.latest_of(pass)));
        teleported.0.retain(|_, since| is_known(since));
    }
}

/// Tells ways from jumps.
#[derive(SystemParam)]
pub(crate) struct JumpDetection<'w> {
    steps: Res<'w, Steps>,
    time: Res<'w, Time>,
    pub teleported: Res<'w, Teleported>,
    pub threshold: Res<'w, ColliderTeleportThreshold>,
}

/// Where an obstacle was at the end of the latest step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum PastPose {
    /// There, and it has moved since.
    Known(Isometry3d),
    /// Nowhere, or it has been teleported since.
    Unknown,
    /// Farther away than any motion goes.
    TooFar,
}

impl JumpDetection<'_> {
    /// Where an obstacle was that is at `pose` by now, with the poses that are remembered of it.
    pub fn past_pose(
        &self,
        entity: Entity,
        memory: &PerPass<FromLatestStep<Isometry3d>>,
        pose: &Isometry3d,
    ) -> PastPose {
        match memory[self.pass()].get(self.step()) {
            Some(past) if !self.is_teleported(entity) => {
                let way = past.translation.distance(pose.translation);
                let is_jump = self.threshold.is_exceeded(way, self.time.delta_secs());
                if is_jump { PastPose::TooFar } else { PastPose::Known(past) }
            }
            _ => PastPose::Unknown,
        }
    }

    /// Whether an entity has been teleported since the latest step.
    pub fn is_teleported(&self, entity: Entity) -> bool {
        self.teleported.contains(entity, self.step())
    }

    /// The present step.
    pub fn step(&self) -> StepNumber {
        self.steps.present()
    }

    /// The pass that it is of.
    pub fn pass(&self) -> Pass {
        self.steps.pass()
    }

    /// Duration of the present step, s.
    #[cfg(any(feature = "avian", feature = "rapier"))]
    pub fn dt(&self) -> f32 {
        self.time.delta_secs()
    }
}

/// A rigid motion from one place to another: what a jump of its entity does to a cloth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Jump {
    from: Vec3A,
    to: Vec3A,
    turn: Quat,
}

impl Jump {
    /// Makes the motion that takes the pose `from` to the pose `to`, but for their scales, which the springs' lengths don't follow.
    /// None where one of them is flat.
    pub fn between(from: Affine3A, to: Affine3A) -> Option<Self> {
        if !is_invertible(&from) || !is_invertible(&to) {
            return None;
        }
        let turn = Affine3A { matrix3: to.matrix3 * from.matrix3.inverse(), translation: Vec3A::ZERO };
        let (_, turn, _) = turn.to_scale_rotation_translation();
        Some(Self { from: from.translation, to: to.translation, turn: turn.normalize() })
    }

    /// Makes the motion that turns about `from` and takes it to `to`.
    pub fn rigid(from: Vec3A, to: Vec3A, turn: Quat) -> Self {
        Self { from, to, turn }
    }

    /// Where it takes a place that is given relative to `origin` (both m), relative to [`end`](Self::end).
    ///
    /// Differences first: far from the world's origin, only they have precision left.
    pub fn place(&self, place: Vec3A, origin: Vec3A) -> Vec3A {
        self.turn * (place + (origin - self.from))
    }

    /// Which way it turns a direction.
    pub fn direction(&self, direction: Vec3A) -> Vec3A {
        self.turn * direction
    }

    /// Where it ends, m.
    pub fn end(&self) -> Vec3A {
        self.to
    }

    /// Where an obstacle that went from `start` to `end` comes from for a cloth that has jumped: from where the jump has
    /// taken it, if that is nearer to its end. It then has jumped along.
    pub fn start_of(&self, start: Isometry3d, end: &Isometry3d) -> Isometry3d {
        let carried = Isometry3d::new(self.place(start.translation, Vec3A::ZERO) + self.to, self.turn * start.rotation);
        let from_end = |pose: &Isometry3d| {
            // A turn counts as the way of a place half a metre beside, about.
            let turn = 1.0 - pose.rotation.dot(end.rotation).powi(2);
            pose.translation.distance_squared(end.translation) + turn
        };
        if from_end(&carried) < from_end(&start) { carried } else { start }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn jump() -> Jump {
        let to =
            Transform::from_xyz(500.0, 1.0, 0.0).with_rotation(Quat::from_rotation_y(1.0)).with_scale(Vec3::splat(2.0));
        Jump::between(Transform::from_xyz(0.0, 1.0, 2.0).compute_affine(), to.compute_affine()).unwrap()
    }

    #[test]
    fn a_jump_turns_about_where_it_begins_and_scales_nothing() {
        let beside = jump().place(Vec3A::new(0.0, 1.0, 1.0), Vec3A::Z * 2.0);
        let expected = Quat::from_rotation_y(1.0) * Vec3A::Z;
        assert!(beside.distance(expected) < 1e-6, "{beside}");
        let flat = Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0));
        assert_eq!(Jump::between(flat, Affine3A::IDENTITY), None);
    }

    #[test]
    fn what_has_jumped_along_comes_from_where_it_was_beside_the_cloth() {
        let start = Isometry3d::from_translation(Vec3::new(0.0, 1.0, 3.0));
        let carried = jump().start_of(start, &Isometry3d::from_translation(Vec3::new(500.5, 1.0, 0.5)));
        assert!((carried.translation - Vec3A::X * 500.0).length() < 1.5, "{carried:?}");
        let nearby = Isometry3d::from_translation(Vec3::new(0.1, 1.0, 3.0));
        assert_eq!(jump().start_of(start, &nearby), start, "what stays has a way of its own");
    }

    #[test]
    fn only_what_is_far_and_fast_is_taken_for_a_jump() {
        let threshold = ColliderTeleportThreshold::default();
        assert!(threshold.is_exceeded(1.1, 1.0 / 60.0));
        assert!(!threshold.is_exceeded(0.9, 1e-3), "fast, but not far");
        assert!(!threshold.is_exceeded(5.0, 0.1), "far, but not fast");
        let never = ColliderTeleportThreshold { distance: f32::INFINITY, ..threshold };
        assert!(!never.is_exceeded(1e9, 1e-3));
    }
}
