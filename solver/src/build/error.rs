//! Why the geometry of a mesh can't be cloth.

use bevy_reflect::Reflect;
use thiserror::Error;

/// Why no cloth can be built of a mesh. The message names the cause and the mend.
#[derive(Clone, Debug, PartialEq, Reflect, Error)]
#[reflect(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum MeshError {
    /// The mesh has positions, and no triangle with an area.
    #[error("the mesh has no triangle with an area; check its indices and positions")]
    Empty,
    /// A position is NaN or infinite.
    #[error("the position of vertex {vertex} isn't finite; export the mesh again or mend that vertex")]
    PositionNotFinite {
        /// The mesh's vertex index.
        vertex: u32,
    },
    /// A position is so far away that it can't be computed with.
    #[error(
        "the position of vertex {vertex} is {distance} m from the mesh's origin in the world's scale, which is too far to \
         compute with; keep it below 10000000 m, by the mesh's units or the entity's scale"
    )]
    PositionTooFar {
        /// The mesh's vertex index.
        vertex: u32,
        /// Its distance under the entity's scale, m.
        distance: f32,
    },
    /// An index points past the last vertex.
    #[error("a triangle uses vertex {vertex}, but the mesh has {count} vertices; mend its indices")]
    IndexOutOfRange {
        /// The index that is too large.
        vertex: u32,
        /// Number of vertices of the mesh.
        count: u32,
    },
    /// An attribute hasn't one value for each vertex.
    #[error("an attribute has {values} values, but the mesh has {count} vertices; give it one for each")]
    AttributeLength {
        /// Number of its values.
        values: u32,
        /// Number of vertices of the mesh.
        count: u32,
    },
}
