//! Shares one large cloth between threads.

pub(crate) mod grid_substep;
pub(crate) mod phases;
