//! The section that edits what a cloth is made of.

use bevy::reflect::structs::GetField;
use bevy_egui::egui::{Label, RichText, Ui};

use super::{
    control::{Aside, Naming, choice, naming, section},
    knob::Knob,
    model::{Ask, Model},
};
use crate::{
    fabric::{Fabric, FabricPreset},
    solver::Moduli,
};

const fn strip(name: &'static str, hover: &'static str) -> Knob {
    Knob::new(name, "N/m", (1.0, 1e5), (0.01, 1e8), hover).logarithmic(1.0)
}

const fn stiffening(name: &'static str, hover: &'static str) -> Knob {
    Knob::new(name, "", (0.0, 200.0), (0.0, 1e4), hover).logarithmic(0.1)
}

const fn retardation(name: &'static str, most: f32, hover: &'static str) -> Knob {
    Knob::new(name, "s", (0.0, most), (0.0, 10.0), hover).logarithmic(1e-4).shown_as("ms", 1e3)
}

const fn factor(name: &'static str, most: f32, hover: &'static str) -> Knob {
    Knob::new(name, "", (0.0, most), (0.0, 100.0), hover)
}

const WARP: Knob = strip(
    "Warp stiffness",
    "Force over width and strain of a strip cut along the warp, in N/m, at rest. 30 for jersey, 400 for denim with \
     elastane, 4000 for a tablecloth. It stays near enough to the weft's for the shear stiffness: lower that first.",
);
const WEFT: Knob = strip(
    "Weft stiffness",
    "The same of a strip cut along the weft, in N/m. 30 to 20 000. It stays near enough to the warp's for the shear \
     stiffness: lower that first.",
);
const WARP_STIFFENING: Knob = stiffening(
    "Warp stiffening",
    "By how much the warp gets stiffer as it is stretched, without a unit: at a strain, by stiffening times strain. 0 \
     for most weaves, 10 and more for knits.",
);
const WEFT_STIFFENING: Knob = stiffening(
    "Weft stiffening",
    "By how much the weft gets stiffer as it is stretched, without a unit. 0 for most weaves, 10 and more for knits.",
);
const COMPRESSION: Knob = Knob::new(
    "Compression",
    "",
    (0.0, 1.0),
    (0.0, 1.0),
    "Share of their stiffness that is left of threads that are pressed together, without a unit, 0 to 1. Less lets them \
     buckle where folds would be too small for the mesh.",
);
const SHEAR: Knob = Knob::new(
    "Shear stiffness",
    "N/m",
    (0.0, 1e4),
    (0.0, 1e8),
    "Force over width and shear angle, in N/m: how hard it is to pull the squares of the weave askew. 20 for a loose \
     weave, 100 for a tight one, 4000 for leather. At most what fits warp and weft.",
)
.logarithmic(0.1);
const BENDING: Knob = Knob::new(
    "Bending rigidity",
    "N·m",
    (0.0, 1e-2),
    (0.0, 1.0),
    "Moment over width and curvature, in µN·m: how stiff it is against folds. 4 for silk, 40 for cotton, 1000 for \
     leather.",
)
.logarithmic(1e-7)
.shown_as("µN·m", 1e6);
const STRETCH_DAMPING: Knob = retardation(
    "Stretch damping",
    0.1,
    "Inner damping of stretch and shear, in ms: its force over the stiffness and the rate of strain. 0 to 10. It calms \
     trembling where cloth is pulled tight.",
);
const BEND_DAMPING: Knob = retardation(
    "Bend damping",
    1.0,
    "Inner damping of bending, in ms: its moment over the rigidity and the rate of curvature. 0 to 100. It calms folds \
     as they open and close.",
);
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
    (5e-5, 5e-3),
    (1e-6, 0.1),
    "How thick it is, in mm. 0.2 for silk, 1 for leather. What is kept from obstacles besides is the contact margin, in \
     the section Solver.",
)
.logarithmic(5e-5)
.shown_as("mm", 1e3);
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

/// The fields that plain springs take the place of, in the order of the panel.
const ELASTIC: [(&str, Knob); 9] = [
    ("warp_stiffness", WARP),
    ("weft_stiffness", WEFT),
    ("warp_stiffening", WARP_STIFFENING),
    ("weft_stiffening", WEFT_STIFFENING),
    ("compression", COMPRESSION),
    ("shear_stiffness", SHEAR),
    ("bending_rigidity", BENDING),
    ("stretch_damping", STRETCH_DAMPING),
    ("bend_damping", BEND_DAMPING),
];

/// The others.
const OTHERS: [(&str, Knob); 6] = [
    ("density", DENSITY),
    ("thickness", THICKNESS),
    ("friction", FRICTION),
    ("drag", DRAG),
    ("lift", LIFT),
    ("damping", DAMPING),
];

