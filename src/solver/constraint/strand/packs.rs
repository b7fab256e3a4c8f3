//! Threads that lie anywhere on a mesh, as strands: gathered eight side by side, solved, and put back.

use fearless_simd::{dispatch, f32x8, prelude::*};

use crate::solver::{
    constraint::strand::{
        grid::StrandScratch,
        law::{GatheredStrandLaws, StrandLaws},
        material::StrandMaterial,
        tridiagonal::{EliminationRows, StrandLanes, StrandSprings},
    },
    layout::simd::{SimdLevel, Vec3x8, lane},
    particles::gathered::GatheredParticles,
    topology::strand_pack::StrandPack,
};

/// The braids that are to be solved in a substep.
pub(crate) struct StrandPackSolver<'a> {
    pub strand_packs: &'a [StrandPack],
    pub yarn: StrandMaterial,
    pub strand_scratch: &'a mut StrandScratch,
}

impl StrandPackSolver<'_> {
    /// Solves them one after the other.
    pub fn solve(self, beads: &mut GatheredParticles, simd_level: SimdLevel) {
        let Self { strand_packs, yarn, strand_scratch } = self;
        strand_scratch.make_room(strand_packs.iter().map(|braid| braid.nodes.len()).max().unwrap_or(0));
        let level = simd_level.level();
        if yarn.is_damped() {
            dispatch!(level, simd => solve_braids::<_, true>(simd, beads, strand_packs, yarn, strand_scratch));
        } else {
            dispatch!(level, simd => solve_braids::<_, false>(simd, beads, strand_packs, yarn, strand_scratch));
        }
    }
}

#[inline(always)]
fn solve_braids<S: Simd, const DAMPED: bool>(
    simd: S,
    beads: &mut GatheredParticles,
    strand_packs: &[StrandPack],
    yarn: StrandMaterial,
    StrandScratch { rows, position, previous, inverse_mass }: &mut StrandScratch,
) {
    for braid in strand_packs {
        for (j, particles) in braid.nodes.iter().enumerate() {
            let end = beads.end::<S, DAMPED>(simd, particles);
            end.position.store(&mut position[j]);
            if DAMPED {
                end.previous.store(&mut previous[j]);
            }
            inverse_mass[j] = end.inverse_mass.into();
        }
        let mut pack = StrandLanes { position, previous, inverse_mass, stride: braid.nodes.len() };
        match yarn {
            StrandMaterial::Alike { stretch, bend } => {
                if let Some(bend) = bend.filter(|_| !braid.bend.is_empty()) {
                    pack.solve_bends::<S, f32x8<S>, DAMPED>(simd, braid.nodes.len(), &braid.bend, bend);
                }
                if stretch.acts() {
                    solve_stretch::<S, _, DAMPED>(simd, &mut pack, braid, stretch, rows);
                }
            }
            StrandMaterial::GridView { stretch: gradings, .. } if !braid.shares.is_empty() => {
                let laws = GatheredStrandLaws { shares: &braid.shares, gradings };
                solve_stretch::<S, _, DAMPED>(simd, &mut pack, braid, laws, rows);
            }
            StrandMaterial::GridView { .. } | StrandMaterial::SpringResponse(_) => {}
        }
        for (j, particles) in braid.nodes.iter().enumerate() {
            beads.put(particles, Vec3x8::load(simd, &position[j]), lane(simd, &inverse_mass[j]));
        }
    }
}

#[inline(always)]
fn solve_stretch<S: Simd, L: StrandLaws<S, f32x8<S>>, const DAMPED: bool>(
    simd: S,
    pack: &mut StrandLanes,
    braid: &StrandPack,
    laws: L,
    rows: &mut EliminationRows,
) {
    let (count, springs) = (braid.nodes.len(), StrandSprings { rest: &braid.stretch, laws });
    if braid.closed {
        pack.solve::<S, f32x8<S>, L, DAMPED, true>(simd, count, springs, rows);
    } else {
        pack.solve::<S, f32x8<S>, L, DAMPED, false>(simd, count, springs, rows);
    }
}
