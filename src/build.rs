//! From a mesh to particles and springs. Only `system` and `candidate` know the ECS.

use bevy::{math::Mat3A, prelude::*};

use crate::{error::ClothError, solver::Topology};

mod bends;
mod blend;
mod candidate;
mod cells;
mod chart;
mod coloring;
mod edges;
mod faces;
mod geodesic;
pub(crate) mod grain;
mod grouped;
mod hinges;
pub(crate) mod job;
mod lattice;
mod levels;
mod order;
pub(crate) mod plan;
mod plate;
mod rate;
mod shares;
pub(crate) mod source;
mod springs;
mod strand_packs;
pub(crate) mod stretch;
pub(crate) mod system;
mod threads;
mod topology;
pub(crate) mod weld;

pub(crate) use blend::{BlendWeights, Blending};
pub(crate) use geodesic::TetherBuild;
pub use geodesic::{grab_tethers, tethers};

use source::SourceMesh;
use topology::Shape;
use weld::Welded;

/// The springs of a mesh, for those who run the [`solver`](crate::solver) themselves.
///
/// `to_world` gives the rest shape its scale: one unit after it is a metre. Vertices that share a position are one
/// particle. Particles are numbered row by row where the mesh has rows and columns, else in the order of their first
/// vertex, unless neighbours would stand far apart in memory: [`particles_of_vertices`] tells.
///
/// # Errors
///
/// A [`ClothError`] where the mesh has no triangle with an area or can't be read.
pub fn topology_of(mesh: &Mesh, to_world: Mat3A) -> Result<Topology, ClothError> {
    Ok(particles_of(&SourceMesh::read(mesh)?.wound_by_normals(), to_world)?.1)
}

/// The particle of [`topology_of`] that each vertex is; none for a vertex that is in no triangle.
///
/// # Errors
///
/// A [`ClothError`] where the mesh has no triangle with an area or can't be read.
pub fn particles_of_vertices(mesh: &Mesh, to_world: Mat3A) -> Result<Vec<Option<u32>>, ClothError> {
    let (welded, _) = particles_of(&SourceMesh::read(mesh)?.wound_by_normals(), to_world)?;
    let particle = |&particle: &u32| (particle != weld::NO_PARTICLE).then_some(particle);
    Ok(welded.particle_of_vertex.iter().map(particle).collect())
}

/// Particles farther than this from the mesh's origin, m, are beyond what areas and volumes can be computed of.
const FARTHEST: f32 = 1e7;

/// Whether a place (m) is finite, and near enough to its origin to compute with.
pub(crate) fn is_near_enough(place: &Vec3) -> bool {
    place.abs().cmple(Vec3::splat(FARTHEST)).all()
}

/// Welds a mesh and joins its particles with springs.
fn particles_of(source: &SourceMesh, to_world: Mat3A) -> Result<(Welded, Topology), ClothError> {
    let mut welded = weld::weld(&source.positions, &source.triangles);
    let rest = |welded: &Welded| -> Vec<Vec3> {
        let place = |&vertex: &u32| to_world * source.positions[vertex as usize];
        welded.vertex_of_particle.iter().map(place).collect()
    };
    let places = rest(&welded);
    if let Some(particle) = places.iter().position(|place| !is_near_enough(place)) {
        let (vertex, distance) = (welded.vertex_of_particle[particle], places[particle].abs().max_element());
        return Err(ClothError::PositionTooFar { vertex, distance });
    }
    let triangles = |welded: &Welded| -> Vec<[u32; 3]> {
        let particle = |vertex: u32| welded.particle_of_vertex[vertex as usize];
        source.triangles.iter().map(|t| t.map(particle)).collect()
    };
    let mut shape = Shape::find(&places, &triangles(&welded))?;
    if let Some(order) = order::better(welded.vertex_of_particle.len(), &shape) {
        welded.reorder(&order);
        shape = Shape::find(&rest(&welded), &triangles(&welded))?;
    }
    let uvs = source.uvs.as_ref().and_then(|uvs| welded.shared(uvs));
    let topology = topology::build(rest(&welded), shape, uvs, &grain::find(source, to_world));
    Ok((welded, topology))
}
