//! Text over the picture: what the user can do, and what an example measures.

use bevy::prelude::*;
use bevy_egui::{
    EguiContexts, EguiPlugin, EguiPrimaryContextPass,
    egui::{Align2, Area, Color32, Frame, Label, RichText, TextWrapMode, vec2},
};

/// Distance from the borders of the picture, in points.
const MARGIN: f32 = 14.0;

const TEXT_COLOUR: Color32 = Color32::from_rgb(247, 245, 240);
const BACKGROUND: Color32 = Color32::from_rgba_premultiplied(14, 15, 18, 140);

/// What is written over the picture: nothing where it is empty.
#[derive(Resource, Clone, Debug, Default)]
pub struct Overlay {
    /// What the user can do, at the bottom left.
    pub help: String,
    /// What is measured, at the top left.
    pub readings: String,
}

pub fn plugin(app: &mut App) {
    app.init_resource::<Overlay>().add_plugins(EguiPlugin::default()).add_systems(EguiPrimaryContextPass, show);
}

fn show(mut contexts: EguiContexts, overlay: Res<Overlay>) -> Result {
    let context = contexts.ctx_mut()?;
    let corners = [
        ("readings", &overlay.readings, Align2::LEFT_TOP, vec2(MARGIN, MARGIN)),
        ("help", &overlay.help, Align2::LEFT_BOTTOM, vec2(MARGIN, -MARGIN)),
    ];
    for (name, text, corner, place) in corners.into_iter().filter(|(_, text, ..)| !text.is_empty()) {
        Area::new(name.into()).anchor(corner, place).interactable(false).show(context, |ui| {
            Frame::new().fill(BACKGROUND).corner_radius(6).inner_margin(vec2(10.0, 5.0)).show(ui, |ui| {
                let text = RichText::new(text).size(15.0).color(TEXT_COLOUR);
                ui.add(Label::new(text).wrap_mode(TextWrapMode::Extend));
            });
        });
    }
    Ok(())
}
