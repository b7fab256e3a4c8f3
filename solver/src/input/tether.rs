//! Tethers of a cloth, laid out as the solver reads them.

use crate::{
    layout::{
        order::Order,
        simd::{LANES, Lane},
    },
    topology::{
        Topology,
        level::{Level, TransferOperator},
    },
};

/// The longest distance that a particle may have from a fixed one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tether {
    /// The free particle.
    pub particle: u32,
    /// The fixed particle that holds it.
    pub pin: u32,
    /// Distance between the two along the cloth at rest, m.
    pub length: f32,
}

/// All tethers of a cloth, those of eight particles side by side.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tethers {
    /// Who stands where.
    order: Order,
    /// The particles that hold others.
    pub(crate) pins: Vec<u32>,
    /// Tethers of the particles.
    blocks: Vec<TetherBlock>,
    /// Tethers of each level's nodes.
    levels: Vec<Vec<TetherBlock>>,
    /// The longest of all, m.
    longest: f32,
}

/// Tethers of the eight particles of a block, one each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TetherBlock {
    /// The block.
    pub(crate) block: u32,
    /// The one pin of all eight, as its place in the list of pins.
    pub(crate) only_pin: Option<u32>,
    /// Their pins, as their places in the list.
    pub(crate) pins: [u32; LANES],
    /// Their lengths, m. Infinite where there is no tether.
    pub(crate) lengths: Lane,
}

impl Tethers {
    /// Puts tethers of a cloth side by side. Nodes of its levels have those of their particles.
    pub fn new(tethers: &[Tether], topology: &Topology) -> Self {
        let mut pins: Vec<u32> = tethers.iter().map(|tether| tether.pin).collect();
        pins.sort_unstable();
        pins.dedup();
        let place = |pin: u32| pins.partition_point(|&other| other < pin) as u32;
        let order = topology.order();
        let mut of_slot: Vec<Vec<Tether>> = vec![Vec::new(); order.block_count() * LANES];
        for tether in tethers {
            of_slot[order.slot(tether.particle)].push(Tether { pin: place(tether.pin), ..*tether });
        }
        let of = |slot: u32| of_slot.get(slot as usize).cloned().unwrap_or_default();
        let blocks = (0..order.block_count()).map(|block| core::array::from_fn(|l| of((block * LANES + l) as u32)));
        Self {
            blocks: side_by_side(blocks),
            levels: topology.levels.iter().map(|level| tethers_of_level(level, of)).collect(),
            order,
            pins,
            longest: tethers.iter().map(|tether| tether.length).fold(0.0, f32::max),
        }
    }

    /// The longest of those that there were at first, m.
    pub fn longest(&self) -> f32 {
        self.longest
    }

    /// Drops the tethers to all pins but some.
    pub fn keep(&mut self, is_kept: impl Fn(u32) -> bool) {
        let Self { pins, blocks, levels, .. } = self;
        for blocks in levels.iter_mut().chain([blocks]) {
            for block in blocks.iter_mut() {
                for (length, &pin) in block.lengths.iter_mut().zip(&block.pins) {
                    *length = if is_kept(pins[pin as usize]) { *length } else { f32::INFINITY };
                }
            }
            blocks.retain(|block| block.lengths.iter().any(|&length| length < f32::INFINITY));
        }
    }

    /// Gives the lengths of `built`, of which these are a copy, times the ratio at a slot of the cloth, or of one of its
    /// levels, for the particle that holds it.
    pub(crate) fn stretch(&mut self, built: &Self, ratio: impl Fn(Option<usize>, usize, u32) -> f32) {
        let Self { pins, blocks, levels, .. } = self;
        let of_levels = (0..).map(Some).zip(levels.iter_mut().zip(&built.levels));
        for (level, (blocks, built)) in core::iter::once((None, (blocks, &built.blocks))).chain(of_levels) {
            for (block, built) in blocks.iter_mut().zip(built) {
                for lane in 0..LANES {
                    let slot = block.block as usize * LANES + lane;
                    block.lengths[lane] = built.lengths[lane] * ratio(level, slot, pins[block.pins[lane] as usize]);
                }
            }
        }
    }

