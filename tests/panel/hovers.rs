//! Everything explains itself, and egui has nothing to complain of.

use bevy::prelude::*;
use bevy_drape::prelude::*;
use bevy_egui::egui::{self, Order, Rect, Shape, accesskit::Role, epaint::ClippedShape};
use egui_kittest::kittest::NodeT;

use crate::common::*;

const CONTROLS: [Role; 8] = [
    Role::Button,
    Role::CheckBox,
    Role::ComboBox,
    Role::Slider,
    Role::SpinButton,
    Role::RadioButton,
    Role::TextInput,
    Role::ColorWell,
];

/// A desk with all that the panel can show.
fn full() -> Desk {
    let mut app = app();
    spawn_cloth(&mut app, "Curtain", ());
    spawn_cloth(&mut app, "Flag", Fabric::SILK);
    app.world_mut().spawn(Wind::default());
    let mut desk = Desk::new(app);
    desk.click(Role::Button, "Pause");
    desk
}

/// Places of all controls that can be seen, and what to call them.
fn controls(desk: &Desk) -> Vec<(Rect, String)> {
    let found = desk.harness.root().children_recursive().filter_map(|node| {
        let role = node.accesskit_node().role();
        let name = || format!("{role:?} {:?} {:?}", node.accesskit_node().label(), node.accesskit_node().value());
        CONTROLS.contains(&role).then(|| (node.rect(), name()))
    });
    found.collect()
}

fn has_tooltip(desk: &Desk) -> bool {
    desk.harness
        .ctx
        .memory(|memory| memory.areas().visible_layer_ids().iter().any(|layer| layer.order == Order::Tooltip))
}

/// Rests the pointer on each control in turn.
#[track_caller]
fn assert_explained(desk: &mut Desk, controls: &[(Rect, String)]) {
    for (rect, name) in controls {
        desk.harness.remove_cursor();
        desk.harness.run_steps(3);
        assert!(!has_tooltip(desk));
        desk.harness.hover_at(rect.center());
        desk.harness.run_steps(8);
        assert!(has_tooltip(desk), "{name} at {rect:?} has no explanation");
    }
    desk.harness.remove_cursor();
    desk.harness.run_steps(3);
}

#[test]
fn every_control_explains_itself() {
    let mut desk = full();
    let all = controls(&desk);
    assert!(all.len() >= 70, "{} controls", all.len());
    assert_explained(&mut desk, &all);
    desk.choose(Role::ComboBox, "Solver", "Explicit");
    let explicit = controls(&desk);
    assert_explained(&mut desk, &explicit);
}

#[test]
fn every_control_of_clothes_explains_itself() {
    let mut app = app();
    let map = ClothMap::Painted { scale: 1.0, missing: 0.5 };
    let skin = ClothSkin { max_distance: map, backstop: Some(0.01), ..default() };
    let cloth = spawn_cloth(&mut app, "Cape", (skin, ClothInertia::default(), ClothTeleport::default()));
    app.insert_resource(ClothBudget { milliseconds: 2.0 });
    let mut desk = Desk::new(app);
    let all = controls(&desk);
    assert_explained(&mut desk, &all);
    desk.get_mut::<ClothSkin>(cloth).max_distance = ClothMap::Uniform(0.3);
    desk.frame();
    let uniform = controls(&desk);
    assert_explained(&mut desk, &uniform);
}

#[test]
fn every_control_of_springs_explains_itself() {
    let mut app = app();
    spawn_cloth(&mut app, "Curtain", ClothSprings::default());
    let mut desk = Desk::new(app);
    let all = controls(&desk);
    assert_explained(&mut desk, &all);
}

#[test]
fn every_entry_of_every_list_explains_itself() {
    let mut desk = full();
    let lists = [
        (Role::ComboBox, "Cloth"),
        (Role::ComboBox, "Preset"),
        (Role::ComboBox, "Solver"),
        (Role::ComboBox, "Timing"),
        (Role::ComboBox, "Which wind"),
        (Role::Button, "Pin ⏷"),
        (Role::Button, "Revert ⏷"),
        (Role::Button, "Copy ⏷"),
    ];
    for (role, name) in lists {
        let closed: Vec<_> = controls(&desk).into_iter().map(|(_, name)| name).collect();
        let at = desk.control(role, name).rect().center();
        desk.click_at(at);
        let entries: Vec<_> = controls(&desk).into_iter().filter(|(_, name)| !closed.contains(name)).collect();
        assert!(!entries.is_empty(), "{name}");
        assert_explained(&mut desk, &entries);
        desk.harness.key_press(egui::Key::Escape);
        desk.harness.run();
    }
}

#[test]
fn a_panel_without_cloth_or_wind_explains_itself() {
    let mut desk = Desk::new(app());
    let all = controls(&desk);
    assert_explained(&mut desk, &all);
}

fn texts(shape: &Shape, found: &mut Vec<String>) {
    match shape {
        Shape::Vec(shapes) => shapes.iter().for_each(|shape| texts(shape, found)),
        Shape::Text(text) => found.push(text.galley.text().to_owned()),
        _ => {}
    }
}

#[test]
fn no_two_controls_share_an_id() {
    let mut desk = full();
    desk.frames(2);
    let mut found = Vec::new();
    desk.harness.output().shapes.iter().for_each(|ClippedShape { shape, .. }| texts(shape, &mut found));
    assert!(found.iter().any(|text| text == "Density"));
    assert_eq!(found.iter().find(|text| text.contains(" ID ")), None, "egui paints its complaint");
}

#[test]
fn the_panel_is_as_narrow_as_it_says() {
    let mut desk = full();
    desk.harness.set_size(egui::vec2(340.0, 2400.0));
    desk.frames(2);
    let widest = controls(&desk).into_iter().max_by(|(one, _), (other, _)| one.right().total_cmp(&other.right()));
    assert!(widest.as_ref().is_some_and(|(rect, _)| rect.right() <= 340.0), "{widest:?}");
    let slider = desk.control(Role::Slider, "Density").rect();
    assert!(slider.width() > 60.0, "{slider:?}");
}
