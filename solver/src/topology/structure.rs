//! What a mesh was found to be: that decides how well strands hold it.

use core::fmt;

use crate::topology::{Topology, strand_pack::StrandPack};

/// How a cloth is solved by [`Method::Strands`](crate::input::Method::Strands). Written out, it is a text such as "64 rows, 64
/// columns", "implicit steps of 8192 triangles", "190 strands" or "springs in 14 colours".
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshStructure {
    /// As rows and columns: the mesh is one rectangle, or a tube.
    Grid {
        /// Number of rows.
        rows: usize,
        /// Number of columns.
        columns: usize,
        /// Whether rows are rings.
        closed: bool,
    },
    /// As triangles that all take an implicit step together: a sheet with moduli without rows and columns.
    Triangles {
        /// Number of triangles.
        count: usize,
    },
    /// As strands that go straight on from edge to edge: the mesh is regular.
    Strands {
        /// Number of strands.
        count: usize,
    },
    /// One by one, those that share no particle side by side: the mesh is irregular.
    Unstructured {
        /// Number of groups that share no particle.
        colors: usize,
    },
}

impl fmt::Display for MeshStructure {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Grid { rows, columns, closed: false } => write!(f, "{rows} rows, {columns} columns"),
            Self::Grid { rows, columns, closed: true } => write!(f, "{rows} rings, {columns} columns"),
            Self::Triangles { count } => write!(f, "implicit steps of {count} triangles"),
            Self::Strands { count } => write!(f, "{count} strands"),
            Self::Unstructured { colors } => write!(f, "springs in {colors} colours"),
        }
    }
}

impl Topology {
    /// What the mesh was found to be for a sheet with moduli.
    pub fn structure_of_sheet(&self) -> MeshStructure {
        match &self.two_grid {
            Some(_) => MeshStructure::Triangles { count: self.triangles.len() },
            None => self.structure(),
        }
    }

    /// What the mesh was found to be for a cloth of plain springs.
    pub fn structure(&self) -> MeshStructure {
        match &self.lattice {
            Some(lattice) => {
                MeshStructure::Grid { rows: lattice.rows, columns: lattice.columns, closed: lattice.along_rows.closed }
            }
            None if self.strand_packs.is_empty() => MeshStructure::Unstructured { colors: self.batches.len() },
            None => MeshStructure::Strands { count: self.strand_packs.iter().map(StrandPack::strand_count).sum() },
        }
    }
}