    /// Every tether.
    pub fn iter(&self) -> impl Iterator<Item = Tether> {
        let particles: Vec<[Option<u32>; LANES]> = self.order.particles().collect();
        self.blocks.iter().flat_map(move |block| {
            let particles = particles[block.block as usize];
            let held = (0..LANES).filter(|&l| block.lengths[l] < f32::INFINITY);
            let tether = |l: usize| {
                let pin = self.pins[block.pins[l] as usize];
                Some(Tether { particle: particles[l]?, pin, length: block.lengths[l] })
            };
            held.filter_map(tether).collect::<Vec<_>>()
        })
    }

    /// Number of tethers.
    pub fn len(&self) -> usize {
        let lengths = self.blocks.iter().flat_map(|block| block.lengths);
        lengths.filter(|&length| length < f32::INFINITY).count()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }

    /// Tethers of the particles.
    pub(crate) fn of_cloth(&self) -> &[TetherBlock] {
        &self.blocks
    }

    /// Tethers of a level's nodes.
    pub(crate) fn of_level(&self, level: usize) -> &[TetherBlock] {
        self.levels.get(level).map_or(&[], |blocks| blocks)
    }
}

/// Blocks of the tethers of a level's nodes, given those `of` slots.
fn tethers_of_level(level: &Level, of: impl Fn(u32) -> Vec<Tether>) -> Vec<TetherBlock> {
    match &level.transfer {
        TransferOperator::Lattice { slots, .. } => side_by_side(slots.iter().map(|block| block.map(&of))),
        TransferOperator::Chart { nodes, .. } => {
            let tethers: Vec<Vec<Tether>> = nodes.iter().map(|node| tethers_between(node, &of)).collect();
            let block = |nodes: &[Vec<Tether>]| core::array::from_fn(|l| nodes.get(l).cloned().unwrap_or_default());
            side_by_side(tethers.chunks(LANES).map(block))
        }
    }
}

/// Tethers of a point of a triangle: to the pins that all of its corners are held by. A corner that is a pin itself is
/// no way off it.
fn tethers_between((corners, weights): &([u32; 3], [f32; 3]), of: &impl Fn(u32) -> Vec<Tether>) -> Vec<Tether> {
    let corners: Vec<(Vec<Tether>, f32)> =
        (corners.iter().map(|&slot| of(slot)).zip(*weights)).filter(|&(_, weight)| weight > 0.0).collect();
    let Some((first, _)) = corners.first() else { return Vec::new() };
    let to = |pin: u32| {
        let length = |(tethers, weight): &(Vec<Tether>, f32)| {
            Some(tethers.iter().find(|tether| tether.pin == pin)?.length * weight)
        };
        corners.iter().map(length).sum::<Option<f32>>()
    };
    first.iter().filter_map(|&tether| Some(Tether { length: to(tether.pin)?, ..tether })).collect()
}

/// Blocks of the tethers of particles in blocks. As many lanes of one as can have the same pin.
fn side_by_side(particles: impl Iterator<Item = [Vec<Tether>; LANES]>) -> Vec<TetherBlock> {
    let mut blocks = Vec::new();
    for (number, mut left) in (0..).zip(particles) {
        while let Some(&Tether { pin, .. }) = left.iter().flatten().next() {
            let mut block =
                TetherBlock { block: number, only_pin: None, pins: [pin; LANES], lengths: [f32::INFINITY; LANES] };
            for (lane, left) in left.iter_mut().enumerate().filter(|(_, left)| !left.is_empty()) {
                let tether = left.remove(left.iter().position(|tether| tether.pin == pin).unwrap_or(0));
                (block.pins[lane], block.lengths[lane]) = (tether.pin, tether.length);
            }
            block.only_pin = block.pins.iter().all(|&other| other == pin).then_some(pin);
            blocks.push(block);
        }
    }
    blocks
}
