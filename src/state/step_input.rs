//! What a step of a cloth is given, and what it gives to bodies.

use bevy::prelude::*;

use super::Allowance;
use crate::{
    frame::{Jump, Pass},
    solver::{AttachedPin, BodyAttachment, BodyDisplacement, BodyImpulse, Grab, Obstacle, PinMotion, WindSource},
};

/// What has been gathered for the next step of a cloth: buffers that are filled anew each time.
#[derive(Component, Clone, Debug, Default)]
#[component(clone_behavior = Ignore)]
pub(crate) struct StepInput {
    /// In which pass of a frame the cloth steps.
    pub pass: Pass,
    pub pin_motions: Vec<PinMotion>,
    pub grabs: Vec<Grab>,
    pub obstacles: Vec<Obstacle>,
    /// Whose obstacle each is.
    pub owners: Vec<Entity>,
    /// Bodies that pins are fixed to, whose they are, and which pins are on which.
    pub body_attachments: Vec<BodyAttachment>,
    pub attachment_owners: Vec<Entity>,
    pub attached_pins: Vec<AttachedPin>,
    pub winds: Vec<WindSource>,
    /// The jump that the cloth has made before the step.
    pub jump: Option<Jump>,
    /// What its budget allows it.
    pub allowance: Allowance,
    /// What the bodies among all these have been given by the latest step.
    pub pushes: Vec<BodyPush>,
}

/// What a cloth has given to a body.
#[cfg_attr(not(any(feature = "avian", feature = "rapier")), expect(dead_code, reason = "physics engines read it"))]
#[derive(Clone, Copy, Debug)]
pub(crate) struct BodyPush {
    /// The body, or one of its colliders.
    pub to: Entity,
    pub impulse: BodyImpulse,
    /// How far it has come off its path by that.
    pub displacement: BodyDisplacement,
}
