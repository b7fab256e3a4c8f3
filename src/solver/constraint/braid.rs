//! Threads that lie anywhere on a mesh, as strands: gathered eight side by side, solved, and put back.

use fearless_simd::{dispatch, f32x8, prelude::*};

use super::{
    beads::Beads,
    law::{AnyThreads, Laws},
    strand::{Pack, Rows, Springs},
    weave::Loom,
    yarn::Yarn,
};
use crate::solver::{
    Braid,
    simd::{Instructions, Vec3x8, lane},
};

/// The braids that are to be solved in a substep.
pub(in crate::solver) struct Strung<'a> {
    pub braids: &'a [Braid],
    pub yarn: Yarn,
    pub loom: &'a mut Loom,
}

impl Strung<'_> {
    /// Solves them one after the other.
    pub fn solve(self, beads: &mut Beads, instructions: Instructions) {
        let Self { braids, yarn, loom } = self;
        loom.make_room(braids.iter().map(|braid| braid.nodes.len()).max().unwrap_or(0));
        let level = instructions.level();
        if yarn.is_damped() {
            dispatch!(level, simd => solve_braids::<_, true>(simd, beads, braids, yarn, loom));
        } else {
            dispatch!(level, simd => solve_braids::<_, false>(simd, beads, braids, yarn, loom));
        }
    }
}

#[inline(always)]
fn solve_braids<S: Simd, const DAMPED: bool>(
    simd: S,
    beads: &mut Beads,
    braids: &[Braid],
    yarn: Yarn,
    Loom { rows, position, previous, inverse_mass }: &mut Loom,
) {
    for braid in braids {
        for (j, particles) in braid.nodes.iter().enumerate() {
            let end = beads.end::<S, DAMPED>(simd, particles);
            end.position.store(&mut position[j]);
            if DAMPED {
                end.previous.store(&mut previous[j]);
            }
            inverse_mass[j] = end.inverse_mass.into();
        }
        let mut pack = Pack { position, previous, inverse_mass, stride: braid.nodes.len() };
        match yarn {
            Yarn::Alike { stretch, bend } => {
                if let Some(bend) = bend.filter(|_| !braid.bend.is_empty()) {
                    pack.solve_bends::<S, f32x8<S>, DAMPED>(simd, braid.nodes.len(), &braid.bend, bend);
                }
                if stretch.acts() {
                    solve_stretch::<S, _, DAMPED>(simd, &mut pack, braid, stretch, rows);
                }
            }
            Yarn::Sheet { stretch: gradings, .. } if !braid.shares.is_empty() => {
                let laws = AnyThreads { shares: &braid.shares, gradings };
                solve_stretch::<S, _, DAMPED>(simd, &mut pack, braid, laws, rows);
            }
            Yarn::Sheet { .. } | Yarn::Pulling(_) => {}
        }
        for (j, particles) in braid.nodes.iter().enumerate() {
            beads.put(particles, Vec3x8::load(simd, &position[j]), lane(simd, &inverse_mass[j]));
        }
    }
}

#[inline(always)]
fn solve_stretch<S: Simd, L: Laws<S, f32x8<S>>, const DAMPED: bool>(
    simd: S,
    pack: &mut Pack,
    braid: &Braid,
    laws: L,
    rows: &mut Rows,
) {
    let (count, springs) = (braid.nodes.len(), Springs { rest: &braid.stretch, laws });
    if braid.closed {
        pack.solve::<S, f32x8<S>, L, DAMPED, true>(simd, count, springs, rows);
    } else {
        pack.solve::<S, f32x8<S>, L, DAMPED, false>(simd, count, springs, rows);
    }
}
