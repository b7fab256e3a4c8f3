//! Switches of the debug gizmos.

use bevy::prelude::*;
use bevy_drape::debug::{ClothDebugConfig, ClothDebugView};
use bevy_egui::egui::accesskit::Role;

use crate::common::*;

/// Presses the box for all cloths (0) or for the chosen one (1).
fn switch(desk: &mut Desk, name: &str, column: usize) {
    let at = desk.controls(Role::CheckBox, name).nth(column).expect("a box").rect().center();
    desk.click_at(at);
    desk.frame();
}

#[test]
fn gizmos_are_switched_for_all_or_for_the_chosen_cloth() {
    let mut app = app();
    let curtain = spawn_cloth(&mut app, "Curtain", ());
    let flag = spawn_cloth(&mut app, "Flag", ());
    let mut desk = Desk::new(app);
    switch(&mut desk, "Normals", 0);
    desk.click(Role::CheckBox, "Colliders");
    let config = *desk.resource::<ClothDebugConfig>();
    assert!(config.view.normals && config.colliders && !config.view.bounds);
    assert!(!desk.app().world().entity(curtain).contains::<ClothDebugView>());

    switch(&mut desk, "Bounds", 1);
    assert_eq!(desk.get::<ClothDebugView>(curtain), &ClothDebugView { bounds: true, ..default() });
    assert!(!desk.app().world().entity(flag).contains::<ClothDebugView>());
    assert_eq!(desk.resource::<ClothDebugConfig>(), &config);
    switch(&mut desk, "Bounds", 1);
    assert_eq!(desk.get::<ClothDebugView>(curtain), &ClothDebugView::default());
}

#[test]
fn sizes_that_a_game_has_set_are_kept() {
    let mut app = app();
    let cloth = spawn_cloth(&mut app, "Curtain", ClothDebugView { mark_size: 0.5, ..default() });
    app.world_mut().resource_mut::<ClothDebugConfig>().wind_cells = 9;
    let mut desk = Desk::new(app);
    switch(&mut desk, "Pins", 1);
    switch(&mut desk, "Pins", 0);
    assert_eq!(desk.get::<ClothDebugView>(cloth), &ClothDebugView { pins: true, mark_size: 0.5, ..default() });
    assert_eq!(desk.resource::<ClothDebugConfig>().wind_cells, 9);
    assert!(desk.resource::<ClothDebugConfig>().view.pins);
}
