//! A window that tunes cloth live, on egui.
//!
//! ```no_run
//! use bevy::prelude::*;
//! use bevy_drape::{panel::ClothPanelPlugin, prelude::*};
//!
//! App::new().add_plugins((DefaultPlugins, ClothPlugin::default(), ClothPanelPlugin::default()));
//! ```
//!
//! F1 shows and hides the window. A game's own egui can have the panel's content instead: [`cloth_panel`] draws it
//! anywhere. egui is `bevy_egui::egui`; a different version of it in a game doesn't fit.

mod actions;
mod advice;
mod aim;
mod beside;
mod budget;
mod code;
mod collision;
mod control;
#[cfg(feature = "debug")]
mod debug;
mod fabric;
mod fields;
mod knob;
mod list;
mod loaded;
mod memory;
mod model;
mod number;
mod pick;
mod readings;
mod settings;
mod solver;
mod springs;
mod surroundings;
mod watch;
mod wording;
mod worn;

use bevy::{ecs::system::SystemState, prelude::*, time::TimeSystems};
use bevy_egui::{
    EguiContexts, EguiPlugin, EguiPrimaryContextPass,
    egui::{self, Frame, Margin, ScrollArea, Ui, UiBuilder, Window},
    input::EguiWantsInput,
};

use crate::schedule::{ClothSystems, run_after_steps};
use memory::Memory;
use model::Model;

/// Width of the window when it first opens, in points.
const WIDTH: f32 = 340.0;
/// Its height is that of the screen but for so much, within these limits, in points.
const BESIDE: f32 = 76.0;
const HEIGHT: (f32, f32) = (300.0, 860.0);
/// From this height on, in points, only the settings scroll, and readings stay in sight.
const ROOMY: f32 = 480.0;

/// Adds the panel, and for its window bevy_egui's `EguiPlugin` where that isn't there yet.
///
/// A game that adds `EguiPlugin` itself, directly or with another plugin, has to do so before this one: Bevy takes no
/// plugin twice.
#[derive(Clone, Copy, Debug)]
pub struct ClothPanelPlugin {
    /// Shows and hides the panel, unless somebody types into egui. `None` for no key.
    pub key: Option<KeyCode>,
    /// Shown from the beginning.
    pub open: bool,
    /// The panel has a window of its own. Without one, a game calls [`cloth_panel`] where it wants the content.
    pub window: bool,
}

impl Default for ClothPanelPlugin {
    /// A window that F1 opens.
    fn default() -> Self {
        Self { key: Some(KeyCode::F1), open: false, window: true }
    }
}

/// The panel. A game may show and hide it, and choose what it edits, as when a cloth is clicked at.
#[derive(Resource, Debug, Default)]
pub struct ClothPanel {
    /// Whether the window is shown. Without one, a game that embeds the panel may heed it.
    pub open: bool,
    /// Which cloth is shown and edited.
    pub choice: ClothChoice,
    memory: Memory,
}

/// Which cloth the panel shows and edits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Default, Debug, Clone, PartialEq)]
pub enum ClothChoice {
    /// The first by name. Also where the chosen one is gone.
    #[default]
    First,
    /// This one.
    One(Entity),
    /// All: an edit writes the value that was edited to every one of them.
    All,
}

impl Plugin for ClothPanelPlugin {
    fn build(&self, app: &mut App) {
        if self.window && !app.is_plugin_added::<EguiPlugin>() {
            app.add_plugins(EguiPlugin::default());
        }
        app.insert_resource(ClothPanel { open: self.open, ..default() })
            .add_systems(First, memory::begin_frame.after(TimeSystems))
            .add_systems(PreUpdate, loaded::remember.after(ClothSystems::Prepare))
            .add_systems(PostUpdate, memory::note_step.after(ClothSystems::Late).before(ClothSystems::Draw));
        if let Some(key) = self.key {
            app.add_systems(Update, toggle(key));
        }
        if self.window {
            app.add_systems(EguiPrimaryContextPass, show_window);
        }
    }

    fn finish(&self, app: &mut App) {
        run_after_steps(app, "ClothPanelPlugin", memory::note_step);
    }
}

fn toggle(
    key: KeyCode,
) -> impl FnMut(Option<Res<ButtonInput<KeyCode>>>, Option<Res<EguiWantsInput>>, ResMut<ClothPanel>) {
    move |keys, egui, mut panel| {
        let is_typing = egui.is_some_and(|egui| egui.wants_keyboard_input());
        if keys.is_some_and(|keys| keys.just_pressed(key)) && !is_typing {
            panel.open ^= true;
        }
    }
}

