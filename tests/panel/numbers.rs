//! The panel tells what a cloth's mesh was found to be.

use bevy::prelude::*;
use bevy_drape::{
    panel::{ClothChoice, ClothPanel},
    prelude::*,
};
use egui_kittest::kittest::NodeT;

use crate::common::*;

/// Whether the panel has a text.
fn shows(desk: &Desk, text: &str) -> bool {
    desk.harness.root().children_recursive().any(|node| node.accesskit_node().value().as_deref() == Some(text))
}

#[test]
fn the_rows_and_columns_of_the_chosen_cloths_are_told() {
    let mut app = app();
    spawn_cloth(&mut app, "Curtain", ());
    let mut desk = Desk::new(app);
    desk.frames(3);
    assert!(shows(&desk, "8 rows, 8 columns, no levels"));
    let fan = desk.app().world_mut().resource_mut::<Assets<Mesh>>().add(Mesh::from(Circle::new(0.5)));
    desk.app().world_mut().spawn((Mesh3d(fan), Cloth::default(), Name::new("Fan")));
    desk.app().world_mut().resource_mut::<ClothPanel>().choice = ClothChoice::All;
    desk.frames(3);
    assert!(shows(&desk, "various"));
}
