//! How particles lie in memory: blocks of eight, component by component, for SIMD.

pub(crate) mod gathered;
pub(crate) mod lanes;
pub(crate) mod number;
pub(crate) mod order;
pub mod simd;
