//! Cloth between the bodies of physics engines: one module per behaviour, most of them with each engine.

#![cfg(all(feature = "avian", feature = "rapier"))]

#[path = "../behaviour/common.rs"]
#[allow(dead_code, reason = "shared with another target")]
mod common;
mod engine;

mod bodies;
mod filters;
mod jumps;
mod missing_engines;
mod places;
