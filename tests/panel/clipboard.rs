//! What is put on the clipboard.

use bevy::prelude::*;
use bevy_drape::{prelude::*, solver::LevelPass};
use bevy_egui::egui::accesskit::Role;

use crate::common::*;

#[test]
fn the_edited_cloth_is_copied_as_rust() {
    let mut app = app();
    spawn_cloth(&mut app, "Curtain", ());
    let mut desk = Desk::new(app);
    assert_eq!(desk.copy("Copy as Rust").as_deref(), Some("Cloth::default(),\nFabric::default(),\n"));
    desk.click(Role::CheckBox, "Substeps by hand");
    desk.type_value("Substeps", "12");
    desk.type_value("Density", "0.2");
    desk.type_value("Bending rigidity", "5");
    let expected =
        "Cloth { substeps: Some(12), ..default() },\nFabric { density: 0.2, bending_rigidity: 5e-6, ..default() },\n";
    assert_eq!(desk.copy("Copy as Rust").as_deref(), Some(expected));
    // What was copied, as code.
    let _: (Cloth, Fabric) =
        (Cloth { substeps: Some(12), ..default() }, Fabric { density: 0.2, bending_rigidity: 5e-6, ..default() });
}

#[test]
fn springs_are_copied_as_rust_where_there_are_any() {
    let mut app = app();
    spawn_cloth(&mut app, "Curtain", ClothSprings::default());
    let mut desk = Desk::new(app);
    desk.type_value("Bend", "5");
    let expected = "Cloth::default(),\nFabric::default(),\nClothSprings { bend_stiffness: 5.0, ..default() },\n";
    assert_eq!(desk.copy("Copy as Rust").as_deref(), Some(expected));
    // What was copied, as code.
    let _: (Cloth, Fabric, ClothSprings) =
        (Cloth::default(), Fabric::default(), ClothSprings { bend_stiffness: 5.0, ..default() });
}

#[test]
fn levels_are_copied_as_rust() {
    let mut app = app();
    let own = Cloth { levels: Some(vec![LevelPass { stride: 4, iterations: 6 }]), ..default() };
    spawn_cloth(&mut app, "Auto", ());
    spawn_cloth(&mut app, "Own", own);
    let mut desk = Desk::new(app);
    desk.click(Role::CheckBox, "Coarse levels");
    let expected = "Cloth { levels: Some(vec![]), ..default() },\nFabric::default(),\n";
    assert_eq!(desk.copy("Copy as Rust").as_deref(), Some(expected));
    desk.choose(Role::ComboBox, "Cloth", "Own");
    let expected =
        "Cloth { levels: Some(vec![LevelPass { stride: 4, iterations: 6 }]), ..default() },\nFabric::default(),\n";
    assert_eq!(desk.copy("Copy as Rust").as_deref(), Some(expected));
    // What was copied, as code.
    let _: [Cloth; 2] = [
        Cloth { levels: Some(vec![]), ..default() },
        Cloth { levels: Some(vec![LevelPass { stride: 4, iterations: 6 }]), ..default() },
    ];
}

#[test]
fn the_fabric_is_copied_as_a_file() {
    let mut app = app();
    let cloth = spawn_cloth(&mut app, "Curtain", Fabric::SILK);
    let mut desk = Desk::new(app);
    desk.type_value("Lift", "0.3");
    let text = desk.copy("Copy as RON").expect("a text");
    assert_eq!(Fabric::from_ron(&text).as_ref(), Ok(desk.get::<Fabric>(cloth)));
}

#[test]
fn the_wind_is_copied_as_rust() {
    let mut app = app();
    app.world_mut().spawn(Wind { velocity: Vec3::new(4.0, 0.0, 1.6), gusts: 0.6, ..default() });
    let mut desk = Desk::new(app);
    let at = desk.control(Role::Button, "Copy wind as Rust").rect().center();
    let expected = "Wind { velocity: Vec3::new(4.0, 0.0, 1.6), gusts: 0.6, ..default() },\n";
    assert_eq!(desk.copy_at(at).as_deref(), Some(expected));
}
