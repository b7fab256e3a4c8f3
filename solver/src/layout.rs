//! How particles lie in memory: blocks of eight, component by component, for SIMD.

pub(crate) mod number;
pub(crate) mod order;
pub(crate) mod points;
pub mod simd;
