//! The particles of one cloth while a step runs: in blocks of eight, component by component, so that eight can be worked
//! on side by side.

use bevy_math::Vec3A;
use fearless_simd::dispatch;

use crate::{
    layout::{
        order::{Band, Order},
        points::{Block, Points, load_blocks, store_blocks},
        simd::{LANES, Lane, SimdLevel},
    },
    particles::Particles,
};

/// What a step works on. Where nobody stands, there is a fixed particle that is joined to nothing.
#[derive(Clone, Debug, Default)]
pub struct Lanes {
    /// Who stands where.
    pub order: Order,
    /// Position, m.
    pub position: Points,
    /// Position at the start of the substep, m.
    pub previous: Points,
    /// Velocity, m/s.
    pub velocity: Points,
    /// Inverse mass, 1/kg. Zero for a fixed particle.
    pub inverse_mass: Vec<Lane>,
    /// Inverse mass of the particles of a lattice, 1/kg: eight rows side by side, column after column.
    pub row_masses: Vec<Lane>,
}

impl Lanes {
    /// Makes room for particles in an order.
    pub fn fit(&mut self, order: Order) {
        self.order = order;
        for points in [&mut self.position, &mut self.previous, &mut self.velocity] {
            points.resize(order.block_count());
        }
        self.inverse_mass.resize(order.block_count(), Lane::default());
        self.row_masses.resize(order.row_mass_count(), Lane::default());
    }

    /// Takes over the state of a cloth.
    pub fn load(&mut self, particles: &Particles, order: Order, simd_level: SimdLevel) {
        self.fit(order);
        for band in order.bands() {
            self.band(band).load(particles, band, simd_level);
        }
    }

    /// Hands the state back.
    pub fn store(&mut self, particles: &mut Particles, simd_level: SimdLevel) {
        let Particles { position, velocity, .. } = particles;
        for band in self.order.bands() {
            let (position, velocity) = (&mut position[band.particles()], &mut velocity[band.particles()]);
            self.band(band).store(position, velocity, band, simd_level);
        }
    }

    /// Inverse mass of the particle in a slot, 1/kg.
    #[inline]
    pub fn inverse_mass(&self, slot: usize) -> f32 {
        self.inverse_mass[slot / LANES][slot % LANES]
    }

    /// Sets the inverse mass of the particle in a slot, 1/kg.
    #[inline]
    pub fn set_inverse_mass(&mut self, slot: usize, inverse_mass: f32) {
        self.inverse_mass[slot / LANES][slot % LANES] = inverse_mass;
    }
}

/// Some blocks of a cloth, one after the other.
#[derive(Debug)]
pub(crate) struct Run<'a> {
    /// Number of the first block.
    pub first: usize,
    /// Position, m.
    pub position: &'a mut [Block],
    /// Position at the start of the substep, m.
    pub previous: &'a mut [Block],
    /// Velocity, m/s.
    pub velocity: &'a mut [Block],
    /// Inverse mass, 1/kg.
    pub inverse_mass: &'a mut [Lane],
    /// Inverse mass of the particles of a lattice, 1/kg: eight rows side by side, column after column.
    pub row_masses: &'a mut [Lane],
}

impl Run<'_> {
    /// What constraints of a lattice work on.
    pub fn grid(&mut self) -> GridView<'_> {
        let Self { position, previous, inverse_mass, row_masses, .. } = self;
        GridView { position, previous, inverse_mass, row_masses }
    }

    /// Takes over the state of a band.
    pub fn load(&mut self, particles: &Particles, band: Band, simd_level: SimdLevel) {
        let level = simd_level.level();
        let (position, velocity) = (&particles.position[band.particles()], &particles.velocity[band.particles()]);
        dispatch!(level, simd => load_blocks(simd, self.position, band, position));
        dispatch!(level, simd => load_blocks(simd, self.velocity, band, velocity));
        let masses = &particles.inverse_mass[band.particles()];
        for (some, lane) in band.particles_of_blocks().zip(&mut *self.inverse_mass) {
            let masses = &masses[some];
            match masses.as_array() {
                Some(masses) => *lane = *masses,
                None => {
                    *lane = Lane::default();
                    lane[..masses.len()].copy_from_slice(masses);
                }
            }
        }
    }

    /// Hands the state of a band back, to its own particles.
    pub fn store(&self, position: &mut [Vec3A], velocity: &mut [Vec3A], band: Band, simd_level: SimdLevel) {
        let level = simd_level.level();
        dispatch!(level, simd => store_blocks(simd, self.position, band, position));
        dispatch!(level, simd => store_blocks(simd, self.velocity, band, velocity));
    }
}

