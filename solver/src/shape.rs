//! What an obstacle is: solids with a signed distance, triangle meshes, and what is sharp about them.

use std::sync::Arc;

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

impl Shape {
    /// Whether nothing moves within its frame over the step.
    pub(crate) fn is_still(&self) -> bool {
        match self {
            Self::Mesh(MeshShape { deformed: Some(points), .. }) => points.ends[0] == points.ends[1],
            Self::Mesh(_) | Self::Solid(_) => true,
        }
    }

    /// Whether it ends the step like another: the same solid, or the very same mesh with its points where they were.
    pub(crate) fn ends_like(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Solid(one), Self::Solid(other)) => one == other,
            (Self::Mesh(one), Self::Mesh(other)) => {
                let points = |shape: &MeshShape| shape.deformed.as_ref().map(|points| points.ends[1].clone());
                Arc::ptr_eq(&one.mesh, &other.mesh) && points(one) == points(other)
            }
            _ => false,
        }
    }
}

impl From<Solid> for Shape {
    fn from(solid: Solid) -> Self {
        Self::Solid(solid)
    }
}
