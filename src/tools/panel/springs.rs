//! The section that edits a cloth's plain springs, where it has them.

use bevy::reflect::Typed;
use bevy_egui::egui::Ui;

use super::{
    control::{naming, section},
    knob,
    model::Model,
};
use crate::fabric::ClothSprings;

pub(super) fn show(ui: &mut Ui, model: &mut Model) {
    const SPRINGS: &str = "Springs that are all alike (ClothSprings), in place of the fabric's stiffness, rigidity and inner \
                           damping. What they amount to depends on the size of the mesh's cells.";
    let Model { settings, differing, .. } = model;
    let Some(springs) = &mut settings.beside.springs else { return };
    section(ui, naming("Springs", SPRINGS), true, |ui| {
        for field in ClothSprings::type_info().as_struct().into_iter().flat_map(|info| info.field_names()) {
            knob::show(ui, springs, field, differing.springs.contains(field));
        }
    });
}
