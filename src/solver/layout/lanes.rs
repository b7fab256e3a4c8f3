//! The particles of one cloth while a step runs: in blocks of eight, component by component, so that eight can be worked
//! on side by side.

use bevy::math::{Vec3A, Vec4};
use fearless_simd::{dispatch, f32x4, f32x8, prelude::*};

use crate::solver::{
    constraint::strand::grid::GridView,
    layout::{
        order::{Band, Order},
        simd::{LANES, Lane, SimdLevel, lane},
    },
    particles::Particles,
};

/// Eight points or directions: all x, all y, all z.
pub type Block = [Lane; 3];

/// Points or directions of all slots.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Points(pub Vec<Block>);

impl Points {
    /// Makes room for `count` blocks.
    pub fn resize(&mut self, count: usize) {
        self.0.resize(count, Block::default());
    }

    /// A point or direction.
    #[inline]
    pub fn get(&self, slot: usize) -> Vec3A {
        let [x, y, z] = &self.0[slot / LANES];
        let lane = slot % LANES;
        Vec3A::new(x[lane], y[lane], z[lane])
    }

    /// Changes a point or direction.
    #[inline]
    pub fn set(&mut self, slot: usize, value: Vec3A) {
        let [x, y, z] = &mut self.0[slot / LANES];
        let lane = slot % LANES;
        (x[lane], y[lane], z[lane]) = (value.x, value.y, value.z);
    }

    /// Hands one point for each particle back.
    pub fn store(&self, order: Order, points: &mut [Vec3A], simd_level: SimdLevel) {
        for band in order.bands() {
            let blocks = &self.0[band.blocks()];
            dispatch!(simd_level.level(), simd => store_blocks(simd, blocks, band, &mut points[band.particles()]));
        }
    }

    /// Takes over one point for each particle.
    pub fn load(&mut self, order: Order, points: &[Vec3A], simd_level: SimdLevel) {
        self.resize(order.block_count());
        for band in order.bands() {
            let blocks = &mut self.0[band.blocks()];
            dispatch!(simd_level.level(), simd => load_blocks(simd, blocks, band, &points[band.particles()]));
        }
    }
}

#[inline(always)]
fn load_blocks<S: Simd>(simd: S, blocks: &mut [Block], band: Band, points: &[Vec3A]) {
    for (some, block) in band.particles_of_blocks().zip(blocks) {
        let points = &points[some];
        let mut rows = [[0.0; 4]; LANES];
        for (row, &point) in rows.iter_mut().zip(points) {
            *row = Vec4::from((point, 0.0)).to_array();
        }
        let [a, b, c, d, e, f, g, h] = &rows;
        let [x, y, z, _] = apart(simd, [a, b, c, d, e, f, g, h]);
        *block = [x.into(), y.into(), z.into()];
    }
}

#[inline(always)]
fn store_blocks<S: Simd>(simd: S, blocks: &[Block], band: Band, points: &mut [Vec3A]) {
    for (some, [x, y, z]) in band.particles_of_blocks().zip(blocks) {
        let (x, y, z) = (lane(simd, x), lane(simd, y), lane(simd, z));
        let rows = together([x, y, z, z]);
        for (point, row) in points[some].iter_mut().zip(rows) {
            *point = Vec3A::from_vec4(Vec4::from_array(row));
        }
    }
}

/// Eight rows of four numbers become four lanes.
#[inline(always)]
pub(crate) fn apart<S: Simd>(simd: S, [a, b, c, d, e, f, g, h]: [&[f32; 4]; LANES]) -> [f32x8<S>; 4] {
    // Spelled out: the compiler doesn't take the closure of an array's `map` along to the instruction set chosen.
    let [x, y, z, w] = transpose_four([row(simd, a), row(simd, b), row(simd, c), row(simd, d)]);
    let [xs, ys, zs, ws] = transpose_four([row(simd, e), row(simd, f), row(simd, g), row(simd, h)]);
    [x.combine(xs), y.combine(ys), z.combine(zs), w.combine(ws)]
}

#[inline(always)]
fn row<S: Simd>(simd: S, values: &[f32; 4]) -> f32x4<S> {
    f32x4::simd_from(simd, *values)
}

/// And back.
#[inline(always)]
pub(crate) fn together<S: Simd>([x, y, z, w]: [f32x8<S>; 4]) -> [[f32; 4]; LANES] {
    let ((x, xs), (y, ys), (z, zs), (w, ws)) = (x.split(), y.split(), z.split(), w.split());
    let ([a, b, c, d], [e, f, g, h]) = (transpose_four([x, y, z, w]), transpose_four([xs, ys, zs, ws]));
    [a.into(), b.into(), c.into(), d.into(), e.into(), f.into(), g.into(), h.into()]
}

/// Rows to columns, by two perfect shuffles.
#[inline(always)]
fn transpose_four<S: Simd>([a, b, c, d]: [f32x4<S>; 4]) -> [f32x4<S>; 4] {
    let ((ac_low, ac_high), (bd_low, bd_high)) = (a.interleave(c), b.interleave(d));
    let ((x, y), (z, w)) = (ac_low.interleave(bd_low), ac_high.interleave(bd_high));
    [x, y, z, w]
}

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
    /// The same for eight rows side by side, column after column: of a lattice.
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
    /// The same for eight rows side by side, column after column: of a lattice.
    pub row_masses: &'a mut [Lane],
}

impl Run<'_> {
    /// What constraints of a lattice work on.
    pub fn sheet(&mut self) -> GridView<'_> {
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
