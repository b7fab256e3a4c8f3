//! Reads meshes: their geometry, and what is worked out of it in tasks beside the frames.

mod grid;
mod job;
mod source;

pub use grid::ClothGrid;
pub(crate) use job::Jobs;
pub use source::ATTRIBUTE_WARP;
pub(crate) use source::{read, read_uvs};
