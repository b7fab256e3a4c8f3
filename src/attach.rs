//! What holds cloth: pins that follow their targets, skeletons that wear it, and hands.

pub(crate) mod grabs;
pub(crate) mod pins;
mod skeleton;
