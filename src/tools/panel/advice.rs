//! Whether a cloth's settings can be solved well, and if not, what to change.

use bevy::{math::Vec3A, prelude::*};

use super::number;
use crate::{
    cloth::{ClothSolver, InForce},
    solver::{Elasticity, Material, Moduli, SpringKind, Topology},
    state::{ClothAttachments, ClothGrabs, ClothReport, ClothState},
};

/// Stretch along a thread that can be seen, no unit.
const VISIBLE: f32 = 0.03;
/// How many times what pulls at the cloth its threads may seem to carry.
const EXCESS: f32 = 1.6;
/// The stretch of a position solve that is too coarse falls with this power of the substeps. 2 is the order of the
/// time step; a long chain needs a few steps to pass a pull on.
const RATE: f32 = 1.5;
/// More substeps than this cost so much that other ways are named first.
const MANY: f32 = 64.0;

/// How a cloth is solved and how that goes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Situation {
    pub solver: ClothSolver,
    pub substeps: u32,
    pub max_substeps: u32,
    pub has_tethers: bool,
    pub stiffness: Stiffness,
    /// Share of the stiffness that the explicit solver could use.
    pub stiffness_scale: f32,
    /// Substeps that the explicit solver needs for all of it.
    pub needed: u32,
    /// Largest strain over the last while, no unit.
    pub strain: f32,
    /// [`overload`] over the last while.
    pub overload: f32,
}

/// How stiff threads are, as a game sets it, N/m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Stiffness {
    /// Of plain springs.
    Structural(f32),
    /// Of a fabric: the greater of the two.
    WarpOrWeft(f32),
}

impl Stiffness {
    /// What is in force.
    pub fn of(material: &Material) -> Self {
        match &material.elasticity {
            Elasticity::Springs([structural, ..]) => Self::Structural(structural.stiffness),
            Elasticity::Moduli(moduli) => Self::WarpOrWeft(pulled(moduli)),
        }
    }

    /// What it is called, and its value.
    fn told(self) -> (&'static str, f32) {
        match self {
            Self::Structural(stiffness) => ("the structural stiffness", stiffness),
            Self::WarpOrWeft(stiffness) => ("warp and weft stiffness", stiffness),
        }
    }
}

/// Force over width and strain of a strip along the stiffer threads, N/m: the other way round than
/// [`Moduli::from_strips`].
fn pulled(moduli: &Moduli) -> f32 {
    let Moduli { stretch: [warp, weft], shear, compression, .. } = *moduli;
    let strip = |along: f32, across: f32| {
        let pressed = shear + compression * (across - shear);
        if pressed > 0.0 { along - shear * shear / pressed } else { along }
    };
    strip(warp, weft).max(strip(weft, warp))
}

/// What is wrong where a cloth isn't solved well.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Advice {
    /// In a few words.
    pub brief: &'static str,
    /// With numbers, and what to change.
    pub full: String,
}

/// What to change where a cloth isn't solved well.
pub(super) fn advise(situation: &Situation) -> Option<Advice> {
    match situation.solver {
        ClothSolver::Explicit if situation.stiffness_scale < 1.0 => {
            Some(Advice { brief: "Softer than it should be", full: raise_limit(situation) })
        }
        ClothSolver::Strands | ClothSolver::Xpbd if situation.strain > VISIBLE && situation.overload > EXCESS => {
            Some(Advice { brief: "Stretches too much", full: raise_substeps(situation) })
        }
        _ => None,
    }
}

fn raise_limit(situation: &Situation) -> String {
    let Situation { max_substeps, stiffness_scale, needed, .. } = *situation;
    let share = number::text(f64::from((stiffness_scale * 1000.0).floor() / 10.0));
    let raise = if needed <= 10_000 { format!("Raise the most substeps to {needed}, lower") } else { "Lower".into() };
    format!(
        "{max_substeps} substeps carry only {share} % of the stiffness and damping. {raise} both to that share, or use \
         strands."
    )
}

