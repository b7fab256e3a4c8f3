//! What cloths in tests are made of.

pub mod hand;
pub mod material;
pub mod mesh;
