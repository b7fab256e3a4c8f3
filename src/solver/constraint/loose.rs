//! What joins particles wherever they are in the order: one way to the beads and back for all of it.

use super::{
    beads::Beads,
    braid::Strung,
    spring::{self, Scaled},
};
use crate::solver::{Instructions, Lanes, Material, SpringBatch, SpringKind, Topology};

/// Springs are few where there are so many particles for each: going to the beads and back would take longer.
const FEW: usize = 4;

/// What is to be solved in a substep.
pub(in crate::solver) struct Loose<'a> {
    pub topology: &'a Topology,
    pub material: &'a Material,
    /// Duration of the substep, s.
    pub h: f32,
    /// Whether also what is woven.
    pub woven: bool,
    /// The braids, where they are solved as such.
    pub strung: Option<Strung<'a>>,
}

impl Loose<'_> {
    /// Solves springs once, batch after batch, and then the braids.
    pub fn solve(self, lanes: &mut Lanes, beads: &mut Beads, instructions: Instructions) {
        let Self { topology, material, h, woven, strung } = self;
        let batches = topology.batches.iter().filter(|batch| woven || !batch.woven);
        let batches = batches.map(|batch| (batch, Scaled::new(material.alike(batch.kind), h)));
        let batches = batches.filter(|(_, constants)| constants.acts());
        let springs = |batch: &SpringBatch| &topology.springs[batch.range.clone()];
        let count: usize = batches.clone().map(|(batch, _)| batch.range.len()).sum();
        if strung.is_none() && count * FEW <= lanes.order.particle_count() {
            for (batch, constants) in batches {
                spring::solve_few(lanes, springs(batch), constants, instructions);
            }
            return;
        }
        let is_damped = SpringKind::ALL.iter().any(|&kind| material.alike(kind).damping > 0.0);
        beads.read(lanes, is_damped, instructions);
        for (batch, constants) in batches {
            spring::solve(beads, springs(batch), constants, instructions);
        }
        if let Some(strung) = strung {
            strung.solve(beads, instructions);
        }
        beads.write(lanes, instructions);
    }
}
