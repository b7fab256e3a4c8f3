//! The section that edits how a cloth is solved, and says where that isn't enough.

use bevy_egui::egui::{Label, RichText, Ui};

use super::{
    control::{Naming, choice, naming, section, tick},
    knob::Knob,
    model::Model,
};
use crate::cloth::{Cloth, ClothSolver};

/// Cloths for which advice is shown. More would push all else out of the window.
const MOST_ADVICE: usize = 3;

const SUBSTEPS: Knob = Knob::new(
    "Substeps",
    "",
    (1.0, 64.0),
    (1.0, 1000.0),
    "Substeps per step of XPBD. 8 for most, 16 and more for fine meshes and stiff cloth. Twice as many cost twice the \
     time and let cloth stretch about a third as much.",
)
.whole();
const MAX_SUBSTEPS: Knob = Knob::new(
    "Most substeps",
    "",
    (1.0, 2000.0),
    (1.0, 10_000.0),
    "The most substeps per step that the explicit solver may take. 100 to 2000. Where that isn't enough, it runs with \
     less stiffness and damping, and the panel says so.",
)
.whole();
const TETHERS: Naming = naming(
    "Tethers",
    "Keeps every particle within the cloth's own length of its pins: the cure for cloth that stretches like rubber. XPBD \
     only.",
);
const SLACK: Knob = Knob::new(
    "Tether slack",
    "",
    (0.0, 0.05),
    (0.0, 10.0),
    "By how much of its length a tether gives, without a unit. 0.002 to 0.01 for cloth: more lets it stretch, less makes \
     it tremble.",
);

const SOLVERS: [(ClothSolver, &str, &str); 2] = [
    (ClothSolver::Xpbd, "XPBD", "Stable at any stiffness and time step. For games."),
    (ClothSolver::Explicit, "Explicit", "The textbook form: the most accurate, and many times as costly."),
];

pub(super) fn show(ui: &mut Ui, model: &mut Model) {
    section(ui, naming("Solver", "How the springs are computed: speed against accuracy."), true, |ui| {
        let Model { settings, differing, .. } = &mut *model;
        let Some((cloth, _)) = &mut settings.cloth else { return };
        let differs = |field| differing.contains(&field);
        let which = naming("Solver", "How the springs are integrated: XPBD for games, explicit to compare with.");
        if let Some(solver) = choice(ui, which, differs("solver"), Some(cloth.solver), "", &SOLVERS) {
            cloth.solver = solver;
        }
        match cloth.solver {
            ClothSolver::Xpbd => {
                SUBSTEPS.show_count(ui, &mut cloth.substeps, differs("substeps"));
                show_tethers(ui, cloth, differs("tether_slack"));
            }
            ClothSolver::Explicit => {
                MAX_SUBSTEPS.show_count(ui, &mut cloth.max_substeps, differs("max_substeps"));
            }
        }
        show_advice(ui, model);
    });
}

fn show_tethers(ui: &mut Ui, cloth: &mut Cloth, differs: bool) {
    let mut is_on = cloth.tether_slack.is_some();
    if tick(ui, TETHERS, differs, &mut is_on) {
        cloth.tether_slack = is_on.then_some(Cloth::default().tether_slack.unwrap_or_default());
    }
    if let Some(slack) = &mut cloth.tether_slack {
        SLACK.show(ui, slack, differs);
    }
}

fn show_advice(ui: &mut Ui, model: &Model) {
    for (entity, advice) in model.readings.advice.iter().take(MOST_ADVICE) {
        let name = model.cloths.iter().find(|(cloth, _)| cloth == entity).filter(|_| model.chosen.len() > 1);
        let name = name.map_or(String::new(), |(_, name)| format!("{name}: "));
        let text = RichText::new(format!("⚠ {name}{}", advice.full)).color(ui.visuals().warn_fg_color);
        ui.add(Label::new(text).wrap());
    }
}
