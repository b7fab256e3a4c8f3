//! Where bodies were, and what it takes to move them.

use bevy::{
    math::{Isometry3d, Mat3A, Vec3A},
    platform::{collections::HashMap, hash::FixedHasher},
    prelude::*,
};

use crate::{
    frame::{ColliderTeleportThreshold, StepNumber, Teleported},
    solver::Body,
};

/// A body, or a collider of its own, as an engine has left it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BodyPose {
    /// Its pose now.
    pub pose: Isometry3d,
    /// What is known of it if only forces move it, and none its user.
    pub dynamic: Option<Dynamic>,
}

/// A body that forces move.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dynamic {
    /// Velocity of its centre of mass, m/s.
    pub velocity: Vec3,
    /// Inverse mass, 1/kg.
    pub inverse_mass: f32,
    /// Inverse of the tensor of inertia about its centre of mass, along the world's axes, 1/(kg m²).
    pub inverse_inertia: Mat3A,
    /// Centre of mass in its own frame, m.
    pub centre: Vec3A,
}

/// The motion of a body over the coming step, from one pose to another.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BodyMotion {
    pub start: Isometry3d,
    pub end: Isometry3d,
    /// What it takes to move it.
    pub body: Option<Body>,
}

/// Bodies as the latest step of cloth has left them.
#[derive(Debug, Default)]
pub(crate) struct Bodies {
    known: HashMap<Entity, Past, FixedHasher>,
    step: Step,
}

/// A step, and what has jumped before it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Step {
    pub number: StepNumber,
    /// Duration, s.
    pub dt: f32,
    pub threshold: ColliderTeleportThreshold,
}

#[derive(Clone, Copy, Debug)]
struct Past {
    start: Isometry3d,
    end: Isometry3d,
    speed: f32,
    /// The step that it belongs to.
    step: StepNumber,
}

/// A body that forces move may come this much farther within a step than its velocity says, m: engines push bodies out of
/// each other. One that comes farther has been put somewhere else, and sweeps nothing on its way.
const UNEXPLAINED: f32 = 0.1;

impl Bodies {
    /// Begins another step, and forgets the bodies that the latest hasn't seen, and those that have been `teleported`.
    pub fn begin(&mut self, step: Step, teleported: &Teleported) {
        let latest = self.step.number;
        self.known.retain(|&entity, past| past.step == latest && !teleported.contains_lately(entity, step.number));
        self.step = step;
    }

    /// The motion of a body from where the latest step has left it to where it is now.
    pub fn motion(&mut self, entity: Entity, body_pose: &BodyPose) -> BodyMotion {
        let BodyPose { pose: end, dynamic } = *body_pose;
        let speed = dynamic.map_or(0.0, |dynamic| dynamic.velocity.length());
        let Step { number: step, dt, threshold } = self.step;
        let past = self.known.get(&entity).copied();
        let start = match past {
            // Of another collider of the same body.
            Some(past) if past.step == step => past.start,
            Some(past) => {
                let way = past.end.translation.distance(end.translation);
                let is_put = match dynamic {
                    Some(_) => way > 2.0 * dt * speed.max(past.speed) + UNEXPLAINED,
                    None => threshold.is_exceeded(way, dt),
                };
                if is_put { end } else { past.end }
            }
            // It wasn't there.
            None => end,
        };
        if past.is_none_or(|past| past.step != step) {
            self.known.insert(entity, Past { start, end, speed, step });
        }
        let body = dynamic.filter(|dynamic| dynamic.inverse_mass > 0.0).map(|dynamic| Body {
            inverse_mass: dynamic.inverse_mass,
            inverse_inertia: dynamic.inverse_inertia,
            centre: start * dynamic.centre,
        });
        BodyMotion { start, end, body }
    }

    /// Cloth has moved a body to this pose, at this velocity (m/s).
    pub fn moved(&mut self, entity: Entity, pose: Isometry3d, velocity: Vec3) {
        if let Some(past) = self.known.get_mut(&entity) {
            (past.end, past.speed) = (pose, velocity.length());
        }
    }

