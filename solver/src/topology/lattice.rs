//! Particles in rows and columns, and the strands that they are on.

use core::ops::Range;

use crate::{
    layout::{
        order::Order,
        simd::{LANES, Lane},
    },
    topology::Grain,
};

/// Particles that form a rectangle: the one in row r and column c is number r · columns + c.
///
/// Rest lengths stand as the solver reads them: for eight strands side by side, node after node. Zero where there is no
/// spring.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lattice {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Along the rows.
    pub along_rows: StrandSet,
    /// Along the columns.
    pub along_columns: StrandSet,
    /// Rest lengths of the diagonals from a particle to the next column of the next row, m: for each eight columns, one
    /// entry a row.
    pub falling: Vec<Lane>,
    /// Rest lengths of the diagonals from the next column to the next row, m.
    pub rising: Vec<Lane>,
    /// Parts of G that the falling and the rising diagonal of a cell have, no unit.
    pub diagonal_shares: [Vec<Lane>; 2],
    /// Weights of the twist of each cell: its energy is B/2 times the squared length of the weight times the sum of the
    /// places of two opposite corners less those of the others.
    pub twist: Vec<Lane>,
    /// What bends and twists are at rest, where the cloth isn't flat.
    pub curl: Option<Box<RestCurvature>>,
}

/// What the bends and twists of a lattice are at rest, no unit: along the way from the particle before to that after,
/// across it towards the next row or column, and normal to both. For each eight columns, one entry a row.
///
/// Of a twist, along is the way from the cell's first corner to that opposite, and across that between the others, down.
/// After the last row or column, across is seen as from the one before.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RestCurvature {
    /// Of the rows, at each particle.
    pub along_rows: Vec<[Lane; 3]>,
    /// Of the columns, at each particle.
    pub along_columns: Vec<[Lane; 3]>,
    /// Of the cell that begins at each particle.
    pub twist: Vec<[Lane; 3]>,
}

/// The springs along all rows or along all columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StrandSet {
    /// Nodes that each strand has room for: those of rows go on to the end of the last block.
    pub nodes: usize,
    /// Nodes of each strand.
    pub count: usize,
    /// Whether the last node of a strand is joined to the first: strands are rings.
    pub closed: bool,
    /// Rest lengths from a node to the next, m: for each eight strands, one entry a node. That from the last node of a ring
    /// is the length to its first.
    pub stretch: Vec<Lane>,
    /// Rest lengths from a node to the one after the next, m.
    pub bend: Vec<Lane>,
    /// Which strands of a sheet they are.
    pub grain: Grain,
    /// Parts of C and of -G that each spring from a node to the next has of a sheet, over its rest length, 1/m.
    pub shares: Vec<[Lane; 2]>,
    /// Weights with which the nodes before and after count in the bend at each node, no unit.
    pub curvature: Vec<[Lane; 2]>,
}

/// What joins a particle of a lattice to another, or bends there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Link {
    /// Rest length, m; zero for none.
    pub rest: f32,
    /// Parts of C and -G along a strand, and that of G along a diagonal, no unit.
    pub shares: [f32; 2],
    /// Weights of the bend in the middle of the way from two steps along a strand, or of the cell's twist, no unit.
    pub weights: [f32; 2],
}

