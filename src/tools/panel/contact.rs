//! The section that edits what a cloth touches: obstacles, itself, and other cloths.

use bevy_egui::egui::Ui;

use super::{
    control::{choice, naming, section},
    knob,
    model::Model,
};
use crate::solver::SelfCollision;

const SELF_COLLISIONS: [(SelfCollision, &str, &str); 3] = [
    (SelfCollision::Off, "Off", "It passes through itself and other cloths."),
    (SelfCollision::Particles, "Particles", "Balls at its particles: fast, and passed through in a rush."),
    (SelfCollision::Robust, "Robust", "Its triangles and edges: folds and layers stay apart."),
];

pub(super) fn show(ui: &mut Ui, model: &mut Model) {
    section(ui, naming("Contact", "What the cloth touches, and how near it comes."), true, |ui| {
        let Model { settings, differing, .. } = &mut *model;
        let Some((cloth, _)) = &mut settings.cloth else { return };
        let differs = |field| differing.cloth.contains(&field);
        for field in ["collision_margin", "max_depenetration_velocity"] {
            knob::show(ui, cloth, field, differs(field));
        }
        let which = naming("Self-collision", "What of the cloth meets itself, and other cloths that have it too.");
        let (now, differs_here) = (Some(cloth.self_collision), differs("self_collision"));
        if let Some(mode) = choice(ui, which, differs_here, now, "", &SELF_COLLISIONS) {
            cloth.self_collision = mode;
        }
        if cloth.self_collision != SelfCollision::Off {
            for field in ["self_distance", "self_friction"] {
                knob::show(ui, cloth, field, differs(field));
            }
        }
    });
}
