//! What holds particles together: each constraint moves positions, once a substep.

pub mod anchor;
pub mod grab;
pub mod spring;
pub mod tether;
