//! Resistance of any sheet to bending.
//!
//! ```text
//!         3
//!       /   \             s = Σ c x: how much it is bent        energy  B/2 |s - R r|²
//!     0 ----- 1           r = what that is at rest, and R its turn since then: that of the
//!       \   /             particles' own frame, along 0-1, across from 2 to 3, and normal
//!         2
//! ```
//!
//! As R turns with the particles, so does the force have a part along its gradient, (s × (s - R r)) over the lengths: with
//! it a bend turns nothing as a whole. Where the cloth is flat at rest, r = 0 and the force is linear: Bergou et al., "A
//! Quadratic Bending Model for Inextensible Surfaces" (2006). Damping follows how s changes in the frame, which a turn
//! of the whole doesn't do.
//!
//! Bends push their particles to and fro many times as hard as the cloth resists as a whole, so going from one to the next
//! and solving each leaves the cloth much too soft: more than twice as soft where the cells are a fifth of the length over
//! which it bends. So all are taken together, in stages that are no harder to compute than the forces of the textbook, and
//! together as stable as an implicit step:
//!
//! x' = T(w0 - w1 W H) / T(w0) x        T the Chebyshev polynomial whose degree is the number of stages
//!
//! with H the second derivatives of the energy, times h². w1 is such that slow ways to move, which are the shape that one
//! sees, get just their force, so that a cloth at rest hangs as it should whatever the substep is. What swings faster than
//! the substeps can show is reduced to a quarter or less; it is then wrong by about as much as it falls in one substep.
//! This is the first order Runge-Kutta-Chebyshev method: van der Houwen and Sommeijer, "On the Internal Stability of
//! Explicit, m-Stage Runge-Kutta Methods for Large m-Values" (1980), with much more damping. The number of stages is about
//! the root of the fastest rate, so with shorter substeps there are fewer: for each second they cost the same.

use fearless_simd::dispatch;

use crate::{
    constraint::unstructured::bend::{
        element8::pull_batch,
        stages::{ChebyshevBuffers, Stages},
    },
    layout::simd::SimdLevel,
    material::Material,
    particles::{gathered::GatheredParticles, lanes::Lanes},
    topology::Topology,
};

pub(crate) mod element;
pub(crate) mod element8;
pub(crate) mod stages;

/// How much stiffer a bend may be because of what is in the turn of its frame.
const TURNING: f32 = 2.0;

/// How bends answer in substeps of h seconds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BendLaw {
    /// B h², kg m².
    pub k: f32,
    /// Damping, over h, kg m².
    pub c: f32,
    /// Whether anything needs the frame.
    pub framed: bool,
}

impl BendLaw {
    /// That of a material in substeps of `h` seconds. None where nothing resists bending.
    pub fn new(topology: &Topology, material: &Material, h: f32) -> Option<Self> {
        let moduli = material.moduli()?;
        let (k, delay) = (moduli.bending * h * h, moduli.bend_damping / h);
        let acts = k > 0.0 && !topology.bends.is_empty();
        acts.then_some(Self { k, c: k * delay, framed: topology.is_curved || delay > 0.0 })
    }
}

/// How bends are solved in a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BendSolver {
    law: BendLaw,
    stages: Stages,
}

impl BendSolver {
    /// How a material bends in substeps of `h` seconds, with or without what is on strands; none where nothing does.
    pub fn new(topology: &Topology, with_strands: bool, material: &Material, lanes: &Lanes, h: f32) -> Option<Self> {
        let law = BendLaw::new(topology, material, h)?;
        if !topology.bend_batches.iter().any(|batch| with_strands || !batch.on_strand) {
            return None;
        }
        let turning = if law.framed { TURNING } else { 1.0 };
        let stiffness = law.k + law.c;
        let fastest =
            stiffness * topology.bend_rate / material.density * turning * lightness(topology, material, lanes);
        let (stages, share) = Stages::for_rate(fastest);
        Some(Self { law: BendLaw { k: law.k * share, c: law.c * share, ..law }, stages })
    }
}

/// How many times lighter the lightest particle is than its share of the cloth, 1 or more.
fn lightness(topology: &Topology, material: &Material, lanes: &Lanes) -> f32 {
    let heavier =
        |most: f32, (particle, area): (u32, &f32)| most.max(lanes.inverse_mass(lanes.order.slot(particle)) * area);
    ((0..).zip(&topology.areas).fold(0.0, heavier) * material.density).max(1.0)
}

/// Solves all bends, or without those on strands.
pub(crate) fn solve(
    gathered: &mut GatheredParticles,
    ways: &mut ChebyshevBuffers,
    topology: &Topology,
    with_strands: bool,
    bending: BendSolver,
    simd_level: SimdLevel,
) {
    ways.begin(&gathered.now);
    let level = simd_level.level();
    for shares in bending.stages.shares() {
        for batch in topology.bend_batches.iter().filter(|batch| with_strands || !batch.on_strand) {
            let bends = &topology.bends[batch.range.clone()];
            let GatheredParticles { now, before } = &*gathered;
            if bending.law.framed {
                dispatch!(level, simd => pull_batch::<_, true>(simd, now, before, &mut ways.pull, bends, bending.law));
            } else {
                dispatch!(level, simd => pull_batch::<_, false>(simd, now, before, &mut ways.pull, bends, bending.law));
            }
        }
        dispatch!(level, simd => ways.advance(simd, &mut gathered.now, shares));
    }
}
