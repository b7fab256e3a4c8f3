//! What surrounds cloth: obstacles, winds and gravity.

pub(crate) mod body;
pub(crate) mod collider;
mod gravity;
pub(crate) mod wind;

pub use gravity::ClothGravity;
