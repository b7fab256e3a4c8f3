//! What the bridges to physics engines have in common: their colliders become obstacles, and their bodies get back the
//! momentum that cloth gives them.

use std::sync::Arc;

use bevy::{math::Isometry3d, prelude::*};

use crate::{frame::JumpDetection, solver::Obstacle, surroundings::collider::Obstacles};

#[cfg(feature = "avian")]
pub(crate) mod avian;
mod bodies;
mod body_attachments;
mod parts;
mod pushes;
#[cfg(feature = "rapier")]
pub(crate) mod rapier;
mod schedule;

use bodies::Step;
pub(crate) use bodies::{Bodies, BodyPose, Dynamic};
pub(crate) use body_attachments::{attach_pins, note_anchors, untie_attached};
pub(crate) use parts::{Part, Shapes, capsule, mesh};
pub(crate) use pushes::{Pushes, carry, collect_pushes, strayed};

/// Takes a collider of a physics engine, or all of a rigid body's, out of what cloth meets. A collider with a
/// [`ClothCollider`](crate::prelude::ClothCollider) of its own doesn't need it: that one counts instead.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Default, Debug, Clone, PartialEq)]
pub struct NotClothCollider;

/// The engines, in the order in which cloth meets their colliders.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Engine {
    Avian,
    Rapier,
}

/// The friction that engines give to colliders by default, no unit. It is what a factor of 1 on a cloth's own stands for.
const USUAL_FRICTION: f32 = 0.5;

/// Factor on the friction of cloth, given an engine's coefficient of a collider.
pub(crate) fn friction_factor(coefficient: f32) -> f32 {
    let factor = coefficient / USUAL_FRICTION;
    if factor.is_finite() { factor.max(0.0) } else { 1.0 }
}

/// What a bridge remembers from step to step. `S` is the engine's shared shape.
#[derive(Resource, Debug)]
pub(crate) struct Bridge<S: Send + Sync + 'static> {
    pub shapes: Shapes<S>,
    pub bodies: Bodies,
    colliders: Vec<EngineCollider>,
}

/// A collider that cloth may meet.
#[derive(Debug)]
pub(crate) struct EngineCollider {
    pub collider: Entity,
    /// Layers that it is in, one a bit.
    pub layers: u32,
    /// Factor on the cloth's friction, no unit.
    pub friction: f32,
    /// The body that it belongs to, or itself.
    pub body: Entity,
    pub body_pose: BodyPose,
    /// Where it is in the body's frame.
    pub place: Isometry3d,
    pub parts: Arc<[Part]>,
}

impl<S: Send + Sync + 'static> Default for Bridge<S> {
    fn default() -> Self {
        Self { shapes: Shapes::default(), bodies: Bodies::default(), colliders: Vec::new() }
    }
}

impl<S: Clone + Send + Sync + 'static> Bridge<S> {
    /// Begins a step.
    pub fn begin(&mut self, jumps: &JumpDetection) {
        self.shapes.begin();
        let step = Step { number: jumps.step(), dt: jumps.dt(), threshold: *jumps.threshold };
        self.bodies.begin(step, &jumps.teleported);
        self.colliders.clear();
    }

    pub fn add(&mut self, collider: EngineCollider) {
        self.colliders.push(collider);
    }

    /// Adds all that cloth may meet to the obstacles, in the order of the colliders.
    pub fn end(&mut self, obstacles: &mut Obstacles) {
        self.colliders.sort_unstable_by_key(|it| it.collider);
        for EngineCollider { collider, layers, friction, body, body_pose, place, parts } in self.colliders.drain(..) {
            let motion = self.bodies.motion(body, &body_pose);
            let (start, end) = (motion.start * place, motion.end * place);
            let is_finite = |pose: &Isometry3d| pose.translation.is_finite() && pose.rotation.is_finite();
            if !is_finite(&start) || !is_finite(&end) {
                continue;
            }
            obstacles.list.extend(parts.iter().map(|Part { shape, pose, rounding }| {
                let obstacle = Obstacle {
                    shape: shape.clone(),
                    start: start * *pose,
                    end: end * *pose,
                    rounding: *rounding,
                    friction,
                    body: motion.body,
                    is_rough: false,
                };
                (collider, layers, obstacle)
            }));
        }
        self.shapes.end();
    }
}