impl Lanes {
    /// All blocks.
    pub(crate) fn whole(&mut self) -> Run<'_> {
        let Self { position, previous, velocity, inverse_mass, row_masses, .. } = self;
        let (position, previous, velocity) = (&mut position.0, &mut previous.0, &mut velocity.0);
        Run { first: 0, position, previous, velocity, inverse_mass, row_masses }
    }

    /// The blocks of a band.
    pub(crate) fn band(&mut self, band: Band) -> Run<'_> {
        let Self { position, previous, velocity, inverse_mass, row_masses, .. } = self;
        let blocks = band.blocks();
        Run {
            first: blocks.start,
            position: &mut position.0[blocks.clone()],
            previous: &mut previous.0[blocks.clone()],
            velocity: &mut velocity.0[blocks.clone()],
            inverse_mass: &mut inverse_mass[blocks],
            row_masses: &mut row_masses[band.row_masses()],
        }
    }

    /// All blocks, band after band.
    pub(crate) fn bands(&mut self) -> Vec<Run<'_>> {
        let bands = self.order.bands();
        let Run { mut position, mut previous, mut velocity, mut inverse_mass, mut row_masses, .. } = self.whole();
        let cut = |band: Band| {
            let count = band.blocks().len();
            Run {
                first: band.blocks().start,
                position: position.split_off_mut(..count).unwrap_or_default(),
                previous: previous.split_off_mut(..count).unwrap_or_default(),
                velocity: velocity.split_off_mut(..count).unwrap_or_default(),
                inverse_mass: inverse_mass.split_off_mut(..count).unwrap_or_default(),
                row_masses: row_masses.split_off_mut(..band.row_masses().len()).unwrap_or_default(),
            }
        };
        bands.map(cut).collect()
    }
}

/// The particles of a lattice during a substep.
pub(crate) struct GridView<'a> {
    pub position: &'a mut [Block],
    /// Positions before the substep; read only where springs are damped.
    pub previous: &'a [Block],
    pub inverse_mass: &'a [Lane],
    /// Inverse masses as [`masses_along_rows`] gives them.
    pub row_masses: &'a [Lane],
}

impl GridView<'_> {
    /// What is in a band of the whole lattice.
    pub fn band(&mut self, band: Band) -> GridView<'_> {
        let blocks = band.blocks();
        GridView {
            position: &mut self.position[blocks.clone()],
            previous: &self.previous[blocks.clone()],
            inverse_mass: &self.inverse_mass[blocks],
            row_masses: &self.row_masses[band.row_masses()],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_taken_over_comes_back_the_same() {
        for (rows, columns) in [(1, 1), (1, 8), (1, 41), (3, 7), (5, 17), (9, 16), (130, 9)] {
            let order = Order { rows, columns };
            let count = order.particle_count();
            let points: Vec<Vec3A> = (0..count).map(|i| Vec3A::new(i as f32, 0.5, -(i as f32))).collect();
            let particles = Particles {
                velocity: points.iter().map(|p| *p * 2.0).collect(),
                inverse_mass: vec![1.0; count],
                force: points.clone(),
                position: points,
                contact_load: Default::default(),
            };
            let mut lanes = Lanes::default();
            lanes.load(&particles, order, SimdLevel::Best);
            for particle in 0..count {
                assert_eq!(lanes.position.get(order.slot(particle as u32)), particles.position[particle]);
            }
            assert_eq!(lanes.inverse_mass.as_flattened().iter().sum::<f32>(), count as f32);
            let (position, velocity) = (vec![Vec3A::ONE; count], vec![Vec3A::ONE; count]);
            let mut back = Particles { position, velocity, ..particles.clone() };
            lanes.store(&mut back, SimdLevel::Baseline);
            assert_eq!(back, particles);
        }
    }
}
