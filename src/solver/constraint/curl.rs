//! What a lattice's bends are at rest, where the cloth isn't flat: turned into the directions that it has now.

use crate::solver::lanes::Block;

/// Bends and twists at rest in a step, m, as threads are solved: for eight side by side, node after node. Empty where the
/// cloth is flat.
#[derive(Clone, Debug, Default)]
pub(in crate::solver) struct Curls {
    rows: Vec<Block>,
    columns: Vec<Block>,
    cells: Vec<Block>,
}

impl Curls {
    /// Those of a flat cloth.
    pub const FLAT: Self = Self { rows: Vec::new(), columns: Vec::new(), cells: Vec::new() };

    /// Of the rows of some packs from the `first` on, with so many `nodes` each.
    pub fn of_rows(&self, first: usize, nodes: usize) -> &[Block] {
        self.rows.get(first * nodes..).unwrap_or_default()
    }

    /// Of the columns of some packs from the `first` on, with so many `nodes` each.
    pub fn of_columns(&self, first: usize, nodes: usize) -> &[Block] {
        self.columns.get(first * nodes..).unwrap_or_default()
    }

    /// Of the cells from number `first` on.
    pub fn of_cells(&self, first: usize) -> &[Block] {
        self.cells.get(first..).unwrap_or_default()
    }
}
