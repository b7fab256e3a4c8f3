//! Bodies that cloth pushes: within a step they leave the path that they were given.
//!
//! A body takes part in contact as particles do: a correction that asks for the way C along n is divided by inverse masses,
//!
//! lambda = C / (w + w_b),  w_b = 1 / m + (r x n) · I⁻¹ (r x n)
//!
//! (Müller et al., "Detailed Rigid Body Simulation with Extended Position Based Dynamics", 2020, section 3.3.1), and what the
//! one gets the other gives. r leads from the centre of mass to the particle, not to the surface, which the cloth's
//! thickness lies between: both are pushed at the same place, so angular momentum is conserved too.

use core::ops::Range;

use bevy_math::{Isometry3d, Mat3A, Quat, Vec3A};

use crate::input::{BodyDisplacement, BodyImpulse, Obstacle, StepContext};

/// What bodies do within a step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bodies {
    /// Of each obstacle that is one.
    moved: Vec<Option<MovedBody>>,
    /// What each obstacle was given.
    pub impulses: Vec<BodyImpulse>,
    /// How far each has come off its path.
    pub displacements: Vec<BodyDisplacement>,
}

/// A body within a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MovedBody {
    /// Inverse mass, 1/kg.
    pub inverse_mass: f32,
    /// Inverse of the tensor of inertia along the world's axes, as it is turned now, 1/(kg m²).
    pub inverse_inertia: Mat3A,
    /// Centre of mass now, m.
    pub centre: Vec3A,
    /// Pose at the start of the substep.
    pub start: Isometry3d,
    /// Pose at its end.
    pub end: Isometry3d,
    /// Pose at the end of the substep, of the path.
    path: Isometry3d,
    /// Centre of mass in the obstacle's own frame, m.
    local_centre: Vec3A,
    /// Velocity and spin beside those of the path, m/s and rad/s.
    velocity: Vec3A,
    spin: Vec3A,
    /// Way and turn beside the path.
    shift: Vec3A,
    turn: Quat,
    /// Duration of the substep, s.
    h: f32,
}

impl Bodies {
    /// Begins a step: all are on their paths.
    pub fn begin(&mut self, ctx: &StepContext) {
        let Self { moved, impulses, displacements } = self;
        moved.clear();
        moved.extend(ctx.obstacles.iter().map(MovedBody::new));
        impulses.clear();
        impulses.resize(moved.len(), BodyImpulse::default());
        displacements.clear();
        displacements.resize(moved.len(), BodyDisplacement::default());
    }

    /// Leads all bodies through the part `span` (0..=1) of the step, a substep of `h` seconds, as if they touched nothing.
    pub fn advance(&mut self, ctx: &StepContext, span: Range<f32>, h: f32) {
        for (i, (moved, obstacle)) in self.moved.iter_mut().zip(ctx.obstacles).enumerate() {
            if let Some(moved) = moved {
                moved.advance(obstacle, span.end, h);
                self.displacements[i] = moved.displacement();
            }
        }
    }

    /// The body that an obstacle is, if it is one.
    pub fn get(&self, obstacle: usize) -> Option<&MovedBody> {
        self.moved.get(obstacle)?.as_ref()
    }

    /// Whether any obstacle is a body.
    pub fn is_any(&self) -> bool {
        self.moved.iter().any(Option::is_some)
    }

    /// Poses of an obstacle at the start of a substep, and at the end of the part `span` of a step of `dt` seconds that begins
    /// with that substep, if nothing touches it.
    pub fn poses_ahead(&self, ctx: &StepContext, obstacle: usize, span: Range<f32>, dt: f32) -> [Isometry3d; 2] {
        let it = &ctx.obstacles[obstacle];
        match self.get(obstacle) {
            Some(moved) => [moved.start, moved.ahead(it, span, dt)],
            None => [span.start, span.end].map(|t| it.pose(t)),
        }
    }

    /// Poses of an obstacle at the start and at the end of the part `span` of the step.
    pub fn poses(&self, ctx: &StepContext, obstacle: usize, span: Range<f32>) -> [Isometry3d; 2] {
        match self.get(obstacle) {
            Some(moved) => [moved.start, moved.end],
            None => [span.start, span.end].map(|t| ctx.obstacles[obstacle].pose(t)),
        }
    }

    /// Pushes a body by what would move a mass in kg by a way in m within the substep: `linear` in kg m, and `angular`, about
    /// its centre of mass, in kg m². Nothing moves what is no body.
    pub fn push(&mut self, obstacle: usize, linear: Vec3A, angular: Vec3A) {
        if let Some(Some(moved)) = self.moved.get_mut(obstacle) {
            let (impulse, displacement) = (&mut self.impulses[obstacle], &mut self.displacements[obstacle]);
            moved.push(linear, angular);
            impulse.linear += linear / moved.h;
            impulse.angular += angular / moved.h;
            *displacement = moved.displacement();
        }
    }
}

impl MovedBody {
    fn new(obstacle: &Obstacle) -> Option<Self> {
        let body = obstacle.body?;
        Some(Self {
            inverse_mass: body.inverse_mass,
            inverse_inertia: body.inverse_inertia,
            centre: body.centre,
            start: obstacle.start,
            end: obstacle.start,
            path: obstacle.start,
            local_centre: obstacle.start.inverse().transform_point(body.centre),
            velocity: Vec3A::ZERO,
            spin: Vec3A::ZERO,
            shift: Vec3A::ZERO,
            turn: Quat::IDENTITY,
            h: 1.0,
        })
    }

