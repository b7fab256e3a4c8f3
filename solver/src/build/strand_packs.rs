//! Lays strands side by side: eight that share no particle make a strand pack.

use bevy_platform::collections::HashMap;

use super::strands::Strand;
use crate::{
    Spring, SpringKind, StrandPack,
    layout::simd::{LANES, Lane},
};

/// The least share of the places in strand packs that springs have to fill: one strand takes as long as eight. So a mesh that
/// is small or has its strands crossing in one particle is left to springs in colours.
const LEAST_FILLED: f32 = 0.4;

/// Strand packs of all `strands` between `count` particles, and whether each of `springs` is in one. None at all where they
/// wouldn't be filled.
///
/// Strands get colours as springs do, in their order, and those of one colour are sorted by length. Rings are only beside
/// rings of the same length.
pub(super) fn pack(count: usize, strands: &[Strand], springs: &[(SpringKind, Spring)]) -> (Vec<StrandPack>, Vec<bool>) {
    let colors = colors(count, strands);
    let mut sorted: Vec<(u32, &Strand)> = colors.into_iter().zip(strands).collect();
    // Stable, so strands that are alike keep their order.
    sorted.sort_by_key(|(color, strand)| (*color, strand.closed, usize::MAX - strand.springs.len()));
    let may_be_packed = |(color, p): &(u32, &Strand), (other, q): &(u32, &Strand)| {
        let ring = |strand: &Strand| strand.closed.then_some(strand.springs.len());
        color == other && ring(p) == ring(q)
    };
    let mut packer = Packer::new(count, springs);
    let groups = sorted.chunk_by(may_be_packed).flat_map(|group| group.chunks(LANES));
    let strand_packs: Vec<StrandPack> = groups.map(|strands| packer.pack(strands)).collect();
    let places: usize = strand_packs.iter().map(|pack| pack.nodes.len() * LANES).sum();
    let filled: usize = strands.iter().map(|strand| strand.springs.len()).sum();
    if filled as f32 >= LEAST_FILLED * places as f32 {
        (strand_packs, packer.is_packed)
    } else {
        (Vec::new(), vec![false; springs.len()])
    }
}

/// The lowest colour for each strand that no strand before it with a particle in common has.
fn colors(count: usize, strands: &[Strand]) -> Vec<u32> {
    let mut colors_at: Vec<Vec<u32>> = vec![Vec::new(); count];
    let color = |strand: &Strand| {
        let is_taken = |color: &u32| strand.particles.iter().any(|&i| colors_at[i as usize].contains(color));
        let color = (0..).find(|color| !is_taken(color)).unwrap_or_default();
        strand.particles.iter().for_each(|&i| colors_at[i as usize].push(color));
        color
    };
    strands.iter().map(color).collect()
}

/// What is needed to lay strands side by side.
struct Packer<'a> {
    count: usize,
    springs: &'a [(SpringKind, Spring)],
    /// Numbers of the bending springs by their ends, the lower first.
    bends: HashMap<(u32, u32), usize>,
    /// Whether each spring is in a strand pack.
    is_packed: Vec<bool>,
}

impl<'a> Packer<'a> {
    fn new(count: usize, springs: &'a [(SpringKind, Spring)]) -> Self {
        let bends = springs.iter().enumerate().filter(|(_, (kind, _))| *kind == SpringKind::Bend);
        let bends = bends.map(|(i, (_, spring))| (sorted(spring.a, spring.b), i)).collect();
        Self { count, springs, bends, is_packed: vec![false; springs.len()] }
    }

    fn pack(&mut self, strands: &[(u32, &Strand)]) -> StrandPack {
        let length = strands.iter().map(|(_, strand)| strand.particles.len()).max().unwrap_or(0);
        let mut pack = StrandPack {
            nodes: vec![[self.count as u32; LANES]; length],
            stretch: vec![Lane::default(); length],
            bend: vec![Lane::default(); length],
            shares: vec![[Lane::default(); 3]; length],
            closed: strands.iter().any(|(_, strand)| strand.closed),
        };
        for (lane, (_, strand)) in strands.iter().enumerate() {
            for (node, &particle) in pack.nodes.iter_mut().zip(&strand.particles) {
                node[lane] = particle;
            }
            let springs = pack.stretch.iter_mut().zip(&mut pack.shares).zip(&strand.springs);
            for ((stretch, shares), &spring) in springs {
                stretch[lane] = self.take(spring as usize);
                let Spring { rest, share: [warp, weft, shear], .. } = self.springs[spring as usize].1;
                for (lanes, part) in shares.iter_mut().zip([warp, weft, -shear]) {
                    lanes[lane] = if rest > 0.0 { part / rest } else { 0.0 };
                }
            }
            for (bend, &[from, _, to]) in pack.bend.iter_mut().zip(strand.particles.array_windows()) {
                let spring = self.bends.get(&sorted(from, to)).copied();
                bend[lane] = spring.filter(|&spring| !self.is_packed[spring]).map_or(0.0, |spring| self.take(spring));
            }
        }
        if pack.bend.iter().flatten().all(|&rest| rest == 0.0) {
            pack.bend.clear();
        }
        if pack.shares.as_flattened().as_flattened().iter().all(|&share| share == 0.0) {
            pack.shares.clear();
        }
        pack
    }

    /// Takes a spring into a strand pack, and gives its rest length, m.
    fn take(&mut self, spring: usize) -> f32 {
        let rest = self.springs[spring].1.rest;
        self.is_packed[spring] = rest > 0.0;
        rest
    }
}

fn sorted(a: u32, b: u32) -> (u32, u32) {
    (a.min(b), a.max(b))
}
