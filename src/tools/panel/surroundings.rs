//! The sections that edit what acts on cloths: gravity, air and wind.

use bevy_egui::egui::Ui;

use super::{
    control::{button, buttons, choice, naming, section},
    knob::{self, Knob},
    model::{Ask, Model},
};
use crate::surroundings::{ClothGravity, wind::Wind};

/// Gravity and the air around.
pub(super) fn show_surroundings(ui: &mut Ui, model: &mut Model) {
    let Model { settings, differing, .. } = model;
    let naming = naming("Gravity and air", "Gravity acts on all cloths; its scale and the air are the cloth's own.");
    section(ui, naming, false, |ui| {
        if let Some(gravity) = &mut settings.gravity
            && let Some(knob) = Knob::of_all::<ClothGravity>()
        {
            let mut values = gravity.to_array();
            if knob.show_vector(ui, &mut values) {
                *gravity = values.into();
            }
        }
        if let Some((cloth, _)) = &mut settings.cloth {
            for field in ["gravity_scale", "fluid_density"] {
                knob::show(ui, cloth, field, differing.cloth.contains(&field));
            }
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
        for field in ["heading", "elevation"] {
            knob::show(ui, aim, field, false);
        }
        // What the velocity's length is.
        if let Some(knob) = Knob::of::<Wind>("velocity") {
            knob.show(ui, &mut aim.speed, false);
        }
        for field in ["gusts", "gust_period", "turbulence", "eddy_size"] {
            knob::show(ui, wind, field, false);
        }
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
