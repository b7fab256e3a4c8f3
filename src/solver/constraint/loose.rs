//! What joins particles wherever they are in the order: one way to the beads and back for all of it.

use super::{
    beads::Beads,
    bend::{self, Bending, Ways},
    braid::Strung,
    face,
    law::Grading,
    spring::{self, BatchLaw},
};
use crate::solver::{Instructions, Lanes, Material, SpringBatch, Topology};

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
    /// How bends are solved, if there are any.
    pub bending: Option<Bending>,
    /// The braids, where they are solved as such.
    pub strung: Option<Strung<'a>>,
}

impl Loose<'_> {
    /// Solves bends, faces and springs once, batch after batch, and then the braids. What comes last is held best: stretch
    /// shows more than bending.
    pub fn solve(self, lanes: &mut Lanes, beads: &mut Beads, ways: &mut Ways, instructions: Instructions) {
        let Self { topology, material, h, woven, bending, strung } = self;
        let sheet = material.moduli().map(|moduli| Grading::both(moduli, h));
        let batches = topology.batches.iter().filter(|batch| woven || !batch.woven);
        let batches = batches.filter_map(|batch| Some((batch, BatchLaw::new(material, batch, h)?)));
        let springs = |batch: &SpringBatch| &topology.springs[batch.range.clone()];
        let count: usize = batches.clone().map(|(batch, _)| batch.range.len()).sum();
        let only_springs = strung.is_none() && bending.is_none() && (sheet.is_none() || topology.faces.is_empty());
        if only_springs && count * FEW <= lanes.order.particle_count() {
            for (batch, law) in batches {
                spring::solve_few(lanes, springs(batch), law, instructions);
            }
            return;
        }
        beads.read(lanes, material.is_damped(), instructions);
        if let Some(bending) = bending {
            bend::solve(beads, ways, topology, woven, bending, instructions);
        }
        if let Some(sheet) = &sheet {
            for batch in &topology.face_batches {
                face::solve(beads, &topology.faces[batch.clone()], sheet, instructions);
            }
        }
        for (batch, law) in batches {
            spring::solve(beads, springs(batch), law, instructions);
        }
        if let Some(strung) = strung {
            strung.solve(beads, instructions);
        }
        beads.write(lanes, instructions);
    }
}
