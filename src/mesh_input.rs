//! Reads meshes: their geometry, and what is worked out of it in tasks beside the frames.

mod grid;
mod job;
mod join;
mod skin;
mod source;

pub use grid::ClothGrid;
pub(crate) use job::Jobs;
pub(crate) use join::{Joined, Span, join, transform};
pub(crate) use skin::{Skin, follows, is_skinned};
pub use source::ATTRIBUTE_WARP;
pub(crate) use source::{read, read_uvs};
