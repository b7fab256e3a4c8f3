//! Holds cloth to something else: pins, tethers, hands, bodies, animated meshes.

pub mod body;
pub mod grab;
pub(crate) mod pin_motion;
pub mod skin;
pub mod tether;
