//! Coarse lattices over a cloth: here of one that is a lattice itself.

use crate::{
    Lattice, Level,
    topology::level::{Prolongation, TransferOperator},
};

mod chart;

pub(super) use chart::of_chart;

/// Particles from one node to the next on the finest level.
const FINEST_STRIDE: usize = 4;

/// The fewest nodes along the longer side of a level.
const FEWEST_NODES: usize = 4;

/// All levels of a lattice.
pub(super) fn of_lattice(lattice: &Lattice) -> Vec<Level> {
    by_strides(lattice.rows.max(lattice.columns), |stride| level(lattice, stride))
}

/// Levels of a cloth with so many particles along its longer side, the coarsest first: each has twice the stride of the
/// next.
fn by_strides(longer: usize, level: impl Fn(usize) -> Level) -> Vec<Level> {
    let strides = core::iter::successors(Some(FINEST_STRIDE), |stride| Some(2 * stride));
    let mut levels: Vec<Level> = strides.take_while(|stride| longer / stride >= FEWEST_NODES).map(level).collect();
    levels.reverse();
    for i in 1..levels.len() {
        let [coarser, finer] = [&levels[i - 1], &levels[i]];
        let nodes = [&*coarser.rows, &*coarser.columns];
        levels[i].from_coarser = Some(Prolongation::new(nodes, coarser.ring, [&finer.rows, &finer.columns]));
    }
    levels
}

/// The level whose nodes are about `stride` particles apart.
fn level(cloth: &Lattice, stride: usize) -> Level {
    let closed = cloth.along_rows.closed;
    let rows = places(cloth.rows, stride, 2);
    // Of a ring, the end is the first place again.
    let mut columns = places(cloth.columns + usize::from(closed), stride, if closed { 4 } else { 2 });
    if closed {
        columns.pop();
    }
    let next_column = |column: usize| columns.get(column + 1).copied().unwrap_or(cloth.columns);
    let lattice = Lattice::of_lengths(rows.len(), columns.len(), closed, |(row, column), way| match way {
        (0, 1) => cloth.length_along_row(rows[row], columns[column]..next_column(column)),
        (1, 0) => cloth.length_along_column(columns[column], rows[row]..rows[row + 1]),
        _ => 0.0,
    });
    let slot = |node: u32| {
        let (row, column) = (node as usize / columns.len(), node as usize % columns.len());
        cloth.order().slot_at(rows[row], columns[column]) as u32
    };
    let slots = lattice.order().particles().map(|block| block.map(|node| node.map_or(Level::NOBODY, slot))).collect();
    let share = (cloth.rows * cloth.columns) as f32 / (rows.len() * columns.len()) as f32;
    let [rows, columns] = [rows, columns].map(|places| places.into_iter().map(|at| at as f32).collect::<Vec<_>>());
    let ring = closed.then_some(cloth.columns as f32);
    let numbers = |count: usize| -> Vec<f32> { (0..count).map(|i| i as f32).collect() };
    let particles = [numbers(cloth.rows), numbers(cloth.columns)];
    let spread = Prolongation::new([&rows, &columns], ring, particles.each_ref().map(Vec::as_slice));
    let transfer = TransferOperator::Lattice { slots, spread };
    Level { stride: stride as u32, lattice, rows, columns, ring, share, from_coarser: None, transfer }
}

/// `count` places thinned out to one in `stride` and at least `fewest`, both ends among them, as evenly as whole numbers
/// allow.
fn places(count: usize, stride: usize, fewest: usize) -> Vec<usize> {
    let nodes = (count / stride).max(fewest);
    (0..nodes).map(|i| (i * (count - 1) + (nodes - 1) / 2) / (nodes - 1)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_are_spread_evenly_from_border_to_border() {
        assert_eq!(places(64, 4, 2).len(), 16);
        assert_eq!(places(9, 4, 2), [0, 8]);
        assert_eq!(places(13, 4, 2), [0, 6, 12]);
        assert_eq!(places(2, 16, 2), [0, 1]);
    }
}