    fn advance(&mut self, obstacle: &Obstacle, t: f32, h: f32) {
        self.start = self.end;
        self.path = obstacle.pose(t);
        self.h = h;
        self.shift += self.velocity * h;
        self.turn = turned(self.turn, self.spin * h);
        self.place();
        if let Some(body) = obstacle.body {
            let axes = Mat3A::from_quat(self.end.rotation * obstacle.start.rotation.inverse());
            self.inverse_inertia = axes * body.inverse_inertia * axes.transpose();
        }
    }

    /// Puts it where it is beside its path.
    fn place(&mut self) {
        self.centre = self.path.transform_point(self.local_centre) + self.shift;
        self.end = if self.turn == Quat::IDENTITY {
            Isometry3d { translation: self.path.translation + self.shift, ..self.path }
        } else {
            let rotation = self.turn * self.path.rotation;
            Isometry3d { rotation, translation: self.centre - rotation * self.local_centre }
        };
    }

    /// Pose at the end of a part of the step that begins with this substep.
    fn ahead(&self, obstacle: &Obstacle, span: Range<f32>, dt: f32) -> Isometry3d {
        let left = (span.end - span.start) * dt - self.h;
        let mut ahead = *self;
        ahead.path = obstacle.pose(span.end);
        ahead.shift += self.velocity * left;
        ahead.turn = turned(self.turn, self.spin * left);
        ahead.place();
        ahead.end
    }

    fn displacement(&self) -> BodyDisplacement {
        BodyDisplacement { shift: self.shift, turn: self.turn }
    }

    fn push(&mut self, linear: Vec3A, angular: Vec3A) {
        let (way, turn) = (linear * self.inverse_mass, self.inverse_inertia * angular);
        self.velocity += way / self.h;
        self.spin += turn / self.h;
        self.shift += way;
        self.turn = turned(self.turn, turn);
        self.place();
    }

    /// Inverse mass that a push along the unit vector `direction` meets at a place beside the centre of mass, 1/kg.
    pub fn inverse_mass_at(&self, beside: Vec3A, direction: Vec3A) -> f32 {
        let lever = beside.cross(direction);
        self.inverse_mass + lever.dot(self.inverse_inertia * lever)
    }
}

/// A rotation, turned further by a small rotation vector (rad).
fn turned(rotation: Quat, by: Vec3A) -> Quat {
    if by == Vec3A::ZERO {
        return rotation;
    }
    let half = by * 0.5;
    (rotation + Quat::from_xyzw(half.x, half.y, half.z, 0.0) * rotation).normalize()
}

#[cfg(test)]
mod tests {
    use bevy_math::primitives::Sphere;

    use super::*;
    use crate::{input::Body, shape::Solid};

    /// A body of 2 kg whose centre is beside its origin, and which goes along X.
    fn ball() -> Obstacle {
        let at = |x: f32| Isometry3d::from_translation(Vec3A::X * x);
        let body = Body {
            inverse_mass: 0.5,
            inverse_inertia: Mat3A::from_diagonal(bevy_math::Vec3::new(1.0, 2.0, 4.0)),
            centre: Vec3A::Y,
        };
        Obstacle { body: Some(body), ..Obstacle::moving(Solid::Sphere(Sphere::new(1.0)), at(0.0), at(0.5)) }
    }

    #[test]
    fn a_body_that_nobody_pushes_stays_on_its_path() {
        let mut moved = MovedBody::new(&ball()).unwrap();
        for i in 1..=4 {
            moved.advance(&ball(), i as f32 / 4.0, 0.1);
        }
        assert_eq!(moved.end, ball().end);
        assert_eq!(moved.centre, Vec3A::new(0.5, 1.0, 0.0));
    }

    #[test]
    fn a_body_goes_on_with_what_it_was_given() {
        let mut moved = MovedBody::new(&ball()).unwrap();
        moved.advance(&ball(), 0.5, 0.1);
        moved.push(Vec3A::Z * 0.02, Vec3A::ZERO);
        assert!((moved.shift.z - 0.01).abs() < 1e-7, "{}", moved.shift);
        moved.advance(&ball(), 1.0, 0.1);
        assert!((moved.end.translation - Vec3A::new(0.5, 0.0, 0.02)).length() < 1e-6, "{:?}", moved.end);
    }

    #[test]
    fn a_push_turns_a_body_about_its_centre_of_mass() {
        let mut moved = MovedBody::new(&ball()).unwrap();
        moved.advance(&ball(), 0.0, 0.1);
        moved.push(Vec3A::ZERO, Vec3A::Z * 1e-3);
        assert!((moved.centre - Vec3A::Y).length() < 1e-6);
        // What is 1 m below the centre goes by the angle along X.
        assert!((moved.end.translation.x - 4e-3).abs() < 1e-6, "{:?}", moved.end);
        let along = moved.inverse_mass_at(Vec3A::NEG_Y, Vec3A::X);
        assert!((along - 4.5).abs() < 1e-3, "{along}");
    }
}
