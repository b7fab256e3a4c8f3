//! The sections that edit what acts on cloths: gravity, air and wind.

use bevy_egui::egui::Ui;

use super::{
    control::{Knob, Scale, button, buttons, choice, naming, section, vector},
    model::{Ask, Model},
    tuning::{AIR_DENSITY, GRAVITY_SCALE},
};

const GRAVITY: Knob = Knob {
    naming: naming(
        "Gravity, m/s²",
        "Gravity on all cloth along X, Y and Z, in m/s². Earth's is -9.81 along Y, the moon's -1.62.",
    ),
    unit: "",
    range: (-20.0, 20.0),
    scale: Scale::Linear,
    limits: (-1e3, 1e3),
};
const HEADING: Knob = Knob {
    naming: naming(
        "Heading",
        "Where the wind blows to, seen from above, in degrees: 0 along +Z, 90 along +X, as a \
        rotation about Y turns. The wind's entity turns it further.",
    ),
    unit: "°",
    range: (-180.0, 180.0),
    scale: Scale::Linear,
    limits: (-360.0, 360.0),
};
const ELEVATION: Knob = Knob {
    naming: naming("Elevation", "How steeply the wind blows upwards, in degrees. 0 for along the ground."),
    unit: "°",
    range: (-90.0, 90.0),
    scale: Scale::Linear,
    limits: (-90.0, 90.0),
};
const SPEED: Knob = Knob {
    naming: naming(
        "Wind speed",
        "Mean speed in m/s. 2 is a light breeze, 8 a fresh one, 20 a gale. From about 3 on, \
        wind lifts light cloth that only lies on something.",
    ),
    unit: "m/s",
    range: (0.0, 30.0),
    scale: Scale::Linear,
    limits: (0.0, 200.0),
};
const GUSTS: Knob = Knob {
    naming: naming(
        "Gusts",
        "Strength of gusts as a share of the mean speed. 0 for none, 0.5 for gusty, 1 for calm to \
        double.",
    ),
    unit: "",
    range: (0.0, 1.5),
    scale: Scale::Linear,
    limits: (0.0, 10.0),
};
const GUST_PERIOD: Knob = Knob {
    naming: naming("Gust period", "Time from gust to gust in s. 2 to 10."),
    unit: "s",
    range: (0.5, 20.0),
    scale: Scale::Logarithmic(0.5),
    limits: (0.01, 1e4),
};
const TURBULENCE: Knob = Knob {
    naming: naming(
        "Turbulence",
        "Strength of eddies as a share of the mean speed. 0 for none, 0.1 over open land, 0.3 \
        in a town.",
    ),
    unit: "",
    range: (0.0, 1.0),
    scale: Scale::Linear,
    limits: (0.0, 10.0),
};
const EDDY_SIZE: Knob = Knob {
    naming: naming("Eddy size", "Size of the eddies in m. 0.3 to 5: small ones ripple the cloth, large ones sway it."),
    unit: "m",
    range: (0.1, 10.0),
    scale: Scale::Logarithmic(0.1),
    limits: (0.01, 1e4),
};

/// Gravity and the air around.
pub(super) fn show_surroundings(ui: &mut Ui, model: &mut Model) {
    let Model { settings, differing, .. } = model;
    let naming = naming("Gravity and air", "Gravity acts on all cloths; its scale and the air are the cloth's own.");
    section(ui, naming, false, |ui| {
        if let Some(gravity) = &mut settings.gravity {
            let mut values = gravity.to_array();
            if vector(ui, &GRAVITY, &mut values) {
                *gravity = values.into();
            }
        }
        if let Some((cloth, _)) = &mut settings.cloth {
            GRAVITY_SCALE.show(ui, &mut cloth.gravity_scale, differing.contains(&"gravity_scale"));
            AIR_DENSITY.show(ui, &mut cloth.fluid_density, differing.contains(&"fluid_density"));
        }
    });
}

/// The winds.
pub(super) fn show_wind(ui: &mut Ui, model: &mut Model) {
    section(ui, naming("Wind", "Winds blow on all cloths in their region."), false, |ui| {
        if model.winds.is_empty() {
            let naming = naming("Add wind", "Adds a wind that blows everywhere, with 2 m/s along +Z to begin with.");
            buttons(ui, "add", |ui| {
                if button(ui, naming, true) {
                    model.asks.push(Ask::AddWind);
                }
            });
            return;
        }
        show_choice(ui, model);
        let Some((_, wind, aim)) = &mut model.settings.wind else { return };
        HEADING.show(ui, &mut aim.heading, false);
        ELEVATION.show(ui, &mut aim.elevation, false);
        SPEED.show(ui, &mut aim.speed, false);
        GUSTS.show(ui, &mut wind.gusts, false);
        GUST_PERIOD.show(ui, &mut wind.gust_period, false);
        TURBULENCE.show(ui, &mut wind.turbulence, false);
        EDDY_SIZE.show(ui, &mut wind.eddy_size, false);
        let naming = naming("Copy wind as Rust", "Puts the wind on the clipboard as the code of its component.");
        buttons(ui, "copy", |ui| {
            if button(ui, naming, true)
                && let Some(code) = model.settings.wind_code()
            {
                ui.ctx().copy_text(code);
            }
        });
    });
}

fn show_choice(ui: &mut Ui, model: &mut Model) {
    let chosen = model.settings.wind.as_ref().map(|&(entity, ..)| entity);
    let hover = "Edits this wind.";
    let entries: Vec<_> = model.winds.iter().map(|(entity, name)| (*entity, name.as_str(), hover)).collect();
    let naming = naming("Which wind", "The wind that is edited below.");
    if let Some(wind) = choice(ui, naming, false, chosen, "", &entries) {
        model.asks.push(Ask::ChooseWind(wind));
    }
}
