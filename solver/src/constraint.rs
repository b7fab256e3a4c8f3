//! What holds particles together: each constraint moves positions, once a substep.

pub mod attach;
pub(crate) mod implicit;
pub(crate) mod multigrid;
pub(crate) mod strand;
pub mod unstructured;
