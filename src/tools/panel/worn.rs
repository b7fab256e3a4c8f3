//! The sections that edit how clothes follow their skeleton, where they have such settings.

use bevy_egui::egui::Ui;

use super::{
    control::{Naming, choice, naming, section, tick},
    knob::{self, Knob},
    list::Differing,
    model::Model,
    pick,
};
use crate::skin::{ClothInertia, ClothMap, ClothSkin, ClothTeleport};

/// Distance to begin with where one is given, m.
const BEGUN_DISTANCE: f32 = 0.3;
/// Depth of the backstop to begin with, m.
const BEGUN_BACKSTOP: f32 = 0.01;

const SKIN: Naming = naming("Skin", "How closely the cloth follows its skeleton (ClothSkin).");
const INERTIA: Naming = naming("Inertia", "How much of its skeleton's motion the cloth feels (ClothInertia).");
const TELEPORT: Naming = naming(
    "Teleport",
    "When a move of its skeleton is a teleport, and what becomes of the cloth then (ClothTeleport). Both length and speed have to be \
     exceeded.",
);
const MAX_DISTANCE: Naming = naming(
    "Max distance",
    "Largest distance of each vertex from where its skeleton has it (ClothSkin::max_distance): painted on the mesh, or the same for \
     all.",
);
const FREE: Naming = naming(
    "Free if unpainted",
    "A mesh that nothing is painted on has no largest distance: nothing but its pins holds it.",
);
const BACKSTOP: Naming = naming(
    "Backstop",
    "A ball beneath each point of the animated surface that the cloth stays out of: a piece of the body.",
);

pub(super) fn show(ui: &mut Ui, model: &mut Model) {
    let Model { settings, differing, .. } = model;
    let beside = &mut settings.beside;
    if let Some(skin) = &mut beside.skin {
        section(ui, SKIN, true, |ui| show_skin(ui, skin, differing));
    }
    if let Some(inertia) = &mut beside.inertia {
        section(ui, INERTIA, false, |ui| show_inertia(ui, inertia, differing));
    }
    if let Some(teleport) = &mut beside.teleport {
        section(ui, TELEPORT, false, |ui| show_teleport(ui, teleport, differing));
    }
}

fn show_skin(ui: &mut Ui, skin: &mut ClothSkin, differing: &Differing) {
    let differs = |field| differing.skin.contains(&field);
    show_max_distance(ui, &mut skin.max_distance, differs("max_distance"));
    let mut is_on = skin.backstop.is_some();
    if tick(ui, BACKSTOP, differs("backstop"), &mut is_on) {
        skin.backstop = is_on.then_some(BEGUN_BACKSTOP);
    }
    if is_on {
        for field in ["backstop", "backstop_radius"] {
            knob::show(ui, skin, field, differs(field));
        }
    }
    for field in ["pull", "pull_damping"] {
        knob::show(ui, skin, field, differs(field));
    }
    pick::show_switch(ui, skin, "meets_others", differs("meets_others"));
}

fn show_max_distance(ui: &mut Ui, map: &mut ClothMap, differs: bool) {
    const ENTRIES: [(bool, &str, &str); 2] = [
        (true, "as painted", "What is painted on the mesh as ATTRIBUTE_CLOTH, times a scale."),
        (false, "the same for all", "One distance for all vertices, whatever is painted."),
    ];
    let is_painted = matches!(map, ClothMap::Painted { .. });
    if let Some(is_painted) = choice(ui, MAX_DISTANCE, differs, Some(is_painted), "", &ENTRIES) {
        *map = if is_painted { ClothMap::default() } else { ClothMap::Uniform(BEGUN_DISTANCE) };
    }
    match map {
        ClothMap::Painted { scale, missing } => {
            show_distance(ui, "Painted", 0, scale, differs);
            let mut is_free = missing.is_infinite();
            if tick(ui, FREE, differs, &mut is_free) {
                *missing = if is_free { f32::INFINITY } else { BEGUN_DISTANCE };
            }
            if !is_free {
                show_distance(ui, "Painted", 1, missing, differs);
            }
        }
        ClothMap::Uniform(distance) => show_distance(ui, "Uniform", 0, distance, differs),
    }
}

fn show_distance(ui: &mut Ui, variant: &str, place: usize, value: &mut f32, differs: bool) {
    if let Some(knob) = Knob::of_variant::<ClothMap>(variant, place) {
        knob.show(ui, value, differs);
    }
}

fn show_inertia(ui: &mut Ui, inertia: &mut ClothInertia, differing: &Differing) {
    for field in ["linear", "angular", "max_speed", "max_angular_speed"] {
        knob::show(ui, inertia, field, differing.inertia.contains(&field));
    }
}

fn show_teleport(ui: &mut Ui, teleport: &mut ClothTeleport, differing: &Differing) {
    let differs = |field| differing.teleport.contains(&field);
    pick::show(ui, teleport, "mode", differs("mode"));
    for field in ["distance", "speed", "angle", "angular_speed"] {
        knob::show(ui, teleport, field, differs(field));
    }
}
