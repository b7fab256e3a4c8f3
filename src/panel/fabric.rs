//! The section that edits what a cloth is made of.

use bevy::reflect::structs::GetField;
use bevy_egui::egui::Ui;

use super::{
    control::{Naming, choice, naming, section},
    knob::Knob,
    model::{Ask, Model},
};
use crate::fabric::Fabric;

const fn stiffness(name: &'static str, hover: &'static str) -> Knob {
    Knob::new(name, "N/m", (0.0, 1e5), (0.0, 1e8), hover).logarithmic(0.1)
}

const fn damping(name: &'static str, hover: &'static str) -> Knob {
    Knob::new(name, "N·s/m", (0.0, 1.0), (0.0, 1e4), hover).logarithmic(1e-4)
}

const fn factor(name: &'static str, most: f32, hover: &'static str) -> Knob {
    Knob::new(name, "", (0.0, most), (0.0, 100.0), hover)
}

const STRETCH: Knob = stiffness(
    "Stretch",
    "Stiffness along the threads, in N/m. 500 for something stretchy, 5000 for cotton, 20 000 for canvas. Stiffer cloth \
     needs more substeps.",
);
const SHEAR: Knob = stiffness(
    "Shear",
    "Stiffness along the diagonals, in N/m: how hard it is to pull the squares of the weave askew. A tenth of the \
     stretch stiffness for most weaves.",
);
const BEND: Knob = stiffness("Bend", "Stiffness against folds, in N/m. 0.5 for silk, 20 for cotton, 500 for leather.");
const STRETCH_DAMPING: Knob = damping(
    "Stretch damping",
    "Damping along the threads, in N·s/m. 0 to 0.1. It calms trembling where cloth is pulled tight.",
);
const SHEAR_DAMPING: Knob = damping("Shear damping", "Damping along the diagonals, in N·s/m. 0 to 0.1.");
const BEND_DAMPING: Knob = damping("Bend damping", "Damping of folds as they open and close, in N·s/m. 0 to 0.1.");
const DENSITY: Knob = Knob::new(
    "Density",
    "kg/m²",
    (0.02, 2.0),
    (1e-3, 1e3),
    "Mass per area, in kg/m². 0.05 for silk, 0.2 for cotton, 0.6 for heavy canvas. Heavier cloth stretches more and is \
     moved less by wind.",
)
.logarithmic(0.02);
const THICKNESS: Knob = Knob::new(
    "Thickness",
    "m",
    (0.0, 0.05),
    (0.0, 10.0),
    "Distance that the cloth keeps from obstacles, in m. 0.002 to 0.02; more where its triangles are large and obstacles \
     poke through.",
);
const FRICTION: Knob = factor(
    "Friction",
    1.5,
    "Coulomb friction against obstacles, without a unit. 0.2 for silk, 0.5 for cotton, 0.9 for rubber; 0 lets it slide \
     off.",
);
const DRAG: Knob = factor(
    "Drag",
    3.0,
    "How much of the wind's push along its flow the cloth takes, without a unit. About 1.2 for a plate; 0 and no lift \
     for no air.",
);
const LIFT: Knob =
    factor("Lift", 2.0, "Push of the air across its flow, without a unit. 0 to 1; it makes flags flutter.");
const DAMPING: Knob = Knob::new(
    "Damping",
    "1/s",
    (0.0, 5.0),
    (0.0, 1e4),
    "Damping of all motion, in 1/s: it fades to 37 % within 1/damping seconds. 0 to 2.",
);

/// The fields of a fabric in the order of the panel.
const FIELDS: [(&str, Knob); 12] = [
    ("structural_stiffness", STRETCH),
    ("shear_stiffness", SHEAR),
    ("bend_stiffness", BEND),
    ("structural_damping", STRETCH_DAMPING),
    ("shear_damping", SHEAR_DAMPING),
    ("bend_damping", BEND_DAMPING),
    ("density", DENSITY),
    ("thickness", THICKNESS),
    ("friction", FRICTION),
    ("drag", DRAG),
    ("lift", LIFT),
    ("damping", DAMPING),
];

pub(super) fn show(ui: &mut Ui, model: &mut Model) {
    let Some((_, fabric)) = &mut model.settings.cloth else { return };
    section(ui, naming("Fabric", "What the cloth is made of. Changes act in the next step."), true, |ui| {
        if let Some(preset) = show_presets(ui, fabric, model.follows_asset) {
            model.asks.push(Ask::Preset(preset));
        }
        for (field, knob) in &FIELDS {
            if let Some(value) = fabric.get_field_mut::<f32>(field) {
                knob.show(ui, value, model.differing.contains(field));
            }
        }
    });
}

fn show_presets(ui: &mut Ui, fabric: &Fabric, follows_asset: bool) -> Option<Fabric> {
    const PRESET: Naming = naming(
        "Preset",
        "Fabrics to begin with. A cloth that follows its asset does so until one is chosen or a value is edited.",
    );
    let presets = Fabric::PRESETS;
    let current = presets.iter().position(|preset| preset.fabric == *fabric).filter(|_| !follows_asset);
    let otherwise = if follows_asset { "follows its asset" } else { "own values" };
    let abouts = presets.each_ref().map(|preset| format!("Takes all values of this fabric. {}", preset.about()));
    let entries = presets.iter().zip(&abouts).enumerate();
    let entries: Vec<_> = entries.map(|(i, (preset, about))| (i, preset.name, about.as_str())).collect();
    let chosen = choice(ui, PRESET, false, current, otherwise, &entries)?;
    presets.into_iter().nth(chosen).map(|preset| preset.fabric)
}
