//! The section that edits a cloth's plain springs, where it has them.

use bevy::reflect::structs::GetField;
use bevy_egui::egui::Ui;

use super::{
    control::{naming, section},
    knob::Knob,
    model::Model,
};

const fn stiffness(name: &'static str, hover: &'static str) -> Knob {
    Knob::new(name, "N/m", (0.0, 1e5), (0.0, 1e8), hover).logarithmic(0.1)
}

const fn damping(name: &'static str, hover: &'static str) -> Knob {
    Knob::new(name, "N·s/m", (0.0, 1.0), (0.0, 1e4), hover).logarithmic(1e-4)
}

/// The fields in the order of the panel.
const FIELDS: [(&str, Knob); 6] = [
    (
        "structural_stiffness",
        stiffness(
            "Stretch",
            "Stiffness of the springs along the threads, in N/m. 500 for something stretchy, 20 000 for canvas. Stiffer \
             cloth needs more substeps.",
        ),
    ),
    (
        "shear_stiffness",
        stiffness(
            "Shear",
            "Stiffness of the springs along the diagonals, in N/m: how hard it is to pull the squares of the weave askew. \
             A tenth of the stretch for most weaves.",
        ),
    ),
    (
        "bend_stiffness",
        stiffness(
            "Bend",
            "Stiffness of the springs between particles two steps apart, in N/m. 0.5 for silk, 20 for cotton, 500 for \
             leather.",
        ),
    ),
    (
        "structural_damping",
        damping(
            "Stretch damping",
            "Damping along the threads, in N·s/m. 0 to 0.1. It calms trembling where cloth is pulled tight.",
        ),
    ),
    ("shear_damping", damping("Shear damping", "Damping along the diagonals, in N·s/m. 0 to 0.1.")),
    ("bend_damping", damping("Bend damping", "Damping of folds as they open and close, in N·s/m. 0 to 0.1.")),
];

pub(super) fn show(ui: &mut Ui, model: &mut Model) {
    const SPRINGS: &str = "Springs that are all alike (ClothSprings), in place of the fabric's stiffness, rigidity and inner \
                           damping. What they amount to depends on the size of the mesh's cells.";
    let Model { settings, differing, .. } = model;
    let Some(springs) = &mut settings.springs else { return };
    section(ui, naming("Springs", SPRINGS), true, |ui| {
        for (field, knob) in &FIELDS {
            if let Some(value) = springs.get_field_mut::<f32>(field) {
                knob.show(ui, value, differing.springs.contains(field));
            }
        }
    });
}
