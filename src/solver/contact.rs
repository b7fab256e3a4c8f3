//! Contact: particles stay outside of obstacles, slide on them with friction, and let go without sticking.
//!
//! Particles are projected once a substep, as its last act, so that none ends a step inside an obstacle; where obstacles
//! overlap or pinch the cloth, the last one has its way. Friction is
//! Coulomb's at the level of positions: the way along the surface is cut by at most `friction` times the way that the
//! contact pushed (Müller et al., "Position Based Dynamics", 2007, section 3.6, with the normal push in place of a
//! damping constant). There is no restitution.

use bevy::math::{Isometry3d, Mat3A, Quat, Vec3A};

pub mod mesh;
pub mod solid;

mod body;
mod closest;
mod course;
mod faces;
mod inside;
mod near;
mod number;
pub(super) mod outline;
pub(super) mod pair;
mod project;
mod search;
pub(super) mod surface;
mod sweep;
pub(super) mod tangle;
pub(super) mod touch;

pub(super) use body::Bodies;
pub(super) use faces::MeshContacts;
pub use mesh::MeshShape;
pub(super) use near::{BroadPhase, near_obstacles};
pub(super) use project::project;
pub use solid::{Solid, SurfacePoint};

/// The shape of an obstacle, m, in its own frame.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// One whose signed distance has a formula.
    Solid(Solid),
    /// Triangles.
    Mesh(MeshShape),
}

impl From<Solid> for Shape {
    fn from(solid: Solid) -> Self {
        Self::Solid(solid)
    }
}

/// What it takes to move an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Inverse mass, 1/kg.
    pub inverse_mass: f32,
    /// Inverse of the tensor of inertia about the centre of mass, along the world's axes, 1/(kg m²).
    pub inverse_inertia: Mat3A,
    /// Centre of mass at the start of the step, m, relative to the cloth's origin.
    pub centre: Vec3A,
}

/// What a cloth has given to a body within a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyImpulse {
    /// Momentum, N s.
    pub linear: Vec3A,
    /// Angular momentum about the body's centre of mass, N m s.
    pub angular: Vec3A,
}

/// How far a body has come off its given path by what a cloth has given to it within a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyDisplacement {
    /// Way of its centre of mass, m.
    pub shift: Vec3A,
    /// Turn about it.
    pub turn: Quat,
}

impl Default for BodyDisplacement {
    fn default() -> Self {
        Self { shift: Vec3A::ZERO, turn: Quat::IDENTITY }
    }
}

/// Something that cloth can't enter, on its way over one step.
#[derive(Clone, Debug, PartialEq)]
pub struct Obstacle {
    /// Its shape.
    pub shape: Shape,
    /// Where it is when the step starts, m, relative to the cloth's origin.
    pub start: Isometry3d,
    /// Where it is when the step ends.
    pub end: Isometry3d,
    /// By how much it is larger than its shape all around, m.
    pub rounding: f32,
    /// Factor on the cloth's friction, no unit.
    pub friction: f32,
    /// What it takes to move it. None for what no cloth moves.
    pub body: Option<Body>,
}

impl Obstacle {
    /// One that stays where it is, which no cloth moves.
    pub fn still(shape: impl Into<Shape>, pose: Isometry3d) -> Self {
        Self::moving(shape, pose, pose)
    }

    /// One that goes from `start` to `end`, which no cloth moves.
    pub fn moving(shape: impl Into<Shape>, start: Isometry3d, end: Isometry3d) -> Self {
        Self { shape: shape.into(), start, end, rounding: 0.0, friction: 1.0, body: None }
    }

    /// Pose at the fraction `t` (0..=1) of the step.
    fn pose(&self, t: f32) -> Isometry3d {
        if self.start == self.end {
            return self.end;
        }
        Isometry3d::new(
            self.start.translation.lerp(self.end.translation, t),
            // Normalised linear interpolation: no transcendental function, and exact enough within a step.
            self.start.rotation.lerp(self.end.rotation, t),
        )
    }
}
