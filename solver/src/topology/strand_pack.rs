//! Strands that lie anywhere on a mesh, eight side by side.

use crate::layout::simd::{LANES, Lane};

/// Up to eight strands that share no particle.
///
/// All stand as the solver reads them: node after node, those of the eight strands side by side. Shorter strands than
/// the longest end in nodes where nobody is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StrandPack {
    /// Particles of the strands; the number of all particles where nobody is.
    pub nodes: Vec<[u32; LANES]>,
    /// Rest lengths from a node to the next, m; zero where there is no spring. That from the last node of a ring is the
    /// length to its first.
    pub stretch: Vec<Lane>,
    /// Rest lengths from a node to the one after the next, m; zero where there is no spring. Empty where there is none
    /// at all.
    pub bend: Vec<Lane>,
    /// Parts of Cu, Cv and -G that each spring from a node to the next has of a sheet, over its rest length, 1/m. Empty
    /// where none has any.
    pub shares: Vec<[Lane; 3]>,
    /// Whether the last node of each strand is joined to its first: strands are rings.
    pub closed: bool,
}

impl StrandPack {
    /// Number of strands.
    pub fn strand_count(&self) -> usize {
        self.stretch.first().map_or(0, |rest| rest.iter().filter(|&&rest| rest > 0.0).count())
    }

    /// Number of springs from node to node.
    pub fn spring_count(&self) -> usize {
        self.stretch.as_flattened().iter().filter(|&&rest| rest > 0.0).count()
    }
}
