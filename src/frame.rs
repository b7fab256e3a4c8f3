//! What a step knows of the app: its number, where entities are by now, what has jumped there, and the threads to work on.

mod clock;
mod parallel;
mod pose;
mod skeleton;
mod teleport;

pub(crate) use clock::{ClothClock, ClothRun, FromLatestStep, StepNumber, count_steps};
pub(crate) use parallel::{for_each, pool};
pub(crate) use pose::{Poses, SCALE_ROUNDING, is_invertible};
pub(crate) use skeleton::{Skeletons, joint_matrices};
pub use teleport::ColliderTeleportThreshold;
pub(crate) use teleport::{Jump, JumpDetection, PastPose, Teleported, forget_teleports};