fn raise_substeps(situation: &Situation) -> String {
    let Situation { substeps, stiffness, strain, overload, has_tethers, .. } = *situation;
    let (name, stiffness) = stiffness.told();
    // Until either of the two no longer shows, and a little farther.
    let excess = (overload / EXCESS).min(strain / VISIBLE) * 1.2;
    let factor = bevy::math::ops::powf(excess, 1.0 / RATE);
    let enough = two_digits((substeps as f32 * factor).ceil()).max(substeps as f32 + 1.0);
    let tethers = if has_tethers { "" } else { "turn tethers on, " };
    let raise = if enough <= MANY || has_tethers {
        format!("Raise the substeps to {enough}, {tethers}or")
    } else {
        format!("Turn tethers on, raise the substeps to {enough}, or")
    };
    format!(
        "Threads are stretched by up to {} %, {} times as much as what pulls at the cloth can explain: {substeps} {} too \
         few for {} N/m. {raise} lower {name} to {} N/m, as it behaves now.",
        two_digits(strain * 100.0),
        two_digits(overload),
        if substeps == 1 { "substep is" } else { "substeps are" },
        number::text(stiffness.into()),
        two_digits(stiffness / overload),
    )
}

/// Two digits are enough, and don't flicker as much as more would.
fn two_digits(value: f32) -> f32 {
    format!("{value:.1e}").parse().unwrap_or(value)
}

/// A cloth that is looked at.
#[derive(Clone, Copy)]
pub(super) struct Observed<'a> {
    pub is_asleep: bool,
    pub state: &'a ClothState,
    pub attachments: &'a ClothAttachments,
    pub grabs: &'a ClothGrabs,
    pub in_force: &'a InForce,
    pub report: &'a ClothReport,
}

/// How many times what pulls at the cloth the threads carry, by their stretch. About 1 or less where they are solved
/// well; where they aren't, they are stretched by more than any force can do, and the stiffness over this number is what
/// they behave like.
///
/// The virial theorem: over time, the sum of tension times length of all springs is the sum of r·f over all forces and
/// twice the kinetic energy, with r from the middle of the cloth, and no r is longer than half of its diagonal. Shear and
/// bend springs carry a part of it and are left out: the number is rather too low than too high.
///
/// None while the cloth is held by hand or its pins are pulled apart: then the pull has no limit that could be known.
pub(super) fn overload(cloth: &Observed, gravity: Vec3, kinetic: f32) -> Option<f32> {
    let state = cloth.state;
    let material = state.material?;
    if !cloth.grabs.is_empty() || are_pins_apart(state, cloth.attachments) {
        return None;
    }
    let topology = &state.topology;
    let position = &state.particles.position;
    let carried: f32 = topology
        .springs_of(SpringKind::Structural)
        .map(|spring| {
            let length = position[spring.a as usize].distance(position[spring.b as usize]);
            let law = material.spring(SpringKind::Structural, spring);
            law.secant(length / spring.rest - 1.0) * (length - spring.rest).max(0.0) * length
        })
        .sum();
    let mass = material.density * topology.areas.iter().sum::<f32>();
    let weight = mass * gravity.length();
    let blown = cloth.report.latest().map_or(0.0, |report| report.steady_force);
    let pulled = (weight + blown) * reach(topology) + 2.0 * kinetic;
    Some(carried / pulled.max(f32::MIN_POSITIVE))
}

/// Half of the diagonal of the rest shape, m.
fn reach(topology: &Topology) -> f32 {
    let corners = topology
        .rest
        .iter()
        .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(least, most), &place| (least.min(place), most.max(place)));
    if topology.rest.is_empty() { 0.0 } else { corners.0.distance(corners.1) / 2.0 }
}

