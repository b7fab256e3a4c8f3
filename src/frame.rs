//! What a step knows of the app: its pass and number, where entities are by now, what has jumped there, and the threads to
//! work on.

mod clock;
mod parallel;
mod pass;
mod pose;
mod skeleton;
mod step;
mod teleport;

pub(crate) use clock::{ClothClock, ClothRun};
pub(crate) use parallel::{for_each, pool};
pub(crate) use pass::{Pass, PerPass};
pub(crate) use pose::{Poses, SCALE_ROUNDING, is_invertible};
pub(crate) use skeleton::{Skeletons, joint_matrices};
pub(crate) use step::{FromLatestStep, StepNumber, Steps, begin_fixed_step, begin_late_step};
pub use teleport::ColliderTeleportThreshold;
pub(crate) use teleport::{Jump, JumpDetection, PastPose, Teleported, forget_teleports};

/// How long scenes may take to come before what is missing of them is told of, s.
pub(crate) const PATIENCE: f32 = 5.0;
