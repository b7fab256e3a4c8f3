//! The particles of one cloth while a step runs: in blocks of eight, component by component, so that eight can be worked
//! on side by side.

use bevy::math::{Vec3A, Vec4};
use fearless_simd::{dispatch, f32x4, f32x8, prelude::*};

use super::{
    Particles,
    simd::{Instructions, LANES, Lane, lane},
};

/// Rows that are taken over at a time. Those of a large cloth are a page of memory each: more of them at once than the
/// processor has pages at hand is slow.
const NEAR_ROWS: usize = 16;

/// Eight points or directions: all x, all y, all z.
pub type Block = [Lane; 3];

/// In which block, and where in it, a particle stands: its slot.
///
/// Particles in rows and columns stand in blocks of eight columns, and those one below the other: a column of blocks is
/// eight threads side by side. Others stand in their own order, as if in one row. The last column of blocks is filled
/// up with slots in which nobody stands.
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

    /// The slot of the particle at a row and column.
    pub fn slot_at(&self, row: usize, column: usize) -> usize {
        ((column / LANES) * self.rows + row) * LANES + column % LANES
    }

    /// The slot of a particle.
    #[inline]
    pub fn slot(&self, particle: u32) -> usize {
        let (particle, columns) = (particle as usize, self.columns);
        if self.rows == 1 { particle } else { self.slot_at(particle / columns, particle % columns) }
    }

    /// First particle and number of particles of each block.
    #[inline(always)]
    pub fn blocks(self) -> impl Iterator<Item = (usize, usize)> {
        let Self { rows, columns } = self;
        (0..columns).step_by(LANES).flat_map(move |column| {
            let count = LANES.min(columns - column);
            (0..rows).map(move |row| (row * columns + column, count))
        })
    }

    /// Number, first particle and number of particles of each block, a few rows at a time: what is next to each other
    /// among the particles and among the blocks is visited within a short time.
    #[inline(always)]
    fn near_blocks(self) -> impl Iterator<Item = (usize, usize, usize)> {
        let Self { rows, columns } = self;
        (0..rows).step_by(NEAR_ROWS).flat_map(move |near| {
            (0..columns).step_by(LANES).flat_map(move |column| {
                let count = LANES.min(columns - column);
                let block = move |row: usize| (column / LANES * rows + row, row * columns + column, count);
                (near..rows.min(near + NEAR_ROWS)).map(block)
            })
        })
    }

    /// The particle in each lane of a block, if there is one.
    pub fn particles(self) -> impl Iterator<Item = [Option<u32>; LANES]> {
        self.blocks().map(|(first, count)| core::array::from_fn(|l| (l < count).then_some((first + l) as u32)))
    }
}

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

    /// Takes over one point for each particle.
    pub fn load(&mut self, order: Order, points: &[Vec3A], instructions: Instructions) {
        self.resize(order.block_count());
        dispatch!(instructions.level(), simd => self.load_blocks(simd, order, points));
    }

    #[inline(always)]
    fn load_blocks<S: Simd>(&mut self, simd: S, order: Order, points: &[Vec3A]) {
        for (block, first, count) in order.near_blocks() {
            let points = &points[first..first + count];
            let mut rows = [[0.0; 4]; LANES];
            for (row, &point) in rows.iter_mut().zip(points) {
                *row = Vec4::from((point, 0.0)).to_array();
            }
            let [a, b, c, d, e, f, g, h] = &rows;
            let [x, y, z, _] = apart(simd, [a, b, c, d, e, f, g, h]);
            self.0[block] = [x.into(), y.into(), z.into()];
        }
    }

    /// Hands back one point for each particle.
    pub fn store(&self, order: Order, points: &mut [Vec3A], instructions: Instructions) {
        dispatch!(instructions.level(), simd => self.store_blocks(simd, order, points));
    }

    #[inline(always)]
    fn store_blocks<S: Simd>(&self, simd: S, order: Order, points: &mut [Vec3A]) {
        for (block, first, count) in order.near_blocks() {
            let [x, y, z] = &self.0[block];
            let (x, y, z) = (lane(simd, x), lane(simd, y), lane(simd, z));
            let rows = together([x, y, z, z]);
            for (point, row) in points[first..first + count].iter_mut().zip(rows) {
                *point = Vec3A::from_vec4(Vec4::from_array(row));
            }
        }
    }
}

