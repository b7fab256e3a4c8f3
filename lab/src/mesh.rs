//! The meshes that the standard cloth can have: regular, irregular, closed around, or whatever a file holds.

use std::{
    fmt,
    path::{Path, PathBuf},
    str::FromStr,
};

use bevy::{
    asset::RenderAssetUsages,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};
use bevy_drape::prelude::ClothGrid;

mod delaunay;
mod ell;
mod file;
mod hex;
mod jitter;
mod skirt;
mod sleeve;

pub use jitter::jitter;

/// Where the mesh of a cloth comes from.
#[derive(Clone, Debug)]
pub enum MeshSource {
    Grid,
    Delaunay,
    Hex,
    Skirt,
    Ell,
    Sleeve,
    File(PathBuf),
}

impl FromStr for MeshSource {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        match name {
            "grid" => Ok(Self::Grid),
            "delaunay" => Ok(Self::Delaunay),
            "hex" => Ok(Self::Hex),
            "skirt" => Ok(Self::Skirt),
            "ell" => Ok(Self::Ell),
            "sleeve" => Ok(Self::Sleeve),
            _ if Path::new(name).extension().is_some_and(|extension| extension.eq_ignore_ascii_case("glb")) => {
                Ok(Self::File(name.into()))
            }
            _ => Err("it has to be grid, delaunay, hex, skirt, ell, sleeve, or a file that ends in .glb".into()),
        }
    }
}

impl fmt::Display for MeshSource {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Grid => f.write_str("grid"),
            Self::Delaunay => f.write_str("delaunay"),
            Self::Hex => f.write_str("hex"),
            Self::Skirt => f.write_str("skirt"),
            Self::Ell => f.write_str("ell"),
            Self::Sleeve => f.write_str("sleeve"),
            Self::File(path) => path.display().fmt(f),
        }
    }
}

/// A mesh and where its top is.
pub struct Sheet {
    /// Positions in m, and UVs if there are any.
    pub mesh: Mesh,
    pub top: Top,
}

/// What a hanging cloth is pinned by.
pub struct Top {
    /// Where the top is, in the axes of the mesh; of length 1.
    pub direction: Vec3,
    /// How deep the top is, as a share of the extent along `direction`.
    pub depth: f32,
    /// Whether it can't hang from two corners.
    pub is_ring: bool,
}

impl Top {
    /// Vertices that count as level with each other, as a share of the extent: more than rounding and less than any
    /// cell.
    const LEVEL: f32 = 1e-4;

    /// The edge at -Z of a lying square.
    const EDGE: Self = Self { direction: Vec3::NEG_Z, depth: Self::LEVEL, is_ring: false };

    /// Whether the cloth stands up at rest, instead of lying.
    pub fn stands(&self) -> bool {
        self.direction == Vec3::Y
    }

    /// How far below the top each of `places` is, as a share of the extent.
    pub fn depths(&self, places: &[Vec3]) -> Vec<f32> {
        let heights = || places.iter().map(|place| place.dot(self.direction));
        let (lowest, highest) = (heights().fold(f32::INFINITY, f32::min), heights().fold(f32::NEG_INFINITY, f32::max));
        let extent = (highest - lowest).max(f32::MIN_POSITIVE);
        heights().map(|height| (highest - height) / extent).collect()
    }
}

impl MeshSource {
    /// Makes or reads the mesh, with about `n` x `n` particles where it is made.
    ///
    /// # Errors
    ///
    /// Why a file can't be read, in one line that doesn't name it.
    pub fn sheet(&self, n: u32) -> Result<Sheet, String> {
        match self {
            Self::Grid => Ok(Sheet { mesh: ClothGrid::new(1.0, 1.0, n, n).lying().into(), top: Top::EDGE }),
            Self::Delaunay => Ok(delaunay::sheet(n)),
            Self::Hex => Ok(hex::sheet(n)),
            Self::Skirt => Ok(skirt::sheet(n)),
            Self::Ell => Ok(ell::sheet(n)),
            Self::Sleeve => Ok(sleeve::sheet(n)),
            Self::File(path) => file::sheet(path),
        }
    }
}

/// The sheet of a square metre at the origin, lying and facing up, with vertices at `uvs`: (0, 0) is at -X and -Z.
fn square(uvs: Vec<Vec2>, triangles: &[[u32; 3]]) -> Sheet {
    let positions = uvs.iter().map(|uv| Vec3::new(uv.x - 0.5, 0.0, uv.y - 0.5)).collect();
    Sheet { mesh: assemble(positions, Some(uvs), triangles), top: Top::EDGE }
}

fn assemble(positions: Vec<Vec3>, uvs: Option<Vec<Vec2>>, triangles: &[[u32; 3]]) -> Mesh {
    let mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_indices(Indices::U32(triangles.as_flattened().to_vec()));
    match uvs {
        Some(uvs) => mesh.with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs),
        None => mesh,
    }
}
