//! The sections that edit what acts on cloths: gravity, air and wind.

use bevy_egui::egui::Ui;

use super::{
    control::{button, buttons, choice, naming, section},
    knob::Knob,
    model::{Ask, Model},
};

const GRAVITY: Knob = Knob::new(
    "Gravity, m/s²",
    "",
    (-20.0, 20.0),
    (-1e3, 1e3),
    "Gravity on all cloth along X, Y and Z, in m/s². Earth's is -9.81 along Y, the moon's -1.62.",
);
const GRAVITY_SCALE: Knob = Knob::new(
    "Gravity scale",
    "",
    (-1.0, 3.0),
    (-1e3, 1e3),
    "Factor on gravity for this cloth, without a unit. 1 for most; 0 floats, negative rises.",
);
const AIR_DENSITY: Knob = Knob::new(
    "Air density",
    "kg/m³",
    (0.0, 3.0),
    (0.0, 1e3),
    "Density of the air around, in kg/m³: how hard wind pushes and how much still air brakes. 1.225 at sea level, 0 for \
     a vacuum.",
);
const HEADING: Knob = Knob::new(
    "Heading",
    "°",
    (-180.0, 180.0),
    (-360.0, 360.0),
    "Where the wind blows to, seen from above, in degrees: 0 along +Z, 90 along +X, as a rotation about Y turns. The \
     wind's entity turns it further.",
);
const ELEVATION: Knob = Knob::new(
    "Elevation",
    "°",
    (-90.0, 90.0),
    (-90.0, 90.0),
    "How steeply the wind blows upwards, in degrees. 0 for along the ground.",
);
const SPEED: Knob = Knob::new(
    "Wind speed",
    "m/s",
    (0.0, 30.0),
    (0.0, 200.0),
    "Mean speed in m/s. 2 is a light breeze, 8 a fresh one, 20 a gale. From about 3 on, wind lifts light cloth that only \
     lies on something.",
);
const GUSTS: Knob = Knob::new(
    "Gusts",
    "",
    (0.0, 1.5),
    (0.0, 10.0),
    "Strength of gusts as a share of the mean speed. 0 for none, 0.5 for gusty, 1 for calm to double.",
);
const GUST_PERIOD: Knob =
    Knob::new("Gust period", "s", (0.5, 20.0), (0.01, 1e4), "Time from gust to gust in s. 2 to 10.").logarithmic(0.5);
const TURBULENCE: Knob = Knob::new(
    "Turbulence",
    "",
    (0.0, 1.0),
    (0.0, 10.0),
    "Strength of eddies as a share of the mean speed. 0 for none, 0.1 over open land, 0.3 in a town.",
);
const EDDY_SIZE: Knob = Knob::new(
    "Eddy size",
    "m",
    (0.1, 10.0),
    (0.01, 1e4),
    "Size of the eddies in m. 0.3 to 5: small ones ripple the cloth, large ones sway it.",
)
.logarithmic(0.1);

/// Gravity and the air around.
pub(super) fn show_surroundings(ui: &mut Ui, model: &mut Model) {
    let Model { settings, differing, .. } = model;
    let naming = naming("Gravity and air", "Gravity acts on all cloths; its scale and the air are the cloth's own.");
    section(ui, naming, false, |ui| {
        if let Some(gravity) = &mut settings.gravity {
            let mut values = gravity.to_array();
            if GRAVITY.show_vector(ui, &mut values) {
                *gravity = values.into();
            }
        }
        if let Some((cloth, _)) = &mut settings.cloth {
            GRAVITY_SCALE.show(ui, &mut cloth.gravity_scale, differing.cloth.contains(&"gravity_scale"));
            AIR_DENSITY.show(ui, &mut cloth.fluid_density, differing.cloth.contains(&"fluid_density"));
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
