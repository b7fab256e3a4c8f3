//! What an obstacle is: solids with a signed distance, triangle meshes, and what is sharp about them.

pub mod mesh;
pub(crate) mod sharp_features;
pub mod solid;

pub use crate::shape::{
    mesh::{DeformedPoints, MeshShape, TriangleMesh},
    solid::{Ellipsoid, Solid, TaperedCapsule},
};

/// The shape of an obstacle, m, in its own frame.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// One whose signed distance has a formula.
    Solid(Solid),
    /// Triangles.
    Mesh(MeshShape),
}

impl From<Solid> for Shape {
    fn from(solid: Solid) -> Self {
        Self::Solid(solid)
    }
}
