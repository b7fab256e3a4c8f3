//! From a mesh to particles and springs. Only `system` knows the ECS.

use bevy::{math::Mat3A, prelude::*};

use crate::{error::ClothError, solver::Topology};

mod cells;
mod coloring;
mod edges;
mod geodesic;
pub(crate) mod plan;
pub(crate) mod source;
mod springs;
pub(crate) mod system;
mod topology;
pub(crate) mod weld;

pub use geodesic::{grab_tethers, tethers};

use source::SourceMesh;
use weld::Welded;

/// The springs of a mesh, for those who run the [`solver`](crate::solver) themselves.
///
/// `to_world` gives the rest shape its scale: one unit after it is a metre. Vertices that share a position are one
/// particle; particles are numbered in the order of their first vertex.
///
/// # Errors
///
/// A [`ClothError`] where the mesh has no triangle with an area or can't be read.
pub fn topology_of(mesh: &Mesh, to_world: Mat3A) -> Result<Topology, ClothError> {
    Ok(particles_of(&SourceMesh::read(mesh)?, to_world)?.1)
}

/// Welds a mesh and joins its particles with springs.
fn particles_of(source: &SourceMesh, to_world: Mat3A) -> Result<(Welded, Topology), ClothError> {
    let welded = weld::weld(&source.positions, &source.triangles);
    let particle = |vertex: u32| welded.particle_of_vertex[vertex as usize];
    let triangles: Vec<[u32; 3]> = source.triangles.iter().map(|t| t.map(particle)).collect();
    let place = |&vertex: &u32| to_world * source.positions[vertex as usize];
    let rest: Vec<Vec3> = welded.vertex_of_particle.iter().map(place).collect();
    let topology = topology::build(&rest, &triangles)?;
    Ok((welded, topology))
}
