//! The section that edits how a cloth is solved, and when.

use bevy_egui::egui::Ui;

use super::{
    control::{Naming, choice, naming, section, tick},
    knob,
    model::Model,
    pick,
};
use crate::cloth::{Cloth, ClothSolver};

/// Substeps to begin with where they are set by hand.
const BEGUN_SUBSTEPS: u32 = 8;

/// Limit to begin with: 8 substeps of 64 x 64 particles.
const BEGUN_WORK: u32 = 32_768;

const LIMITED_WORK: Naming = naming(
    "Limited work",
    "Cuts substeps, so that a step is no more than so much work: particles times substeps. Without it, as many are taken as are \
     asked for.",
);
const BY_HAND: Naming = naming(
    "Substeps by hand",
    "Sets the number of substeps. Without it, they follow from the largest strain, and are 8 at least near obstacles, 6 near limbs.",
);
const LEVELS: Naming = naming(
    "Coarse levels",
    "Pulls travel far across the cloth in few substeps. Strands only; without them, fine meshes stretch more.",
);
const TETHERS: Naming = naming(
    "Tethers",
    "Keeps every particle within the cloth's own length of its pins: the cure for cloth that stretches like rubber. Not \
     for the explicit solver.",
);
const SOLVERS: [(ClothSolver, &str, &str); 3] = [
    (ClothSolver::Strands, "Strands", "Each thread solved exactly: the least stretch for the time. For games."),
    (ClothSolver::Xpbd, "XPBD", "Spring by spring: stable as well, and stretched more."),
    (ClothSolver::Explicit, "Explicit", "The textbook form: the most accurate, and many times as costly."),
];

pub(super) fn show(ui: &mut Ui, model: &mut Model) {
    section(ui, naming("Solver", "How the springs are computed: speed against accuracy."), true, |ui| {
        let Model { settings, differing, .. } = &mut *model;
        let Some((cloth, _)) = &mut settings.cloth else { return };
        let differs = |field| differing.cloth.contains(&field);
        let which = naming("Solver", "How the springs are integrated: strands for games, the others to compare with.");
        if let Some(solver) = choice(ui, which, differs("solver"), Some(cloth.solver), "", &SOLVERS) {
            cloth.solver = solver;
        }
        pick::show(ui, cloth, "timing", differs("timing"));
        match cloth.solver {
            ClothSolver::Strands => {
                knob::show(ui, cloth, "max_strain", differs("max_strain"));
                show_substeps(ui, cloth, differs("substeps"));
                show_levels(ui, cloth, differs("levels"));
                show_tethers(ui, cloth, differs("tether_slack"));
                knob::show(ui, cloth, "max_velocity", differs("max_velocity"));
                show_work(ui, cloth, differs("max_work"));
            }
            ClothSolver::Xpbd => {
                show_substeps(ui, cloth, differs("substeps"));
                show_tethers(ui, cloth, differs("tether_slack"));
                knob::show(ui, cloth, "max_velocity", differs("max_velocity"));
                show_work(ui, cloth, differs("max_work"));
            }
            ClothSolver::Explicit => {
                knob::show(ui, cloth, "max_substeps", differs("max_substeps"));
                knob::show(ui, cloth, "max_velocity", differs("max_velocity"));
            }
        }
    });
}

fn show_work(ui: &mut Ui, cloth: &mut Cloth, differs: bool) {
    let mut is_on = cloth.max_work.is_some();
    if tick(ui, LIMITED_WORK, differs, &mut is_on) {
        cloth.max_work = is_on.then_some(BEGUN_WORK);
    }
    knob::show(ui, cloth, "max_work", differs);
}

fn show_substeps(ui: &mut Ui, cloth: &mut Cloth, differs: bool) {
    let mut is_on = cloth.substeps.is_some();
    if tick(ui, BY_HAND, differs, &mut is_on) {
        cloth.substeps = is_on.then_some(BEGUN_SUBSTEPS);
    }
    knob::show(ui, cloth, "substeps", differs);
}

fn show_levels(ui: &mut Ui, cloth: &mut Cloth, differs: bool) {
    let mut is_on = cloth.levels.as_ref().is_none_or(|levels| !levels.is_empty());
    if tick(ui, LEVELS, differs, &mut is_on) {
        cloth.levels = if is_on { None } else { Some(Vec::new()) };
    }
}

fn show_tethers(ui: &mut Ui, cloth: &mut Cloth, differs: bool) {
    let mut is_on = cloth.tether_slack.is_some();
    if tick(ui, TETHERS, differs, &mut is_on) {
        cloth.tether_slack = is_on.then_some(Cloth::default().tether_slack.unwrap_or_default());
    }
    knob::show(ui, cloth, "tether_slack", differs);
}
