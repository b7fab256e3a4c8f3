//! What holds particles together: each constraint moves positions, once a substep.

pub(super) mod anchor;
pub(super) mod beads;
pub(super) mod bend;
pub(super) mod bias;
pub(super) mod braid;
pub(super) mod curvature;
#[cfg(test)]
mod dense;
pub(super) mod diagonal;
pub(super) mod face;
pub mod grab;
pub(super) mod law;
pub(super) mod level;
pub(super) mod loose;
pub mod mount;
pub(super) mod plate;
pub mod spring;
pub(super) mod strand;
pub mod tether;
pub(super) mod weave;
pub(super) mod yarn;
