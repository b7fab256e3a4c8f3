//! Lays strands side by side: eight that share no particle make a strand pack.

use bevy_platform::collections::HashMap;

use super::threads::Thread;
use crate::{
    Spring, SpringKind, StrandPack,
    layout::simd::{LANES, Lane},
};

/// The least share of the places in strand packs that springs have to fill: one strand takes as long as eight. So a mesh that
/// is small or has its threads crossing in one particle is left to springs in colours.
const LEAST_FILLED: f32 = 0.4;

/// Strand packs of all `threads` between `count` particles, and whether each of `springs` is in one. None at all where they
/// wouldn't be filled.
///
/// Threads get colours as springs do, in their order, and those of one colour are sorted by length. Rings are only beside
/// rings of the same length.
pub(super) fn plait(
    count: usize,
    threads: &[Thread],
    springs: &[(SpringKind, Spring)],
) -> (Vec<StrandPack>, Vec<bool>) {
    let colors = colors(count, threads);
    let mut sorted: Vec<(u32, &Thread)> = colors.into_iter().zip(threads).collect();
    // Stable, so threads that are alike keep their order.
    sorted.sort_by_key(|(color, thread)| (*color, thread.closed, usize::MAX - thread.springs.len()));
    let may_be_braided = |(color, p): &(u32, &Thread), (other, q): &(u32, &Thread)| {
        let ring = |thread: &Thread| thread.closed.then_some(thread.springs.len());
        color == other && ring(p) == ring(q)
    };
    let mut plait = Plait::new(count, springs);
    let groups = sorted.chunk_by(may_be_braided).flat_map(|group| group.chunks(LANES));
    let strand_packs: Vec<StrandPack> = groups.map(|threads| plait.braid(threads)).collect();
    let places: usize = strand_packs.iter().map(|braid| braid.nodes.len() * LANES).sum();
    let filled: usize = threads.iter().map(|thread| thread.springs.len()).sum();
    if filled as f32 >= LEAST_FILLED * places as f32 {
        (strand_packs, plait.woven)
    } else {
        (Vec::new(), vec![false; springs.len()])
    }
}

/// The lowest colour for each thread that no thread before it with a particle in common has.
fn colors(count: usize, threads: &[Thread]) -> Vec<u32> {
    let mut colors_at: Vec<Vec<u32>> = vec![Vec::new(); count];
    let color = |thread: &Thread| {
        let is_taken = |color: &u32| thread.particles.iter().any(|&i| colors_at[i as usize].contains(color));
        let color = (0..).find(|color| !is_taken(color)).unwrap_or_default();
        thread.particles.iter().for_each(|&i| colors_at[i as usize].push(color));
        color
    };
    threads.iter().map(color).collect()
}

/// What is needed to lay threads side by side.
struct Plait<'a> {
    count: usize,
    springs: &'a [(SpringKind, Spring)],
    /// Numbers of the bending springs by their ends, the lower first.
    bends: HashMap<(u32, u32), usize>,
    /// Whether each spring is in a strand pack.
    woven: Vec<bool>,
}

impl<'a> Plait<'a> {
    fn new(count: usize, springs: &'a [(SpringKind, Spring)]) -> Self {
        let bends = springs.iter().enumerate().filter(|(_, (kind, _))| *kind == SpringKind::Bend);
        let bends = bends.map(|(i, (_, spring))| (sorted(spring.a, spring.b), i)).collect();
        Self { count, springs, bends, woven: vec![false; springs.len()] }
    }

    fn braid(&mut self, threads: &[(u32, &Thread)]) -> StrandPack {
        let length = threads.iter().map(|(_, thread)| thread.particles.len()).max().unwrap_or(0);
        let mut braid = StrandPack {
            nodes: vec![[self.count as u32; LANES]; length],
            stretch: vec![Lane::default(); length],
            bend: vec![Lane::default(); length],
            shares: vec![[Lane::default(); 3]; length],
            closed: threads.iter().any(|(_, thread)| thread.closed),
        };
        for (lane, (_, thread)) in threads.iter().enumerate() {
            for (node, &particle) in braid.nodes.iter_mut().zip(&thread.particles) {
                node[lane] = particle;
            }
            let springs = braid.stretch.iter_mut().zip(&mut braid.shares).zip(&thread.springs);
            for ((stretch, shares), &spring) in springs {
                stretch[lane] = self.weave(spring as usize);
                let Spring { rest, share: [warp, weft, shear], .. } = self.springs[spring as usize].1;
                for (lanes, part) in shares.iter_mut().zip([warp, weft, -shear]) {
                    lanes[lane] = if rest > 0.0 { part / rest } else { 0.0 };
                }
            }
            for (bend, &[from, _, to]) in braid.bend.iter_mut().zip(thread.particles.array_windows()) {
                let spring = self.bends.get(&sorted(from, to)).copied();
                bend[lane] = spring.filter(|&spring| !self.woven[spring]).map_or(0.0, |spring| self.weave(spring));
            }
        }
        if braid.bend.iter().flatten().all(|&rest| rest == 0.0) {
            braid.bend.clear();
        }
        if braid.shares.as_flattened().as_flattened().iter().all(|&share| share == 0.0) {
            braid.shares.clear();
        }
        braid
    }

    /// Takes a spring into a strand pack, and gives its rest length, m.
    fn weave(&mut self, spring: usize) -> f32 {
        let rest = self.springs[spring].1.rest;
        self.woven[spring] = rest > 0.0;
        rest
    }
}

fn sorted(a: u32, b: u32) -> (u32, u32) {
    (a.min(b), a.max(b))
}
