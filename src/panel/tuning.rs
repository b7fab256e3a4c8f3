//! The sections that edit cloths: their fabric, and how they are solved.

use bevy::reflect::structs::GetField;
use bevy_egui::egui::{Label, RichText, Ui};

use super::{
    control::{Knob, Naming, Scale, choice, naming, section, tick},
    model::{Ask, Model},
};
use crate::{
    cloth::{Cloth, ClothSolver},
    fabric::Fabric,
};

/// Cloths for which advice is shown. More would push all else out of the window.
const MOST_ADVICE: usize = 3;

const SPRINGS: (f32, f32) = (0.0, 1e8);

const fn stiffness(name: &'static str, hover: &'static str) -> Knob {
    let scale = Scale::Logarithmic(0.1);
    Knob { naming: naming(name, hover), unit: "N/m", range: (0.0, 100_000.0), scale, limits: SPRINGS }
}

const fn spring_damping(name: &'static str, hover: &'static str) -> Knob {
    let scale = Scale::Logarithmic(1e-4);
    Knob { naming: naming(name, hover), unit: "N·s/m", range: (0.0, 1.0), scale, limits: (0.0, 1e4) }
}

const fn plain(naming: Naming, unit: &'static str, range: (f32, f32), limits: (f32, f32)) -> Knob {
    Knob { naming, unit, range, scale: Scale::Linear, limits }
}

/// The fields of a fabric in the order of the panel, and their knobs.
pub(super) const FABRIC: [(&str, Knob); 12] = [
    (
        "structural_stiffness",
        stiffness(
            "Stretch",
            "Stiffness along the threads, in N/m. 500 for something stretchy, \
        5000 for cotton, 20 000 for canvas. Stiffer cloth needs more substeps.",
        ),
    ),
    (
        "shear_stiffness",
        stiffness(
            "Shear",
            "Stiffness along the diagonals, in N/m: how hard it is to pull squares of \
        the weave askew. A tenth of the stretch stiffness for most weaves.",
        ),
    ),
    (
        "bend_stiffness",
        stiffness(
            "Bend",
            "Stiffness against folds, in N/m. 0.5 for silk, 20 for cotton, 500 for \
        leather.",
        ),
    ),
    (
        "structural_damping",
        spring_damping(
            "Stretch damping",
            "Damping along the threads, in N·s/m. 0 to 0.1. It calms \
        trembling where cloth is pulled tight.",
        ),
    ),
    ("shear_damping", spring_damping("Shear damping", "Damping along the diagonals, in N·s/m. 0 to 0.1.")),
    ("bend_damping", spring_damping("Bend damping", "Damping of folds as they open and close, in N·s/m. 0 to 0.1.")),
    (
        "density",
        Knob {
            naming: naming(
                "Density",
                "Mass per area, in kg/m². 0.05 for silk, 0.2 for cotton, 0.6 for heavy canvas. \
            Heavier cloth stretches more and is moved less by wind.",
            ),
            unit: "kg/m²",
            range: (0.02, 2.0),
            scale: Scale::Logarithmic(0.02),
            limits: (1e-3, 1e3),
        },
    ),
    (
        "thickness",
        Knob {
            naming: naming(
                "Thickness",
                "Distance that the cloth keeps from obstacles, in m. 0.002 to 0.02; more where its \
            triangles are large and obstacles poke through.",
            ),
            unit: "m",
            range: (0.0, 0.05),
            scale: Scale::Linear,
            limits: (0.0, 10.0),
        },
    ),
    (
        "friction",
        plain(
            naming(
                "Friction",
                "Coulomb friction against obstacles, without a unit. 0.2 for silk, 0.5 for \
        cotton, 0.9 for rubber; 0 lets it slide off.",
            ),
            "",
            (0.0, 1.5),
            (0.0, 100.0),
        ),
    ),
    (
        "drag",
        plain(
            naming(
                "Drag",
                "How much of the wind's push along its flow the cloth takes, without a unit. About \
        1.2 for a plate; 0 and no lift for no air.",
            ),
            "",
            (0.0, 3.0),
            (0.0, 100.0),
        ),
    ),
    (
        "lift",
        plain(
            naming("Lift", "Push of the air across its flow, without a unit. 0 to 1; it makes flags flutter."),
            "",
            (0.0, 2.0),
            (0.0, 100.0),
        ),
    ),
    (
        "damping",
        plain(
            naming(
                "Damping",
                "Damping of all motion, in 1/s: it fades to 37 % within 1/damping seconds. 0 \
        to 2.",
            ),
            "1/s",
            (0.0, 5.0),
            (0.0, 1e4),
        ),
    ),
];

