//! The head of the panel: which cloth, what is wrong with it, what to do about that, the clock, and the buttons.

use bevy_egui::egui::{Label, RichText, Ui};

use super::{
    ClothChoice,
    control::{Naming, button, buttons, choice, entry, explain, menu, naming, row},
    knob,
    model::{Ask, Model},
};
use crate::pins::{ClothEdge, Pins};

/// Cloths for which advice is shown. More would push all else out of the window.
const MOST_ADVICE: usize = 3;

/// The choice of a cloth.
pub(super) fn show_choice(ui: &mut Ui, model: &mut Model) {
    let hover = "Shows and edits this cloth.";
    let one = |(entity, name): &'_ (_, String)| (ClothChoice::One(*entity), name.clone(), hover);
    let mut entries: Vec<_> = model.cloths.iter().map(one).collect();
    if model.cloths.len() > 1 {
        let all = (ClothChoice::All, format!("All {} cloths", model.cloths.len()));
        entries.push((all.0, all.1, "An edit writes the value that was edited, and no other, to all cloths."));
    }
    let entries: Vec<_> = entries.iter().map(|(value, name, hover)| (*value, name.as_str(), *hover)).collect();
    let current = match (model.choice, model.chosen.first()) {
        (ClothChoice::First, Some(&first)) => ClothChoice::One(first),
        (choice, _) => choice,
    };
    let naming = naming("Cloth", "The cloth that is shown and edited below, or all of them.");
    if let Some(chosen) = choice(ui, naming, false, Some(current), "none", &entries) {
        model.choice = chosen;
    }
}

/// Whether all is well, in one line: what comes and goes mustn't push the controls about.
pub(super) fn show_status(ui: &mut Ui, model: &Model) {
    let (text, hover) = status(model);
    row(ui, naming("Status", "Whether the cloth runs, and runs well."), false, |ui, name| {
        let text = RichText::new(text);
        let text = if hover.is_some() { text.color(ui.visuals().warn_fg_color) } else { text };
        let label = ui.add(Label::new(text).truncate());
        (name | hover.map_or(label.clone(), |hover| explain(label, &hover)), ())
    });
}

/// The line, and what it is about where something is wrong.
fn status(model: &Model) -> (String, Option<String>) {
    let advice = &model.readings.advice;
    if model.cloths.is_empty() {
        ("⚠ There is no cloth".into(), Some("Nothing has a Cloth component.".into()))
    } else if let Some((brief, full)) = &model.trouble {
        (format!("⚠ {brief}"), Some(full.clone()))
    } else if let Some((_, first)) = advice.first() {
        let count = if model.chosen.len() > 1 { format!("{} cloths: ", advice.len()) } else { String::new() };
        (format!("⚠ {count}{}", first.brief), Some(format!("{}\n\nIt stands above the settings, too.", first.full)))
    } else {
        ("Runs well".into(), None)
    }
}

/// What to change where a cloth isn't solved well.
pub(super) fn show_advice(ui: &mut Ui, model: &Model) {
    for (entity, advice) in model.advice.iter().take(MOST_ADVICE) {
        let name = model.cloths.iter().find(|(cloth, _)| cloth == entity).filter(|_| model.chosen.len() > 1);
        let name = name.map_or(String::new(), |(_, name)| format!("{name}: "));
        let text = RichText::new(format!("⚠ {name}{}", advice.full)).color(ui.visuals().warn_fg_color);
        ui.add(Label::new(text).wrap());
    }
}

/// Pause, single step and slow motion.
pub(super) fn show_clock(ui: &mut Ui, model: &mut Model) {
    let Some(clock) = &mut model.settings.clock else { return };
    const PAUSE: Naming = naming("Pause", "Stops the whole game's clock (Time<Virtual>), not cloth alone.");
    const RESUME: Naming = naming("Resume", "Lets the whole game's clock go on.");
    const STEP: Naming =
        naming("Step", "Lets the whole game's clock go on for one fixed time step while it is paused.");
    knob::show(ui, clock, "speed", false);
    buttons(ui, "clock", |ui| {
        if button(ui, if clock.is_paused { RESUME } else { PAUSE }, true) {
            clock.is_paused ^= true;
        }
        if button(ui, STEP, clock.is_paused) {
            model.asks.push(Ask::Step);
        }
    });
}

/// What can be done to the chosen cloths.
pub(super) fn show_buttons(ui: &mut Ui, model: &mut Model) {
    buttons(ui, "buttons", |ui| {
        if button(ui, naming("Reset", "Puts the cloth back into its rest shape, at rest. Settings stay."), true) {
            model.asks.push(Ask::Reset);
        }
        menu(ui, naming("Pin", "Pins more of the cloth, where it is now."), |ui| {
            for (naming, pins) in pins() {
                if entry(ui, naming) {
                    model.asks.push(Ask::Pin(pins));
                }
            }
        });
        if button(ui, naming("Unpin all", "Takes all pins away: the cloth falls."), true) {
            model.asks.push(Ask::UnpinAll);
        }
        menu(ui, naming("Revert", "Goes back to what was there before anything was edited."), |ui| {
            show_reverts(ui, model)
        });
        menu(ui, naming("Copy", "Puts the settings on the clipboard."), |ui| show_copies(ui, model));
    });
}

fn show_reverts(ui: &mut Ui, model: &mut Model) {
    const CLOTH: Naming = naming(
        "This cloth",
        "Settings, fabric, springs, skin, inertia, teleport and pins of the chosen cloth as they were once it was ready. It follows its \
         fabric's file again.",
    );
    const SURROUNDINGS: Naming =
        naming("Wind, gravity, budget", "Gravity, the budget and all winds as they were. Added winds go.");
    const ALL: Naming = naming("Everything", "The chosen cloth, gravity, the budget and all winds.");
    if entry(ui, CLOTH) {
        model.asks.push(Ask::RevertCloth);
    }
    if entry(ui, SURROUNDINGS) {
        model.asks.push(Ask::RevertSurroundings);
    }
    if entry(ui, ALL) {
        model.asks.extend([Ask::RevertCloth, Ask::RevertSurroundings]);
    }
}

fn show_copies(ui: &mut Ui, model: &Model) {
    const RUST: Naming = naming(
        "Copy as Rust",
        "The code of Cloth, Fabric and, where they are there, ClothSprings, ClothSkin, ClothInertia and ClothTeleport, without what \
         is default.",
    );
    const RON: Naming = naming("Copy as RON", "The fabric as the text of a .fabric.ron file.");
    let settings = &model.settings;
    if entry(ui, RUST)
        && let Some(code) = settings.cloth_code()
    {
        ui.ctx().copy_text(code);
    }
    if entry(ui, RON)
        && let Some((_, fabric)) = &settings.cloth
    {
        ui.ctx().copy_text(fabric.to_ron());
    }
}

/// What can be pinned.
fn pins() -> [(Naming<'static>, Pins); 6] {
    const SHEET: &str = "Needs UVs that go over the sheet once.";
    [
        (naming("Corners", "The corners of a sheet of quads."), Pins::corners()),
        (naming("Top corners", "The ends of the top edge of a sheet of quads."), Pins::edge_corners(ClothEdge::Top)),
        (naming("Top edge", SHEET), Pins::edge(ClothEdge::Top)),
        (naming("Bottom edge", SHEET), Pins::edge(ClothEdge::Bottom)),
        (naming("Left edge", SHEET), Pins::edge(ClothEdge::Left)),
        (naming("Right edge", SHEET), Pins::edge(ClothEdge::Right)),
    ]
}
