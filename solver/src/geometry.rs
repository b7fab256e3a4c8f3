//! Finds what is close: the BVH over triangles, closest points, inside and outside.

pub(crate) mod bvh;
pub mod closest_point;
pub(crate) mod inside;
pub(crate) mod intersection;