pub(super) const SUBSTEPS: Knob = Knob {
    naming: naming(
        "Substeps",
        "Substeps per step of XPBD. 8 for most, 16 and more for fine meshes and stiff cloth. \
        Twice as many cost twice the time and let cloth stretch about a third as much.",
    ),
    unit: "",
    range: (1.0, 64.0),
    scale: Scale::Whole,
    limits: (1.0, 1000.0),
};
pub(super) const MAX_SUBSTEPS: Knob = Knob {
    naming: naming(
        "Most substeps",
        "The most substeps per step that the explicit solver may take. 100 to 2000. Where \
        that isn't enough, it runs with less stiffness and damping, and the panel says so.",
    ),
    unit: "",
    range: (1.0, 2000.0),
    scale: Scale::Whole,
    limits: (1.0, 10_000.0),
};
pub(super) const SLACK: Knob = Knob {
    naming: naming(
        "Tether slack",
        "By how much of its length a tether gives, without a unit. 0.002 to 0.01 for cloth: \
        more lets it stretch, less makes it tremble.",
    ),
    unit: "",
    range: (0.0, 0.05),
    scale: Scale::Linear,
    limits: (0.0, 10.0),
};
pub(super) const GRAVITY_SCALE: Knob = plain(
    naming("Gravity scale", "Factor on gravity for this cloth, without a unit. 1 for most; 0 floats, negative rises."),
    "",
    (-1.0, 3.0),
    (-1e3, 1e3),
);
pub(super) const AIR_DENSITY: Knob = plain(
    naming(
        "Air density",
        "Density of the air around, in kg/m³: how hard wind pushes and how much still air brakes. \
        1.225 at sea level, 0 for a vacuum.",
    ),
    "kg/m³",
    (0.0, 3.0),
    (0.0, 1e3),
);

/// What a cloth is made of.
pub(super) fn show_fabric(ui: &mut Ui, model: &mut Model) {
    let Some((_, fabric)) = &mut model.settings.cloth else { return };
    section(ui, naming("Fabric", "What the cloth is made of. Changes act in the next step."), true, |ui| {
        let presets = Fabric::PRESETS;
        let current = presets.iter().position(|(_, preset)| preset == fabric);
        let entries: Vec<(usize, &str, &str)> = presets
            .iter()
            .enumerate()
            .map(|(i, &(name, _))| (i, name, "Takes all values of this fabric. They are plausible, not measured."))
            .collect();
        let naming = naming("Preset", "Fabrics to begin with. \"own values\" where the fabric is none of them.");
        if let Some(chosen) = choice(ui, naming, false, current, "own values", &entries)
            && let Some((_, preset)) = presets.into_iter().nth(chosen)
        {
            model.asks.push(Ask::Preset(preset));
        }
        if model.follows_asset {
            ui.label(RichText::new("Follows its asset until a value is edited.").weak());
        }
        for (field, knob) in &FABRIC {
            if let Some(value) = fabric.get_field_mut::<f32>(field) {
                knob.show(ui, value, model.differing.contains(field));
            }
        }
    });
}

/// How a cloth is solved.
pub(super) fn show_solver(ui: &mut Ui, model: &mut Model) {
    let Model { settings, differing, readings, cloths, chosen, .. } = model;
    let Some((cloth, _)) = &mut settings.cloth else { return };
    let differs = |field| differing.contains(&field);
    section(ui, naming("Solver", "How the springs are computed: speed against accuracy."), true, |ui| {
        const SOLVERS: [(ClothSolver, &str, &str); 2] = [
            (ClothSolver::Xpbd, "XPBD", "Stable at any stiffness and time step. For games."),
            (ClothSolver::Explicit, "Explicit", "The textbook form: the most accurate, and many times as costly."),
        ];
        let naming_of = naming("Solver", "How the springs are integrated: XPBD for games, explicit to compare with.");
        if let Some(solver) = choice(ui, naming_of, differs("solver"), Some(cloth.solver), "", &SOLVERS) {
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
        for (entity, advice) in readings.advice.iter().take(MOST_ADVICE) {
            let name = cloths.iter().find(|(cloth, _)| cloth == entity).filter(|_| chosen.len() > 1);
            let name = name.map_or(String::new(), |(_, name)| format!("{name}: "));
            let text = RichText::new(format!("⚠ {name}{}", advice.full)).color(ui.visuals().warn_fg_color);
            ui.add(Label::new(text).wrap());
        }
    });
}

fn show_tethers(ui: &mut Ui, cloth: &mut Cloth, differs: bool) {
    let naming = naming(
        "Tethers",
        "Keeps every particle within the cloth's own length of its pins: the cure for cloth that stretches like rubber. \
         XPBD only.",
    );
    let mut is_on = cloth.tether_slack.is_some();
    if tick(ui, naming, differs, &mut is_on) {
        cloth.tether_slack = is_on.then_some(Cloth::default().tether_slack.unwrap_or_default());
    }
    if let Some(slack) = &mut cloth.tether_slack {
        SLACK.show(ui, slack, differs);
    }
}
