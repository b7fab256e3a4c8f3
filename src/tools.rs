//! What shows cloth and lets people touch it: the panel, the debug view, pointers.

#[cfg(feature = "debug")]
pub mod debug;
#[cfg(feature = "panel")]
pub mod panel;
#[cfg(feature = "picking")]
pub mod picking;