pub(super) fn show(ui: &mut Ui, model: &mut Model) {
    let Model { settings, differing, follows_asset, asks, .. } = model;
    let Some((_, fabric)) = &mut settings.cloth else { return };
    section(ui, naming("Fabric", "What the cloth is made of. Changes act in the next step."), true, |ui| {
        let preset = Fabric::PRESETS.into_iter().find(|preset| preset.fabric == *fabric);
        asks.extend(show_presets(ui, preset.as_ref(), *follows_asset).map(Ask::Preset));
        let elastic: &[_] = if settings.springs.is_none() { &ELASTIC } else { &[] };
        if settings.springs.is_some() {
            let text = RichText::new("Its springs (below) are in force, not its stiffness.").weak();
            ui.add(Label::new(text).wrap().selectable(false));
        }
        for (field, knob) in elastic.iter().chain(&OTHERS) {
            let limits = fitting(fabric, field);
            let note = preset.as_ref().map(|preset| note(preset, field)).unwrap_or_default();
            if let Some(value) = fabric.get_field_mut::<f32>(field) {
                let aside = Aside { differs: differing.fabric.contains(field), note: &note };
                knob.within(limits).show(ui, value, aside);
            }
        }
    });
}

/// What a field may be, as far as that follows from the other fields: shear has to fit warp and weft.
fn fitting(fabric: &Fabric, field: &str) -> (f32, f32) {
    let Fabric { warp_stiffness: warp, weft_stiffness: weft, shear_stiffness: shear, .. } = *fabric;
    // A little more than there is has to fit, by a stiffness a little nearer: numbers are rounded.
    let (shear, nearer) = (shear * (1.0 + 1e-6), 1e-4);
    let near = |other: f32| {
        let least = (shear * other / (shear + other) * (1.0 + nearer)).min(other);
        let most = (shear * other / (shear - other) * (1.0 - nearer)).max(other);
        (least, if shear > other { most } else { f32::MAX })
    };
    match field {
        "warp_stiffness" => near(weft),
        "weft_stiffness" => near(warp),
        "shear_stiffness" => (0.0, Moduli::most_shear([warp, weft])),
        _ => (f32::MIN, f32::MAX),
    }
}

/// Whether a preset's field was measured.
fn note(preset: &FabricPreset, field: &str) -> String {
    let how = if preset.measured.contains(&field) { "Measured" } else { "Plausible, not measured" };
    format!("{how}: the preset {}.", spaced(preset.name))
}

/// The name of a preset, as it is read.
fn spaced(name: &str) -> String {
    name.replace('_', " ")
}

/// Gives the preset that is chosen.
fn show_presets(ui: &mut Ui, current: Option<&FabricPreset>, follows_asset: bool) -> Option<Fabric> {
    const PRESET: Naming = naming(
        "Preset",
        "Fabrics to begin with. A cloth that follows its asset does so until one is chosen or a value is edited.",
    );
    let presets = Fabric::PRESETS;
    let names = presets.each_ref().map(|preset| spaced(preset.name));
    let abouts = presets.each_ref().map(|preset| format!("Takes all values of this fabric. {}", preset.about()));
    let entries: Vec<_> = (0..presets.len()).map(|i| (i, names[i].as_str(), abouts[i].as_str())).collect();
    let about = current.map(FabricPreset::about).unwrap_or_default();
    let current = current.and_then(|current| presets.iter().position(|preset| preset == current));
    let current = current.filter(|_| !follows_asset);
    let otherwise = if follows_asset { "follows its asset" } else { "own values" };
    let chosen = choice(ui, PRESET, Aside { differs: false, note: &about }, current, otherwise, &entries)?;
    presets.into_iter().nth(chosen).map(|preset| preset.fabric)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn what_fits_is_valid(exponents in prop::array::uniform3(-2.0_f32..8.0), ends in any::<[bool; 3]>()) {
            let [warp_stiffness, weft_stiffness, shear] = exponents.map(|e| bevy::math::ops::powf(10.0, e));
            let shear_stiffness = shear.min(Moduli::most_shear([warp_stiffness, weft_stiffness]));
            let mut fabric = Fabric { warp_stiffness, weft_stiffness, shear_stiffness, ..Fabric::default() };
            prop_assume!(fabric.material().is_ok());
            for ((field, knob), is_high) in [ELASTIC[0], ELASTIC[1], ELASTIC[5]].into_iter().zip(ends) {
                let entered = if is_high { f64::MAX } else { f64::MIN };
                let value = knob.within(fitting(&fabric, field)).accept(entered);
                *fabric.get_field_mut::<f32>(field).unwrap() = value.unwrap();
                prop_assert!(fabric.material().is_ok(), "{field}: {:?}", fabric.material());
            }
        }
    }

    #[test]
    fn every_field_has_a_knob() {
        let fields = <Fabric as bevy::reflect::Typed>::type_info().as_struct().unwrap().field_names();
        let knobs: Vec<_> = ELASTIC.iter().chain(&OTHERS).map(|(field, _)| *field).collect();
        assert_eq!(knobs.len(), fields.len());
        assert!(fields.iter().all(|field| knobs.contains(field)), "{knobs:?}");
    }
}
