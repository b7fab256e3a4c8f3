//! The section that edits the time that all cloth may take.

use bevy_egui::egui::Ui;

use super::{
    code,
    control::{Naming, button, buttons, naming, section, tick},
    knob,
    model::Model,
};
use crate::simulate::budget::ClothBudget;

/// Time to begin with, ms: a tenth of a frame at 60 Hz.
const BEGUN: f32 = 1.6;

const BUDGET: Naming =
    naming("Budget", "The time that all cloth of the app together may take in a step (ClothBudget).");
const LIMITED: Naming = naming(
    "Limited time",
    "Cuts substeps where all cloth together takes longer: of the cloth farthest from all cameras first, and down to a quarter. It \
     goes by the clock: two runs aren't the same then.",
);
const COPY: Naming = naming("Copy budget as Rust", "Puts the budget on the clipboard as the code of its resource.");

pub(super) fn show(ui: &mut Ui, model: &mut Model) {
    let Some(budget) = &mut model.settings.budget else { return };
    section(ui, BUDGET, false, |ui| {
        let mut is_on = budget.seconds().is_some();
        if tick(ui, LIMITED, false, &mut is_on) {
            *budget = if is_on { ClothBudget { milliseconds: BEGUN } } else { ClothBudget::default() };
        }
        if is_on {
            knob::show(ui, budget, "milliseconds", false);
        }
        buttons(ui, "copy budget", |ui| {
            if button(ui, COPY, true) {
                ui.ctx().copy_text(format!("{},\n", code::component(budget)));
            }
        });
    });
}
