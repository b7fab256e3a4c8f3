//! What pins follow, and its motion over the latest step.

use bevy::{math::Affine3A, prelude::*};

use crate::{
    frame::{Jump, Poses, StepNumber, is_invertible},
    pins::PinTarget,
};

/// What some pins of a cloth follow, and its motion over the latest step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PinAnchor {
    /// What the pins say that they follow.
    pub target: PinTarget,
    /// The entity that this is. None for the world.
    pub entity: Option<Entity>,
    /// Its pose when the step began.
    pub start: Affine3A,
    /// Its pose when the step ended: the latest that is known.
    pub end: Affine3A,
    /// Pose that it has come from by a jump.
    jumped_from: Option<Affine3A>,
    /// Whether it has a pose that can be followed.
    is_there: bool,
    /// The latest step in which it had one.
    seen: Option<StepNumber>,
}

impl PinAnchor {
    /// What the pins of a cloth follow that are fixed to `target`.
    pub fn new(target: PinTarget, cloth: Entity, poses: &Poses) -> Self {
        let pose = target_pose(target, cloth, poses);
        Self {
            target,
            entity: target_entity(target, cloth),
            start: pose.unwrap_or_default(),
            end: pose.unwrap_or_default(),
            jumped_from: None,
            is_there: pose.is_some(),
            seen: pose.map(|_| poses.step()),
        }
    }

    /// Follows the target over the coming step. One that has been teleported, or was gone in the latest step, has jumped.
    pub fn follow(&mut self, cloth: Entity, poses: &Poses) {
        let (pose, step) = (target_pose(self.target, cloth, poses), poses.step());
        let was_there = self.seen.is_some_and(|seen| seen.is_since_step_before(step));
        let is_put = !was_there || self.entity.is_some_and(|entity| poses.is_teleported(entity));
        self.is_there = pose.is_some();
        self.jumped_from = pose.and(self.seen).filter(|_| is_put).map(|_| self.end);
        let end = pose.unwrap_or(self.end);
        self.start = if is_put { end } else { self.end };
        self.end = end;
        self.seen = pose.map(|_| step).or(self.seen);
    }

    /// The cloth steps in another pass from now on, whose latest step may be older than this one's: with the anchor still in
    /// sight where it was in the `latest` step of the old one, `now` it is as if it had been seen just before.
    pub fn change_pass(&mut self, latest: StepNumber, now: StepNumber) {
        self.seen = self.seen.map(|seen| if seen.is_since(latest) { now } else { seen });
        self.start = self.end;
    }

    /// The cloth has jumped by itself: nothing has a way that it would be pulled along.
    pub fn forget_way(&mut self) {
        (self.start, self.jumped_from) = (self.end, None);
    }

    /// Its pose by now, if it can be followed.
    pub fn pose(&self) -> Option<Affine3A> {
        self.is_there.then_some(self.end)
    }

    /// Whether it has jumped since the latest step.
    pub fn has_jumped(&self) -> bool {
        self.jumped_from.is_some()
    }

    /// The jump that it has made since the latest step.
    fn jump(&self) -> Option<Jump> {
        Jump::between(self.jumped_from?, self.end)
    }

    /// The jump of a cloth all of whose anchors have jumped: the first anchor's.
    pub fn common_jump(anchors: &[Self]) -> Option<Jump> {
        anchors.iter().all(Self::has_jumped).then(|| anchors.first()?.jump()).flatten()
    }

    /// The world has been shifted, and its entities with it.
    pub fn shift(&mut self, by: Vec3) {
        if self.entity.is_some() {
            for pose in [&mut self.start, &mut self.end] {
                pose.translation += bevy::math::Vec3A::from(by);
            }
        }
    }
}

/// The entity that a target's pins follow.
pub(crate) fn target_entity(target: PinTarget, cloth: Entity) -> Option<Entity> {
    match target {
        PinTarget::Cloth => Some(cloth),
        PinTarget::Entity(entity) => entity,
        PinTarget::World | PinTarget::Free => None,
    }
}

/// The pose that a target's pins follow. None for the world, an entity that is gone, and a transform that is flat.
fn target_pose(target: PinTarget, cloth: Entity, poses: &Poses) -> Option<Affine3A> {
    let pose = poses.compute_global_transform(target_entity(target, cloth)?).ok()?.affine();
    is_invertible(&pose).then_some(pose)
}
