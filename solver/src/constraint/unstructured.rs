//! What joins particles wherever they are in the order: gathered once, and put back once, for all of it.

use crate::{
    constraint::{
        strand::packs::StrandPackSolver,
        unstructured::{
            bend::{BendSolver, stages::ChebyshevBuffers},
            spring::BatchLaw,
        },
    },
    layout::simd::SimdLevel,
    material::Material,
    particles::{gathered::GatheredParticles, lanes::Lanes},
    topology::{SpringBatch, Topology},
};

pub(crate) mod bend;
pub(crate) mod diagonal;
pub(crate) mod face;
pub mod spring;

/// Springs are few where there are so many particles for each: gathering them and putting them back would take longer.
const FEW: usize = 4;

/// What is to be solved in a substep.
pub(crate) struct UnstructuredPass<'a> {
    pub topology: &'a Topology,
    pub material: &'a Material,
    /// Duration of the substep, s.
    pub h: f32,
    /// Whether also what is on strands.
    pub with_strands: bool,
    /// How bends are solved, if there are any.
    pub bending: Option<BendSolver>,
    /// The strand packs, where they are solved as such.
    pub strand_pack_solver: Option<StrandPackSolver<'a>>,
}

impl UnstructuredPass<'_> {
    /// Solves bends and springs once, batch after batch, and then the strand packs. What comes last is held best: stretch
    /// shows more than bending.
    pub fn solve(
        self,
        lanes: &mut Lanes,
        gathered: &mut GatheredParticles,
        ways: &mut ChebyshevBuffers,
        simd_level: SimdLevel,
    ) {
        let Self { topology, material, h, with_strands, bending, strand_pack_solver } = self;
        let batches = topology.batches.iter().filter(|batch| with_strands || !batch.on_strand);
        let batches = batches.filter_map(|batch| Some((batch, BatchLaw::new(material, batch, h)?)));
        let springs = |batch: &SpringBatch| &topology.springs[batch.range.clone()];
        let count: usize = batches.clone().map(|(batch, _)| batch.range.len()).sum();
        let only_springs = strand_pack_solver.is_none() && bending.is_none();
        if only_springs && count * FEW <= lanes.order.particle_count() {
            for (batch, law) in batches {
                spring::solve_few(lanes, springs(batch), law, simd_level);
            }
            return;
        }
        gathered.read(lanes, material.is_damped(), simd_level);
        if let Some(bending) = bending {
            bend::solve(gathered, ways, topology, with_strands, bending, simd_level);
        }
        for (batch, law) in batches {
            spring::solve(gathered, springs(batch), law, simd_level);
        }
        if let Some(strand_pack_solver) = strand_pack_solver {
            strand_pack_solver.solve(gathered, simd_level);
        }
        gathered.write(lanes, simd_level);
    }
}
