//! Builds a cloth: from the geometry of a mesh to particles, springs, strands and tethers.

use bevy_math::{Mat3A, Vec3};

use crate::topology::Topology;

mod bends;
pub mod blend;
mod cell_shares;
mod cells;
mod chart;
mod coloring;
mod edges;
mod error;
mod faces;
pub mod geodesic;
mod grain;
mod grouped;
mod hinges;
mod lattice;
mod levels;
mod order;
mod plate;
mod rate;
mod shares;
mod source;
mod springs;
mod strand_packs;
mod strands;
pub mod stretch;
mod topology;
mod two_grid;
pub mod weld;

pub use error::MeshError;
pub use geodesic::{grab_tethers, tethers};
pub use source::SourceMesh;
pub use weld::Welded;

use topology::Shape;

/// Particles farther than this from the mesh's origin, m, are beyond what areas and volumes can be computed of.
const FARTHEST: f32 = 1e7;

/// Whether a place (m) is finite, and near enough to its origin to compute with.
pub fn is_near_enough(place: &Vec3) -> bool {
    place.abs().cmple(Vec3::splat(FARTHEST)).all()
}

/// Welds a mesh's vertices to particles and connects these.
///
/// `to_world` gives the rest shape its scale: one unit after it is a metre. Vertices that share a position are one
/// particle. Particles are numbered row by row where the mesh has rows and columns, else in the order of their first
/// vertex, unless neighbours would stand far apart in memory: [`Welded`] tells.
///
/// # Errors
///
/// A [`MeshError`] where the mesh has no triangle with an area, or a position or index that can't be used.
pub fn build(source: &SourceMesh, to_world: Mat3A) -> Result<(Welded, Topology), MeshError> {
    source.check()?;
    let mut welded = weld::weld(&source.positions, &source.triangles);
    let rest = |welded: &Welded| -> Vec<Vec3> {
        let place = |&vertex: &u32| to_world * source.positions[vertex as usize];
        welded.vertex_of_particle.iter().map(place).collect()
    };
    let places = rest(&welded);
    if let Some(particle) = places.iter().position(|place| !is_near_enough(place)) {
        let (vertex, distance) = (welded.vertex_of_particle[particle], places[particle].abs().max_element());
        return Err(MeshError::PositionTooFar { vertex, distance });
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
