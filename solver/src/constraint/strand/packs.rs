//! Strands that lie anywhere on a mesh, as strands: gathered eight side by side, solved, and put back.

use fearless_simd::{dispatch, f32x8, prelude::*};

use crate::{
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

/// The strand packs that are to be solved in a substep.
pub(crate) struct StrandPackSolver<'a> {
    pub strand_packs: &'a [StrandPack],
    pub strand_material: StrandMaterial,
    pub strand_scratch: &'a mut StrandScratch,
}

impl StrandPackSolver<'_> {
    /// Solves them one after the other.
    pub fn solve(self, gathered: &mut GatheredParticles, simd_level: SimdLevel) {
        let Self { strand_packs, strand_material, strand_scratch } = self;
        strand_scratch.make_room(strand_packs.iter().map(|strand_pack| strand_pack.nodes.len()).max().unwrap_or(0));
        let level = simd_level.level();
        if strand_material.is_damped() {
            dispatch!(level, simd => solve_packs::<_, true>(simd, gathered, strand_packs, strand_material, strand_scratch));
        } else {
            dispatch!(level, simd => solve_packs::<_, false>(simd, gathered, strand_packs, strand_material, strand_scratch));
        }
    }
}

#[inline(always)]
fn solve_packs<S: Simd, const DAMPED: bool>(
    simd: S,
    gathered: &mut GatheredParticles,
    strand_packs: &[StrandPack],
    strand_material: StrandMaterial,
    StrandScratch { rows, position, previous, inverse_mass }: &mut StrandScratch,
) {
    for strand_pack in strand_packs {
        for (j, particles) in strand_pack.nodes.iter().enumerate() {
            let end = gathered.end::<S, DAMPED>(simd, particles);
            end.position.store(&mut position[j]);
            if DAMPED {
                end.previous.store(&mut previous[j]);
            }
            inverse_mass[j] = end.inverse_mass.into();
        }
        let mut pack = StrandLanes { position, previous, inverse_mass, stride: strand_pack.nodes.len() };
        match strand_material {
            StrandMaterial::Alike { stretch, bend } => {
                if let Some(bend) = bend.filter(|_| !strand_pack.bend.is_empty()) {
                    pack.solve_bends::<S, f32x8<S>, DAMPED>(simd, strand_pack.nodes.len(), &strand_pack.bend, bend);
                }
                if stretch.acts() {
                    solve_stretch::<S, _, DAMPED>(simd, &mut pack, strand_pack, stretch, rows);
                }
            }
            StrandMaterial::SheetStrands { stretch: gradings, .. } if !strand_pack.shares.is_empty() => {
                let laws = GatheredStrandLaws { shares: &strand_pack.shares, gradings };
                solve_stretch::<S, _, DAMPED>(simd, &mut pack, strand_pack, laws, rows);
            }
            StrandMaterial::SheetStrands { .. } | StrandMaterial::LevelSprings(_) => {}
        }
        for (j, particles) in strand_pack.nodes.iter().enumerate() {
            gathered.put(particles, Vec3x8::load(simd, &position[j]), lane(simd, &inverse_mass[j]));
        }
    }
}

#[inline(always)]
fn solve_stretch<S: Simd, L: StrandLaws<S, f32x8<S>>, const DAMPED: bool>(
    simd: S,
    pack: &mut StrandLanes,
    strand_pack: &StrandPack,
    laws: L,
    rows: &mut EliminationRows,
) {
    let (count, springs) = (strand_pack.nodes.len(), StrandSprings { rest: &strand_pack.stretch, laws });
    if strand_pack.closed {
        pack.solve::<S, f32x8<S>, L, DAMPED, true>(simd, count, springs, rows);
    } else {
        pack.solve::<S, f32x8<S>, L, DAMPED, false>(simd, count, springs, rows);
    }
}
