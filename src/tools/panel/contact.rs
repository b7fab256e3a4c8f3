//! The section that edits what a cloth touches: obstacles, itself, and other cloths.

use bevy_egui::egui::Ui;

use super::{
    control::{choice, naming, section},
    knob::Knob,
    model::Model,
};
use crate::solver::SelfCollision;

const MARGIN: Knob = Knob::new(
    "Contact margin",
    "m",
    (0.0, 0.05),
    (0.0, 10.0),
    "Distance kept from obstacles beyond the fabric's thickness, in mm. 2 to 20: more where triangles are large and \
     obstacles poke through between their corners. More than a quarter of the cloth's width counts as that.",
)
.shown_as("mm", 1e3);
const LEAVING: Knob = Knob::new(
    "Leaving speed",
    "m/s",
    (0.1, 5.0),
    (0.001, 1000.0),
    "The most that cloth which finds itself inside of an obstacle, or too near to other cloth, leaves it by, in m/s. 0.5 to \
     3: more gets out sooner, and looks like a blow.",
)
.logarithmic(0.1);
const SELF_DISTANCE: Knob = Knob::new(
    "Cloth distance",
    "m",
    (0.001, 0.02),
    (0.000_01, 10.0),
    "Distance that parts of cloth keep from each other, in mm. 2 to 10: less lies closer, more is safer in a rush.",
)
.shown_as("mm", 1e3);
const SELF_FRICTION: Knob = Knob::new(
    "Cloth friction",
    "",
    (0.0, 1.0),
    (0.0, 100.0),
    "Friction of cloth on cloth, without a unit. 0.1 for silk, 0.4 for wool.",
);

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
        MARGIN.show(ui, &mut cloth.collision_margin, differs("collision_margin"));
        LEAVING.show(ui, &mut cloth.max_depenetration_velocity, differs("max_depenetration_velocity"));
        let which = naming("Self-collision", "What of the cloth meets itself, and other cloths that have it too.");
        let (now, differs_here) = (Some(cloth.self_collision), differs("self_collision"));
        if let Some(mode) = choice(ui, which, differs_here, now, "", &SELF_COLLISIONS) {
            cloth.self_collision = mode;
        }
        if cloth.self_collision != SelfCollision::Off {
            SELF_DISTANCE.show(ui, &mut cloth.self_distance, differs("self_distance"));
            SELF_FRICTION.show(ui, &mut cloth.self_friction, differs("self_friction"));
        }
    });
}
