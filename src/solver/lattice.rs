//! Particles in rows and columns, and the threads that they are on.

use core::ops::Range;

use super::{
    order::Order,
    simd::{LANES, Lane},
};

/// Particles that form a rectangle: the one in row r and column c is number r · columns + c.
///
/// Rest lengths stand as the solver reads them: for eight threads side by side, node after node. Zero where there is no
/// spring.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lattice {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Along the rows.
    pub along_rows: Threads,
    /// Along the columns.
    pub along_columns: Threads,
    /// Rest lengths of the diagonals from a particle to the next column of the next row, m: for each eight columns, one
    /// entry a row.
    pub falling: Vec<Lane>,
    /// Rest lengths of the diagonals from the next column to the next row, m.
    pub rising: Vec<Lane>,
}

/// The springs along all rows or along all columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Threads {
    /// Nodes that each thread has room for: those of rows go on to the end of the last block.
    pub nodes: usize,
    /// Nodes of each thread.
    pub count: usize,
    /// Whether the last node of a thread is joined to the first: threads are rings.
    pub closed: bool,
    /// Rest lengths from a node to the next, m: for each eight threads, one entry a node. That from the last node of a ring
    /// is the length to its first.
    pub stretch: Vec<Lane>,
    /// Rest lengths from a node to the one after the next, m.
    pub bend: Vec<Lane>,
}

impl Lattice {
    /// The lattice of `rows` x `columns` particles whose springs have the rest lengths (m) that `spring` gives from the
    /// particle at (row, column) by so many rows and columns; zero for no spring. Where `closed`, rows are rings: the
    /// next column of the last is the first.
    pub fn new(
        rows: usize,
        columns: usize,
        closed: bool,
        spring: impl Fn((usize, usize), (isize, isize)) -> f32,
    ) -> Self {
        let has = |(row, column): (usize, usize)| row < rows && column < columns;
        let rest = |from: (usize, usize), way: (isize, isize)| {
            let to = from.0.checked_add_signed(way.0).zip(from.1.checked_add_signed(way.1));
            let closes = closed && from.1 + 1 == columns && way == (0, 1);
            if has(from) && (closes || to.is_some_and(has)) { spring(from, way) } else { 0.0 }
        };
        let width = columns.next_multiple_of(LANES);
        let along_rows = |way| -> Vec<Lane> {
            let nodes = (0..rows).step_by(LANES).flat_map(|row| (0..width).map(move |column| (row, column)));
            nodes.map(|(row, column)| core::array::from_fn(|l| rest((row + l, column), way))).collect()
        };
        let along_columns = |way, shift| -> Vec<Lane> {
            let nodes = (0..columns).step_by(LANES).flat_map(|column| (0..rows).map(move |row| (row, column)));
            nodes.map(|(row, column)| core::array::from_fn(|l| rest((row, column + l + shift), way))).collect()
        };
        let threads = |nodes, count, closed, stretch, bend| Threads { nodes, count, closed, stretch, bend };
        Self {
            rows,
            columns,
            along_rows: threads(width, columns, closed, along_rows((0, 1)), along_rows((0, 2))),
            along_columns: threads(rows, rows, false, along_columns((1, 0), 0), along_columns((2, 0), 0)),
            falling: along_columns((1, 1), 0),
            rising: along_columns((1, -1), 1),
        }
    }

    /// Length of the springs between two columns of a row, m; of a ring, up to the first again where the end is the number
    /// of columns.
    pub fn length_along_row(&self, row: usize, columns: Range<usize>) -> f32 {
        self.along_rows.stretch(row / LANES)[columns].iter().map(|lengths| lengths[row % LANES]).sum()
    }

    /// Length of the springs between two rows of a column, m.
    pub fn length_along_column(&self, column: usize, rows: Range<usize>) -> f32 {
        self.along_columns.stretch(column / LANES)[rows].iter().map(|lengths| lengths[column % LANES]).sum()
    }

    pub(crate) fn order(&self) -> Order {
        Order { rows: self.rows, columns: self.columns }
    }
}

impl Threads {
    /// Rest lengths of the eight threads with number `pack`.
    #[inline(always)]
    pub(super) fn stretch(&self, pack: usize) -> &[Lane] {
        &self.stretch[pack * self.nodes..][..self.count]
    }
}