impl Lattice {
    /// The lattice of `rows` x `columns` particles that are joined as `link` says from the particle at (row, column) by so
    /// many rows and columns. Where `closed`, rows are rings: the next column of the last is the first. `grain` is what
    /// columns are.
    pub fn new(
        rows: usize,
        columns: usize,
        closed: bool,
        grain: Grain,
        link: impl Fn((usize, usize), (isize, isize)) -> Link,
    ) -> Self {
        let has = |(row, column): (usize, usize)| row < rows && column < columns;
        let link = |from: (usize, usize), way: (isize, isize)| {
            let to = from.0.checked_add_signed(way.0).zip(from.1.checked_add_signed(way.1));
            let closes = closed && from.1 + 1 == columns && way == (0, 1);
            if has(from) && (closes || to.is_some_and(has)) { link(from, way) } else { Link::default() }
        };
        let width = columns.next_multiple_of(LANES);
        let of_rows = || (0..rows).step_by(LANES).flat_map(move |row| (0..width).map(move |column| (row, column)));
        let of_columns = || (0..columns).step_by(LANES).flat_map(move |column| (0..rows).map(move |row| (row, column)));
        let lanes = |of: &dyn Fn(usize) -> f32| -> Lane { core::array::from_fn(of) };
        // The bend at a node is that of the way that starts at the one before.
        let along_rows = StrandSet {
            nodes: width,
            count: columns,
            closed,
            grain: grain.other(),
            stretch: of_rows().map(|(row, c)| lanes(&|l| link((row + l, c), (0, 1)).rest)).collect(),
            bend: of_rows().map(|(row, c)| lanes(&|l| link((row + l, c), (0, 2)).rest)).collect(),
            shares: of_rows()
                .map(|(row, c)| [0, 1].map(|i| lanes(&|l| link((row + l, c), (0, 1)).per_length(i))))
                .collect(),
            curvature: of_rows()
                .map(|(row, c)| {
                    let weight = |l: usize, i: usize| {
                        c.checked_sub(1).map_or(0.0, |before| link((row + l, before), (0, 2)).weights[i])
                    };
                    [0, 1].map(|i| lanes(&|l| weight(l, i)))
                })
                .collect(),
        };
        let along_columns = StrandSet {
            nodes: rows,
            count: rows,
            closed: false,
            grain,
            stretch: of_columns().map(|(r, column)| lanes(&|l| link((r, column + l), (1, 0)).rest)).collect(),
            bend: of_columns().map(|(r, column)| lanes(&|l| link((r, column + l), (2, 0)).rest)).collect(),
            shares: of_columns()
                .map(|(r, column)| [0, 1].map(|i| lanes(&|l| link((r, column + l), (1, 0)).per_length(i))))
                .collect(),
            curvature: of_columns()
                .map(|(r, column)| {
                    let weight = |l: usize, i: usize| {
                        r.checked_sub(1).map_or(0.0, |before| link((before, column + l), (2, 0)).weights[i])
                    };
                    [0, 1].map(|i| lanes(&|l| weight(l, i)))
                })
                .collect(),
        };
        let cells = |of: &dyn Fn((usize, usize)) -> f32| -> Vec<Lane> {
            of_columns().map(|(r, column)| lanes(&|l| of((r, column + l)))).collect()
        };
        Self {
            rows,
            columns,
            along_rows,
            along_columns,
            falling: cells(&|at| link(at, (1, 1)).rest),
            rising: cells(&|(row, column)| link((row, column + 1), (1, -1)).rest),
            diagonal_shares: [
                cells(&|at| link(at, (1, 1)).shares[0]),
                cells(&|(row, column)| link((row, column + 1), (1, -1)).shares[0]),
            ],
            twist: cells(&|at| link(at, (1, 1)).weights[0]),
            curl: None,
        }
    }

    /// A lattice whose strands have these lengths (m), and nothing else.
    pub fn of_lengths(
        rows: usize,
        columns: usize,
        closed: bool,
        length: impl Fn((usize, usize), (isize, isize)) -> f32,
    ) -> Self {
        let link = |from, way| Link { rest: length(from, way), ..Link::default() };
        Self::new(rows, columns, closed, Grain::Warp, link)
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

impl Link {
    fn per_length(&self, share: usize) -> f32 {
        if self.rest > 0.0 { self.shares[share] / self.rest } else { 0.0 }
    }
}

impl StrandSet {
    /// Rest lengths of the eight strands with number `pack`.
    #[inline(always)]
    pub(crate) fn stretch(&self, pack: usize) -> &[Lane] {
        &self.stretch[pack * self.nodes..][..self.count]
    }
}
