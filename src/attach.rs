//! What holds cloth: pins that follow their targets, and hands.

pub(crate) mod grabs;
pub(crate) mod pins;
