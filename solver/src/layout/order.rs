//! In which order the particles of a cloth stand while a step runs.

use core::ops::Range;

use crate::layout::simd::LANES;

/// Rows of particles that stand together in memory, a multiple of four: the order of diagonals goes by four rows.
///
/// As many as fit into a processor's own cache in a cloth of some hundred columns.
pub const BAND: usize = 64;

/// In which block, and where in it, a particle stands: its slot.
///
/// Particles in rows and columns stand in blocks of eight columns, and those one below the other: a column of blocks is
/// eight strands side by side. That is so within each band of rows, and band stands after band. Others stand in their own
/// order, as if in one row. The last column of blocks is filled up with slots in which nobody stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Order {
    pub rows: usize,
    pub columns: usize,
}

impl Order {
    /// Particles without rows and columns.
    pub fn plain(count: usize) -> Self {
        Self { rows: 1, columns: count }
    }

    /// Number of particles.
    pub fn particle_count(&self) -> usize {
        self.rows * self.columns
    }

    /// Number of columns of blocks.
    pub fn pack_count(&self) -> usize {
        self.columns.div_ceil(LANES)
    }

    /// Number of blocks.
    pub fn block_count(&self) -> usize {
        self.pack_count() * self.rows
    }

    /// The block of a row in a column of blocks.
    #[inline]
    pub fn block_at(&self, row: usize, pack: usize) -> usize {
        let first = row - row % BAND;
        let rows = BAND.min(self.rows - first);
        first * self.pack_count() + pack * rows + row - first
    }

    /// The slot of the particle at a row and column.
    pub fn slot_at(&self, row: usize, column: usize) -> usize {
        self.block_at(row, column / LANES) * LANES + column % LANES
    }

    /// The slot of a particle.
    #[inline]
    pub fn slot(&self, particle: u32) -> usize {
        let (particle, columns) = (particle as usize, self.columns);
        if self.rows == 1 { particle } else { self.slot_at(particle / columns, particle % columns) }
    }

    /// Number of places in [`Lanes::row_masses`](crate::particles::lanes::Lanes).
    pub fn row_mass_count(self) -> usize {
        self.bands().map(|band| band.row_masses().len()).sum()
    }

    /// All bands.
    #[inline(always)]
    pub fn bands(self) -> impl ExactSizeIterator<Item = Band> + Clone {
        (0..self.rows).step_by(BAND).map(move |first| Band { first, rows: BAND.min(self.rows - first), order: self })
    }

    /// First particle and number of particles of each block.
    #[inline(always)]
    pub fn blocks(self) -> impl Iterator<Item = (usize, usize)> {
        self.bands().flat_map(|band| {
            let first = band.particles().start;
            band.particles_of_blocks().map(move |some| (first + some.start, some.len()))
        })
    }

    /// The particle in each lane of a block, if there is one.
    pub fn particles(self) -> impl Iterator<Item = [Option<u32>; LANES]> {
        self.blocks().map(|(first, count)| core::array::from_fn(|l| (l < count).then_some((first + l) as u32)))
    }
}

/// Some rows of an order, whose blocks stand together.
#[derive(Clone, Copy, Debug)]
pub struct Band {
    /// Number of the first row.
    pub first: usize,
    /// Number of rows.
    pub rows: usize,
    order: Order,
}

impl Band {
    /// The blocks.
    pub fn blocks(self) -> Range<usize> {
        let packs = self.order.pack_count();
        self.first * packs..(self.first + self.rows) * packs
    }

    /// Places in [`Lanes::row_masses`](crate::particles::lanes::Lanes).
    pub fn row_masses(self) -> Range<usize> {
        // What isn't in rows and columns has none.
        let nodes = if self.order.rows > 1 { self.order.pack_count() * LANES } else { 0 };
        self.first / LANES * nodes..(self.first + self.rows).div_ceil(LANES) * nodes
    }

    /// The particles.
    pub fn particles(self) -> Range<usize> {
        let columns = self.order.columns;
        self.first * columns..(self.first + self.rows) * columns
    }

    /// The particles of each block, numbered within the band.
    #[inline(always)]
    pub(crate) fn particles_of_blocks(self) -> impl Iterator<Item = Range<usize>> {
        let columns = self.order.columns;
        (0..columns).step_by(LANES).flat_map(move |column| {
            let count = LANES.min(columns - column);
            (0..self.rows).map(move |row| row * columns + column..row * columns + column + count)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_particle_has_a_slot_of_its_own_in_its_band() {
        for (rows, columns) in [(1, 41), (3, 7), (64, 8), (65, 9), (130, 17)] {
            let order = Order { rows, columns };
            let mut found = vec![None; order.block_count() * LANES];
            for particle in 0..order.particle_count() as u32 {
                let slot = order.slot(particle);
                assert_eq!(found[slot].replace(particle), None, "{rows} x {columns}");
                let band = order.bands().find(|band| band.particles().contains(&(particle as usize)));
                assert!(band.is_some_and(|band| band.blocks().contains(&(slot / LANES))));
            }
            let by_block: Vec<Option<u32>> = order.particles().flatten().collect();
            assert_eq!(by_block, found, "{rows} x {columns}");
        }
    }
}