fn show_window(world: &mut World, contexts: &mut SystemState<EguiContexts>) {
    if !world.resource::<ClothPanel>().open {
        return;
    }
    // None while no camera has one.
    let context = contexts.get_mut(world).ok().and_then(|mut contexts| contexts.ctx_mut().ok().cloned());
    let Some(context) = context else { return };
    let mut is_open = true;
    let height = (context.content_rect().height() - BESIDE).clamp(HEIGHT.0, HEIGHT.1);
    Window::new("Cloth").id(egui::Id::new("bevy_drape panel")).default_size([WIDTH, height]).open(&mut is_open).show(
        &context,
        |ui| {
            let is_roomy = ui.available_height() >= ROOMY;
            let mut draw = |ui: &mut Ui| draw(ui, world, is_roomy);
            if is_roomy { draw(ui) } else { scroll(ui, draw) }
        },
    );
    if !is_open {
        world.resource_mut::<ClothPanel>().open = false;
    }
}

/// Draws the panel's content and does what its controls say. For a game's own egui; [`ClothPanelPlugin`] has to be there
/// all the same, without its window. It doesn't scroll by itself: put it into a scroll area where it may be higher than what it is in.
///
/// Edits act in the next step. A component is written only where a value has been changed.
pub fn cloth_panel(ui: &mut Ui, world: &mut World) {
    draw(ui, world, false);
}

/// Draws it, with settings that scroll below a head that doesn't where that `is_roomy`.
fn draw(ui: &mut Ui, world: &mut World, is_roomy: bool) {
    // Taken out, not borrowed: what an edit sets off may look at the panel.
    let mut panel = world.get_resource_or_init::<ClothPanel>();
    let mut memory = core::mem::take(&mut panel.bypass_change_detection().memory);
    let choice = panel.choice;
    memory.shown_for = 2;

    let mut model = Model::read(world, choice, &mut memory);
    if memory.chosen != model.chosen {
        memory.chosen.clone_from(&model.chosen);
        memory.step_times.clear();
        memory.frame = None;
    }
    // egui may draw a frame more than once.
    let frame = ui.ctx().cumulative_frame_nr();
    if memory.frame != Some(frame) {
        memory.frame = Some(frame);
        watch::measure(world, &mut memory);
    }
    model.readings.clone_from(&memory.readings);
    // What comes and goes mustn't push a control about that is held.
    if ui.ctx().dragged_id().is_none() {
        memory.advice.clone_from(&memory.readings.advice);
    }
    model.advice.clone_from(&memory.advice);
    let before = model.settings.clone();
    let id = ui.id().with("bevy_drape panel");
    ui.scope_builder(UiBuilder::new().id(id), |ui| {
        if is_roomy {
            beside_scroll_bar(ui, |ui| show_head(ui, &mut model, &memory));
            ui.separator();
            scroll(ui, |ui| show_settings(ui, &mut model));
        } else {
            show_head(ui, &mut model, &memory);
            show_settings(ui, &mut model);
        }
    });
    let choice = model.choice;
    model.write(world, &before, &mut memory);

    let mut panel = world.get_resource_or_init::<ClothPanel>();
    panel.bypass_change_detection().memory = memory;
    if panel.choice != choice {
        panel.choice = choice;
    }
}

/// A part of the window that scrolls.
fn scroll(ui: &mut Ui, content: impl FnOnce(&mut Ui)) {
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| beside_scroll_bar(ui, content));
}

/// Leaves room for the scroll bar, which floats over what it scrolls.
fn beside_scroll_bar(ui: &mut Ui, content: impl FnOnce(&mut Ui)) {
    Frame::new().inner_margin(Margin { right: 8, ..default() }).show(ui, content);
}

/// What one looks at while one edits.
fn show_head(ui: &mut Ui, model: &mut Model, memory: &Memory) {
    actions::show_choice(ui, model);
    actions::show_status(ui, model);
    if !model.chosen.is_empty() {
        readings::show(ui, model, &memory.step_times);
    }
    actions::show_clock(ui, model);
    if !model.chosen.is_empty() {
        actions::show_buttons(ui, model);
    }
}

fn show_settings(ui: &mut Ui, model: &mut Model) {
    control::group(ui, "settings", |ui| {
        if !model.chosen.is_empty() {
            actions::show_advice(ui, model);
            fabric::show(ui, model);
            springs::show(ui, model);
            worn::show(ui, model);
            solver::show(ui, model);
            collision::show(ui, model);
        }
        surroundings::show_surroundings(ui, model);
        surroundings::show_wind(ui, model);
        budget::show(ui, model);
        if !model.chosen.is_empty() {
            readings::show_mesh(ui, &model.readings);
        }
        #[cfg(feature = "debug")]
        debug::show(ui, model);
    });
}
