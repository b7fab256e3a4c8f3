//! What a lattice's bends have in common in all substeps of a step.

use super::curvature::Factor;
use crate::solver::lanes::Block;

/// As threads are solved: for eight side by side, node after node.
#[derive(Clone, Debug, Default)]
pub(in crate::solver) struct Plate {
    /// The matrix of the rows' bends, in factors.
    pub rows: Vec<Factor>,
    /// The matrix of the columns' bends, in factors.
    pub columns: Vec<Factor>,
    /// What bends and twists are at rest, turned into the directions that the cloth has now, m.
    pub rest: Rest,
}

/// Empty where the cloth is flat.
#[derive(Clone, Debug, Default)]
pub(in crate::solver) struct Rest {
    pub rows: Vec<Block>,
    pub columns: Vec<Block>,
    pub cells: Vec<Block>,
}

impl Plate {
    /// What bends nowhere.
    pub const NONE: Self = Self {
        rows: Vec::new(),
        columns: Vec::new(),
        rest: Rest { rows: Vec::new(), columns: Vec::new(), cells: Vec::new() },
    };
}

/// Of the threads of all packs from the `first` on, with so many `nodes` each.
pub(in crate::solver) fn from_pack<T>(all: &[T], first: usize, nodes: usize) -> &[T] {
    all.get(first * nodes..).unwrap_or_default()
}
