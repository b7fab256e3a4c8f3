//! Rigid bodies that cloth pushes and pulls, as a step takes them and gives them back.

use bevy_math::{Mat3A, Quat, Vec3A};

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
    /// Displacement of its centre of mass, m.
    pub shift: Vec3A,
    /// Rotation about it.
    pub turn: Quat,
}

impl Default for BodyDisplacement {
    fn default() -> Self {
        Self { shift: Vec3A::ZERO, turn: Quat::IDENTITY }
    }
}

/// A body that pins are fixed to, and how it moves over one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyAttachment {
    /// What it takes to move it.
    pub body: Body,
    /// Displacement of its centre of mass over the step if the cloth didn't pull, m.
    pub displacement: Vec3A,
}

/// A pin that is fixed to a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AttachedPin {
    /// Number of the pin in [`crate::input::StepContext::pin_motions`].
    pub pin_motion: u32,
    /// Number of the body in [`crate::input::StepContext::body_attachments`].
    pub attachment: u32,
}