    /// The world has been shifted, and all bodies with it.
    pub fn shift(&mut self, by: Vec3) {
        for past in self.known.values_mut() {
            past.start.translation += Vec3A::from(by);
            past.end.translation += Vec3A::from(by);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f32, speed: f32) -> BodyPose {
        let dynamic = Dynamic {
            velocity: Vec3::X * speed,
            inverse_mass: 0.5,
            inverse_inertia: Mat3A::IDENTITY,
            centre: Vec3A::Y,
        };
        BodyPose { pose: Isometry3d::from_translation(Vec3::X * x), dynamic: Some(dynamic) }
    }

    fn begin(bodies: &mut Bodies, teleported: &Teleported) {
        let number = bodies.step.number.next();
        bodies.begin(Step { number, dt: 0.1, ..default() }, teleported);
    }

    fn start_of(bodies: &mut Bodies, body_pose: &BodyPose) -> f32 {
        begin(bodies, &Teleported::default());
        bodies.motion(Entity::PLACEHOLDER, body_pose).start.translation.x
    }

    #[test]
    fn a_body_comes_from_where_the_latest_step_left_it() {
        let mut bodies = Bodies::default();
        assert_eq!(start_of(&mut bodies, &at(1.0, 5.0)), 1.0);
        assert_eq!(start_of(&mut bodies, &at(1.5, 5.0)), 1.0);
        bodies.moved(Entity::PLACEHOLDER, Isometry3d::from_translation(Vec3::X * 1.6), Vec3::X * 6.0);
        assert_eq!(start_of(&mut bodies, &at(2.1, 5.0)), 1.6);
    }

    #[test]
    fn a_body_that_is_put_elsewhere_sweeps_nothing() {
        let mut bodies = Bodies::default();
        start_of(&mut bodies, &at(0.0, 5.0));
        assert_eq!(start_of(&mut bodies, &at(3.0, 5.0)), 3.0);
        let led = |x: f32| BodyPose { dynamic: None, ..at(x, 0.0) };
        assert_eq!(start_of(&mut bodies, &led(8.5)), 3.0, "one that its user moves does sweep");
        assert_eq!(start_of(&mut bodies, &led(15.0)), 15.0, "but not as fast as nothing moves");
    }

    #[test]
    fn a_body_that_is_teleported_sweeps_nothing_though_its_engine_moves_it_a_step_late() {
        let mut bodies = Bodies::default();
        start_of(&mut bodies, &at(0.0, 5.0));
        let mut teleported = Teleported::default();
        teleported.insert(Entity::PLACEHOLDER, bodies.step.number);
        for x in [0.0, 0.4] {
            begin(&mut bodies, &teleported);
            assert_eq!(bodies.motion(Entity::PLACEHOLDER, &at(x, 5.0)).start.translation.x, x);
        }
        assert_eq!(start_of(&mut bodies, &at(0.8, 5.0)), 0.4);
    }

    #[test]
    fn a_body_goes_along_with_a_shifted_world() {
        let mut bodies = Bodies::default();
        start_of(&mut bodies, &at(0.0, 5.0));
        bodies.shift(Vec3::X * 100.0);
        assert_eq!(start_of(&mut bodies, &at(100.2, 5.0)), 100.0);
    }

    #[test]
    fn a_body_that_was_away_comes_out_of_nowhere() {
        let mut bodies = Bodies::default();
        start_of(&mut bodies, &at(0.0, 5.0));
        begin(&mut bodies, &Teleported::default());
        assert_eq!(start_of(&mut bodies, &at(0.2, 5.0)), 0.2);
    }

    #[test]
    fn the_centre_of_mass_is_that_at_the_start() {
        let mut bodies = Bodies::default();
        start_of(&mut bodies, &at(1.0, 5.0));
        begin(&mut bodies, &Teleported::default());
        let motion = bodies.motion(Entity::PLACEHOLDER, &at(1.5, 5.0));
        assert_eq!(motion.body.map(|body| body.centre), Some(Vec3A::new(1.0, 1.0, 0.0)));
    }
}