/// Whether pins are farther from each other than at rest. Of many, some are looked at.
fn are_pins_apart(state: &ClothState, ClothAttachments { pins, .. }: &ClothAttachments) -> bool {
    const LOOKED_AT: usize = 48;
    let stride = pins.len().div_ceil(LOOKED_AT).max(1);
    let place = |particle: u32| -> (Vec3A, Vec3A) {
        (state.particles.position[particle as usize], state.topology.rest[particle as usize].into())
    };
    let pins: Vec<_> = pins.iter().step_by(stride).map(|pin| place(pin.particle)).collect();
    pins.iter().enumerate().any(|(i, (now, rest))| {
        pins[..i]
            .iter()
            .any(|(other_now, other_rest)| now.distance(*other_now) > 1.01 * rest.distance(*other_rest) + 1e-4)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fabric::Fabric;

    const GOOD: Situation = Situation {
        solver: ClothSolver::Xpbd,
        substeps: 8,
        max_substeps: 512,
        has_tethers: false,
        stiffness: Stiffness::Structural(5000.0),
        stiffness_scale: 1.0,
        needed: 1,
        strain: 0.01,
        overload: 0.8,
    };

    fn full(situation: &Situation) -> String {
        advise(situation).expect("advice").full
    }

    #[test]
    fn a_cloth_that_is_solved_well_gets_no_advice() {
        assert_eq!(advise(&GOOD), None);
        assert_eq!(advise(&Situation { strain: 0.4, ..GOOD }), None, "it is soft, and loaded");
        assert_eq!(advise(&Situation { overload: 30.0, ..GOOD }), None, "nobody can see it");
        assert_eq!(advise(&Situation { solver: ClothSolver::Explicit, strain: 0.4, overload: 9.0, ..GOOD }), None);
    }

    #[test]
    fn too_few_substeps_are_told_with_what_would_be_enough() {
        let bad = Situation { strain: 0.36, overload: 25.0, ..GOOD };
        let text = full(&bad);
        assert!(
            text.contains("36 %") && text.contains("25 times") && text.contains("8 substeps are too few"),
            "{text}"
        );
        assert!(text.contains("Raise the substeps to 48, turn tethers on"), "{text}");
        assert!(text.contains("lower the structural stiffness to 200 N/m"), "{text}");
        let text = full(&Situation { stiffness: Stiffness::WarpOrWeft(4000.0), ..bad });
        assert!(text.contains("for 4000 N/m") && text.contains("lower warp and weft stiffness to 160 N/m"), "{text}");
        let text = full(&Situation { has_tethers: true, ..bad });
        assert!(!text.contains("tethers"), "{text}");
        let worse = full(&Situation { strain: 13.0, overload: 5000.0, ..bad });
        assert!(worse.contains("Turn tethers on, raise"), "{worse}");
    }

    #[test]
    fn a_fabrics_stiffness_is_told_as_it_was_set() {
        for fabric in Fabric::PRESETS.map(|preset| preset.fabric) {
            for compression in [1.0, 0.2] {
                let fabric = Fabric { compression, ..fabric.clone() };
                let most = fabric.warp_stiffness.max(fabric.weft_stiffness);
                let told = Stiffness::of(&fabric.material().expect("a preset"));
                assert!(
                    matches!(told, Stiffness::WarpOrWeft(k) if (k / most - 1.0).abs() < 1e-4),
                    "{told:?} for {most}"
                );
            }
        }
    }

    #[test]
    fn more_is_always_asked_for_than_there_is() {
        for substeps in [1, 7, 300] {
            let text = full(&Situation { substeps, strain: 0.0301, overload: 2.01, ..GOOD });
            let asked = text.split("ubsteps to ").nth(1).and_then(|rest| rest.split(',').next());
            assert!(asked.and_then(|asked| asked.parse::<u32>().ok()).is_some_and(|asked| asked > substeps), "{text}");
        }
    }

    #[test]
    fn the_explicit_solver_asks_for_what_it_needs() {
        let soft = Situation { solver: ClothSolver::Explicit, stiffness_scale: 0.3817, needed: 829, ..GOOD };
        let text = full(&soft);
        assert!(text.contains("38.1 %") && text.contains("to 829") && text.contains("strands"), "{text}");
        let text = full(&Situation { needed: 20_000, ..soft });
        assert!(!text.contains("20000"), "more than it may have: {text}");
        assert_eq!(advise(&Situation { solver: ClothSolver::Xpbd, ..soft }), None);
    }
}
