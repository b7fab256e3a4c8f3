//! Holds cloth to something else: pins, tethers, hands, bodies.

pub mod body;
pub mod grab;
pub(crate) mod pin_motion;
pub mod tether;
