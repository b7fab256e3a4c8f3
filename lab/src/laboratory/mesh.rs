//! The pieces of cloth that are measured.

mod disc;
pub mod poisson;
mod strip;

pub use disc::disc;
pub use strip::Strip;

use bevy::{
    asset::RenderAssetUsages,
    math::DVec2,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};
use bevy_drape::prelude::ATTRIBUTE_WARP;

/// How a piece is made up of triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Rows and columns along the sides.
    Grid,
    /// Rows and columns at 45° to the sides, with half cells along these.
    Bias,
    /// No rows and columns.
    Delaunay,
}

impl Kind {
    pub fn name(self) -> &'static str {
        match self {
            Self::Grid => "grid",
            Self::Bias => "grid at 45°",
            Self::Delaunay => "delaunay",
        }
    }
}

/// A lying piece with vertices at `points`, X along X and Y along Z, whose warp runs along `warp`.
fn lying(points: &[DVec2], triangles: &[[u32; 3]], warp: Vec3) -> Mesh {
    let positions: Vec<Vec3> = points.iter().map(|p| Vec3::new(p.x as f32, 0.0, p.y as f32)).collect();
    let warp = vec![warp; points.len()];
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(ATTRIBUTE_WARP, warp)
        .with_inserted_indices(Indices::U32(triangles.as_flattened().to_vec()))
}
