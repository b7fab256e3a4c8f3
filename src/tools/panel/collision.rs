//! The section that edits what a cloth touches: obstacles, itself, and other cloths.

use bevy_egui::egui::Ui;

use super::{
    control::{naming, section, tick},
    knob,
    model::Model,
};

pub(super) fn show(ui: &mut Ui, model: &mut Model) {
    section(ui, naming("Collision", "What the cloth touches, and how near it comes."), true, |ui| {
        let Model { settings, differing, .. } = &mut *model;
        let Some((cloth, _)) = &mut settings.cloth else { return };
        let differs = |field| differing.cloth.contains(&field);
        for field in ["collision_margin", "max_depenetration_velocity"] {
            knob::show(ui, cloth, field, differs(field));
        }
        let which = naming("Self-collision", "Whether the cloth meets itself, and other cloths that have it too.");
        tick(ui, which, differs("self_collision"), &mut cloth.self_collision);
        if cloth.self_collision {
            for field in ["self_distance", "self_friction"] {
                knob::show(ui, cloth, field, differs(field));
            }
        }
    });
}