/// Eight rows of four numbers become four lanes.
#[inline(always)]
pub(super) fn apart<S: Simd>(simd: S, [a, b, c, d, e, f, g, h]: [&[f32; 4]; LANES]) -> [f32x8<S>; 4] {
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
pub(super) fn together<S: Simd>([x, y, z, w]: [f32x8<S>; 4]) -> [[f32; 4]; LANES] {
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
}

impl Lanes {
    /// Takes over the state of a cloth.
    pub fn load(&mut self, particles: &Particles, order: Order, instructions: Instructions) {
        self.order = order;
        self.previous.resize(order.block_count());
        self.position.load(order, &particles.position, instructions);
        self.velocity.load(order, &particles.velocity, instructions);
        self.inverse_mass.resize(order.block_count(), Lane::default());
        for (block, first, count) in order.near_blocks() {
            let lane = &mut self.inverse_mass[block];
            let masses = &particles.inverse_mass[first..first + count];
            match masses.as_array() {
                Some(masses) => *lane = *masses,
                None => {
                    *lane = Lane::default();
                    lane[..count].copy_from_slice(masses);
                }
            }
        }
    }

    /// Hands the state back.
    pub fn store(&self, particles: &mut Particles, instructions: Instructions) {
        self.position.store(self.order, &mut particles.position, instructions);
        self.velocity.store(self.order, &mut particles.velocity, instructions);
    }

    /// Inverse mass of the particle in a slot, 1/kg.
    #[inline]
    pub fn inverse_mass(&self, slot: usize) -> f32 {
        self.inverse_mass[slot / LANES][slot % LANES]
    }

    /// Number of slots.
    pub fn slot_count(&self) -> usize {
        self.inverse_mass.len() * LANES
    }
}

/// Some blocks of a cloth, one after the other.
#[derive(Debug)]
pub(super) struct Run<'a> {
    /// Number of the first block.
    pub first: usize,
    /// Position, m.
    pub position: &'a mut [Block],
    /// Position at the start of the substep, m.
    pub previous: &'a mut [Block],
    /// Velocity, m/s.
    pub velocity: &'a mut [Block],
    /// Inverse mass, 1/kg.
    pub inverse_mass: &'a [Lane],
}

impl Lanes {
    /// All blocks.
    pub(super) fn whole(&mut self) -> Run<'_> {
        let Self { position, previous, velocity, inverse_mass, .. } = self;
        Run { first: 0, position: &mut position.0, previous: &mut previous.0, velocity: &mut velocity.0, inverse_mass }
    }

    /// All blocks, in parts of `count`.
    pub(super) fn parts(&mut self, count: usize) -> impl Iterator<Item = Run<'_>> {
        let Run { position, previous, velocity, inverse_mass, .. } = self.whole();
        let moving = position.chunks_mut(count).zip(previous.chunks_mut(count)).zip(velocity.chunks_mut(count));
        let all = (0..).step_by(count).zip(moving).zip(inverse_mass.chunks(count));
        all.map(|((first, ((position, previous), velocity)), inverse_mass)| Run {
            first,
            position,
            previous,
            velocity,
            inverse_mass,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_taken_over_comes_back_the_same() {
        for (rows, columns) in [(1, 1), (1, 8), (1, 41), (3, 7), (5, 17), (9, 16)] {
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
            lanes.load(&particles, order, Instructions::Best);
            let last = order.slot(count as u32 - 1);
            assert_eq!(lanes.position.get(last), particles.position[count - 1]);
            assert_eq!(lanes.inverse_mass.as_flattened().iter().sum::<f32>(), count as f32);
            let (position, velocity) = (vec![Vec3A::ONE; count], vec![Vec3A::ONE; count]);
            let mut back = Particles { position, velocity, ..particles.clone() };
            lanes.store(&mut back, Instructions::Baseline);
            assert_eq!(back, particles);
        }
    }
}
