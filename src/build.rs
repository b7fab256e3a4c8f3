//! Builds cloth from meshes: reads them, makes what cloths of one mesh share, beside the frames where that is much.

use bevy::{math::Mat3A, prelude::*};

use crate::{
    error::ClothError,
    mesh_input,
    solver::{self, SourceMesh, Topology, build::weld::NO_PARTICLE},
};

mod assemble;
mod candidate;
mod copies;
pub(crate) mod garment;
pub(crate) mod plan;
pub(crate) mod proxy;
mod skin;
pub(crate) mod system;

pub use crate::solver::{grab_tethers, tethers};

/// The geometry of a mesh that a cloth can be built from, for those who run the [`solver`] themselves.
///
/// # Errors
///
/// A [`ClothError`] where the mesh can't be read.
pub fn source_of(mesh: &Mesh) -> Result<SourceMesh, ClothError> {
    Ok(mesh_input::read(mesh)?.wound_by_normals())
}

/// The springs of a mesh, for those who run the [`solver`] themselves.
///
/// `to_world` gives the rest shape its scale: one unit after it is a metre. Vertices that share a position are one
/// particle. Particles are numbered row by row where the mesh has rows and columns, else in the order of their first
/// vertex, unless neighbours would stand far apart in memory: [`particles_of_vertices`] tells.
///
/// # Errors
///
/// A [`ClothError`] where the mesh has no triangle with an area or can't be read.
pub fn topology_of(mesh: &Mesh, to_world: Mat3A) -> Result<Topology, ClothError> {
    Ok(solver::build(&source_of(mesh)?, to_world)?.1)
}

/// The particle of [`topology_of`] that each vertex is; none for a vertex that is in no triangle.
///
/// # Errors
///
/// A [`ClothError`] where the mesh has no triangle with an area or can't be read.
pub fn particles_of_vertices(mesh: &Mesh, to_world: Mat3A) -> Result<Vec<Option<u32>>, ClothError> {
    let (welded, _) = solver::build(&source_of(mesh)?, to_world)?;
    let particle = |&particle: &u32| (particle != NO_PARTICLE).then_some(particle);
    Ok(welded.particle_of_vertex.iter().map(particle).collect())
}
