//! Rest lengths of a cloth whose entity is scaled while it runs: those of its rest shape, stretched.
//!
//! What is joined with what stays as it was built, so that this takes a small part of the time of a step. Lengths follow,
//! and weights of bends with them; masses stay, and so do the shares of the moduli that springs have.

use bevy_math::{Mat3A, Vec3};

use super::faces;
use crate::{
    Bend, Face, Lattice, Level, StrandPack, StrandSet, Tethers, Topology, TransferOperator,
    layout::simd::{LANES, Lane},
    topology::{bend_pack::BendPack, face_pack::FacePack},
};

/// Where particles, or nodes of a level, are at rest, by their slots.
struct Places {
    /// As they were built, m. NaN where nobody is.
    built: Vec<Vec3>,
    /// Stretched, m.
    stretched: Vec<Vec3>,
}

impl Places {
    fn new(built: Vec<Vec3>, stretch: Mat3A) -> Self {
        let stretched = built.iter().map(|&place| stretch * place).collect();
        Self { built, stretched }
    }

    /// By how many times the way between two places has become longer, here and in `other`. 1 where one of them is nowhere.
    fn ratio_to(&self, slot: usize, other: &Self, other_slot: usize) -> f32 {
        let length = |from: &[Vec3], to: &[Vec3]| Some(from.get(slot)?.distance(*to.get(other_slot)?));
        let lengths = length(&self.stretched, &other.stretched).zip(length(&self.built, &other.built));
        let ratio = lengths.map_or(1.0, |(stretched, built)| stretched / built);
        if ratio.is_normal() { ratio } else { 1.0 }
    }

    fn ratio(&self, a: usize, b: usize) -> f32 {
        self.ratio_to(a, self, b)
    }
}

/// Makes `topology` and `tethers`, copies of those of a cloth as it was built, those of the same cloth with its rest shape
/// stretched by `stretch`.
pub fn stretch(
    (topology, tethers): (&mut Topology, &mut Tethers),
    (built, built_tethers): (&Topology, &Tethers),
    stretch: Mat3A,
) {
    let order = built.order();
    let place = |particle: Option<u32>| particle.map_or(Vec3::NAN, |particle| built.rest[particle as usize]);
    let places = Places::new(order.particles().flatten().map(place).collect(), stretch);
    let ratio = |a: u32, b: u32| places.ratio(order.slot(a), order.slot(b));
    topology.rest.clear();
    topology.rest.extend(built.rest.iter().map(|&place| stretch * place));
    for (spring, built) in topology.springs.iter_mut().zip(&built.springs) {
        spring.rest = built.rest * ratio(built.a, built.b);
    }
    for (face, built_face) in topology.faces.iter_mut().zip(&built.faces) {
        *face = stretched_face(built_face, &built.rest, &topology.rest, stretch);
    }
    for (pack, run) in topology.face_packs.iter_mut().zip(&topology.face_batches) {
        *pack = FacePack::new(&topology.faces[run.clone()], topology.rest.len() as u32);
    }
    let mut shortest = f32::INFINITY;
    for (bend, built) in topology.bends.iter_mut().zip(&built.bends) {
        let [from, to, ..] = built.particles;
        let ratio = ratio(from, to);
        shortest = shortest.min(ratio);
        *bend = Bend { weights: built.weights.map(|weight| weight / ratio), ..*built };
    }
    for (pack, batch) in topology.bend_packs.iter_mut().zip(&topology.bend_batches) {
        *pack = BendPack::new(&topology.bends[batch.range.clone()], topology.rest.len() as u32);
    }
    if let Some(two_grid) = &mut topology.two_grid {
        two_grid.is_stretched = true;
    }
    // It goes by the square of the weights: the areas stay, and with them the masses.
    topology.bend_rate = built.bend_rate / if shortest < f32::INFINITY { shortest * shortest } else { 1.0 };
    if let Some((lattice, built)) = topology.lattice.as_mut().zip(built.lattice.as_ref()) {
        stretch_lattice(lattice, built, &places);
    }
    for (pack, built) in topology.strand_packs.iter_mut().zip(&built.strand_packs) {
        stretch_pack(pack, built, &ratio);
    }
    let mut of_levels = Vec::new();
    for (level, built) in topology.levels.iter_mut().zip(&built.levels) {
        let nodes = Places::new(nodes(built, &places.built), stretch);
        stretch_lattice(&mut level.lattice, &built.lattice, &nodes);
        of_levels.push(nodes);
    }
    tethers.stretch(built_tethers, |level, slot, pin| {
        level.map_or(&places, |level| &of_levels[level]).ratio_to(slot, &places, order.slot(pin))
    });
}

/// Where the nodes of a level are, by their slots, among particles at `places`.
fn nodes(level: &Level, places: &[Vec3]) -> Vec<Vec3> {
    let place = |slot: u32| places.get(slot as usize).copied().unwrap_or(Vec3::NAN);
    match &level.transfer {
        TransferOperator::Lattice { slots, .. } => slots.iter().flatten().map(|&slot| place(slot)).collect(),
        TransferOperator::Chart { nodes, .. } => {
            let node = |(corners, weights): &([u32; 3], [f32; 3])| {
                corners.iter().zip(weights).map(|(&corner, &weight)| place(corner) * weight).sum()
            };
            nodes.iter().map(node).collect()
        }
    }
}

