//! What a mesh was found to be: that decides how well strands hold it.

use core::fmt;

use super::{Braid, Topology};

/// How a cloth's springs are solved by [`Method::Strands`](super::Method::Strands). Written out, it is a text such as
/// "64 rows, 64 columns", "190 threads" or "springs in 14 colours".
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weave {
    /// As rows and columns: the mesh is one rectangle, or a tube.
    Lattice {
        /// Number of rows.
        rows: usize,
        /// Number of columns.
        columns: usize,
        /// Whether rows are rings.
        closed: bool,
    },
    /// As threads that go straight on from edge to edge: the mesh is regular.
    Threads {
        /// Number of threads.
        count: usize,
    },
    /// One by one, those that share no particle side by side: the mesh is irregular.
    Springs {
        /// Number of groups that share no particle.
        colors: usize,
    },
}

impl fmt::Display for Weave {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Lattice { rows, columns, closed: false } => write!(f, "{rows} rows, {columns} columns"),
            Self::Lattice { rows, columns, closed: true } => write!(f, "{rows} rings, {columns} columns"),
            Self::Threads { count } => write!(f, "{count} threads"),
            Self::Springs { colors } => write!(f, "springs in {colors} colours"),
        }
    }
}

impl Topology {
    /// What the mesh was found to be.
    pub fn weave(&self) -> Weave {
        match &self.lattice {
            Some(lattice) => {
                Weave::Lattice { rows: lattice.rows, columns: lattice.columns, closed: lattice.along_rows.closed }
            }
            None if self.braids.is_empty() => Weave::Springs { colors: self.batches.len() },
            None => Weave::Threads { count: self.braids.iter().map(Braid::thread_count).sum() },
        }
    }
}
