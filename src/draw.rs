//! The state becomes pixels: interpolated particles, normals and tangents, the mesh.

pub(crate) mod binding;
pub(crate) mod carrier;
pub(crate) mod mesh;
pub(crate) mod shading;
pub(crate) mod skin;