fn stretch_lattice(lattice: &mut Lattice, built: &Lattice, places: &Places) {
    let order = built.order();
    // From a place by so many columns and rows; the column after the last is the first of a ring.
    let ratio = |(row, column): (usize, usize), (rows, columns): (usize, usize)| {
        let to = (row + rows, (column + columns) % built.columns);
        let is_inside = row < built.rows && column < built.columns && to.0 < built.rows;
        if is_inside { places.ratio(order.slot_at(row, column), order.slot_at(to.0, to.1)) } else { 1.0 }
    };
    let along_row = |pack: usize, node: usize, lane: usize| (pack * LANES + lane, node);
    let along_column = |pack: usize, node: usize, lane: usize| (node, pack * LANES + lane);
    stretch_strands(&mut lattice.along_rows, &built.along_rows, |at, steps| {
        ratio(along_row(at.0, at.1, at.2), (0, steps))
    });
    stretch_strands(&mut lattice.along_columns, &built.along_columns, |at, steps| {
        ratio(along_column(at.0, at.1, at.2), (steps, 0))
    });
    // The diagonals of a cell begin at its first column and at its second.
    for (i, lane) in lattice.falling.iter_mut().enumerate() {
        let at = |l: usize| along_column(i / built.rows, i % built.rows, l);
        *lane = core::array::from_fn(|l| built.falling[i][l] * ratio(at(l), (1, 1)));
    }
    for (i, lane) in lattice.rising.iter_mut().enumerate() {
        let at = |l: usize| along_column(i / built.rows, i % built.rows, l);
        *lane = core::array::from_fn(|l| {
            let (row, column) = at(l);
            // From the next row of this column to this row of the next.
            let is_inside = row + 1 < built.rows && column + 1 < built.columns;
            let ends = || places.ratio(order.slot_at(row + 1, column), order.slot_at(row, column + 1));
            built.rising[i][l] * if is_inside { ends() } else { 1.0 }
        });
    }
    for (i, (twist, built_twist)) in lattice.twist.iter_mut().zip(&built.twist).enumerate() {
        let at = |l: usize| along_column(i / built.rows, i % built.rows, l);
        *twist = core::array::from_fn(|l| built_twist[l] / ratio(at(l), (1, 1)));
    }
}

/// Stretches strands by the ratio at (pack, node, lane), over so many steps.
fn stretch_strands(strands: &mut StrandSet, built: &StrandSet, ratio: impl Fn((usize, usize, usize), usize) -> f32) {
    for i in 0..built.stretch.len() {
        let (pack, node) = (i / built.nodes, i % built.nodes);
        let lane = |steps: usize| -> Lane { core::array::from_fn(|l| ratio((pack, node, l), steps)) };
        let (one, two) = (lane(1), lane(2));
        // The bend at a node begins at the one before.
        let around: Lane = core::array::from_fn(|l| node.checked_sub(1).map_or(1.0, |node| ratio((pack, node, l), 2)));
        for l in 0..LANES {
            strands.stretch[i][l] = built.stretch[i][l] * one[l];
            strands.bend[i][l] = built.bend[i][l] * two[l];
            for part in 0..2 {
                strands.shares[i][part][l] = built.shares[i][part][l] / one[l];
                strands.curvature[i][part][l] = built.curvature[i][part][l] / around[l];
            }
        }
    }
}

fn stretch_pack(pack: &mut StrandPack, built: &StrandPack, ratio: &impl Fn(u32, u32) -> f32) {
    let count = built.nodes.len();
    for i in 0..count {
        for l in 0..LANES {
            let over = |steps: usize| ratio(built.nodes[i][l], built.nodes[(i + steps) % count][l]);
            let along = over(1);
            pack.stretch[i][l] = built.stretch[i][l] * along;
            if let Some((bend, built)) = pack.bend.get_mut(i).zip(built.bend.get(i)) {
                bend[l] = built[l] * over(2);
            }
            if let Some((shares, built)) = pack.shares.get_mut(i).zip(built.shares.get(i)) {
                (0..3).for_each(|part| shares[part][l] = built[part][l] / along);
            }
        }
    }
}

/// A face whose corners have gone from `built` to `rest`. Its warp goes along, as strands do.
fn stretched_face(face: &Face, built: &[Vec3], rest: &[Vec3], stretch: Mat3A) -> Face {
    let [a, b, c] = face.particles.map(|i| built[i as usize]);
    let warp = (b - a) * face.warp[0] + (c - a) * face.warp[1];
    // Its area is that of its mass still.
    let stretched = faces::face(rest, face.particles, stretch * warp);
    stretched.map_or(*face, |stretched| Face { area: face.area, ..stretched })
}
