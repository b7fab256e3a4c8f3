//! Which cloth the panel is about.

use bevy::prelude::*;
use bevy_drape::{
    panel::{ClothChoice, ClothPanel},
    prelude::*,
};
use bevy_egui::egui::accesskit::Role;
use egui_kittest::kittest::Queryable;

use crate::common::*;

#[test]
fn the_first_by_name_comes_first_and_another_can_be_chosen() {
    let mut app = app();
    let flag = spawn_cloth(&mut app, "Flag", ());
    let curtain = spawn_cloth(&mut app, "Curtain", ());
    let mut desk = Desk::new(app);
    desk.type_value("Density", "0.5");
    assert_eq!(
        (desk.get::<Fabric>(curtain).density, desk.get::<Fabric>(flag).density),
        (0.5, Fabric::default().density)
    );
    desk.choose(Role::ComboBox, "Cloth", "Flag");
    desk.type_value("Density", "0.7");
    assert_eq!((desk.get::<Fabric>(curtain).density, desk.get::<Fabric>(flag).density), (0.5, 0.7));
    assert_eq!(desk.resource::<ClothPanel>().choice, ClothChoice::One(flag));
}

#[test]
fn a_game_can_choose() {
    let mut app = app();
    spawn_cloth(&mut app, "Curtain", ());
    let flag = spawn_cloth(&mut app, "Flag", ());
    let mut desk = Desk::new(app);
    desk.app().world_mut().resource_mut::<ClothPanel>().choice = ClothChoice::One(flag);
    desk.frame();
    desk.type_value("Density", "0.7");
    assert_eq!(desk.get::<Fabric>(flag).density, 0.7);
}

#[test]
fn an_edit_of_all_writes_one_value_to_each() {
    let mut app = app();
    let silk = spawn_cloth(&mut app, "Silk", Fabric::SILK);
    let denim = spawn_cloth(&mut app, "Denim", (Fabric::DENIM, Cloth { substeps: Some(20), ..default() }));
    let mut desk = Desk::new(app);
    desk.choose(Role::ComboBox, "Cloth", "All 2 cloths");
    desk.type_value("Lift", "0.9");
    desk.type_value("Gravity scale", "2");
    assert_eq!(desk.get::<Fabric>(silk), &Fabric { lift: 0.9, ..Fabric::SILK });
    assert_eq!(desk.get::<Fabric>(denim), &Fabric { lift: 0.9, ..Fabric::DENIM });
    assert_eq!(desk.get::<Cloth>(silk), &Cloth { gravity_scale: 2.0, ..default() });
    assert_eq!(desk.get::<Cloth>(denim), &Cloth { gravity_scale: 2.0, substeps: Some(20), ..default() });
    desk.choose(Role::ComboBox, "Preset", "rubber");
    assert_eq!((desk.get::<Fabric>(silk), desk.get::<Fabric>(denim)), (&Fabric::RUBBER, &Fabric::RUBBER));
}

#[test]
fn an_edit_of_all_leaves_a_cloth_alone_that_it_doesnt_fit() {
    let mut app = app();
    let cotton = spawn_cloth(&mut app, "Cotton", ());
    let denim = spawn_cloth(&mut app, "Denim", Fabric::DENIM);
    let mut desk = Desk::new(app);
    desk.choose(Role::ComboBox, "Cloth", "All 2 cloths");
    desk.type_value("Shear stiffness", "2000");
    assert_eq!(desk.get::<Fabric>(cotton), &Fabric { shear_stiffness: 2000.0, ..default() });
    assert_eq!(desk.get::<Fabric>(denim), &Fabric::DENIM, "its warp and weft differ too much");
}

#[test]
fn numbers_of_all_are_sums() {
    let mut app = app();
    let cloths = ["A", "B", "C"].map(|name| spawn_cloth(&mut app, name, ()));
    let mut desk = Desk::new(app);
    let springs = desk.get::<ClothState>(cloths[0]).topology().springs.len();
    assert!(desk.harness.query_by_label(&springs.to_string()).is_some());
    desk.choose(Role::ComboBox, "Cloth", "All 3 cloths");
    desk.frame();
    assert!(desk.harness.query_by_label("192").is_some(), "3 cloths of 64 particles");
    assert!(desk.harness.query_by_label(&(3 * springs).to_string()).is_some());
}

#[test]
fn names_that_are_there_twice_are_told_apart() {
    let mut app = app();
    let one = spawn_cloth(&mut app, "Flag", ());
    let two = spawn_cloth(&mut app, "Flag", ());
    let mut desk = Desk::new(app);
    desk.choose(Role::ComboBox, "Cloth", &format!("Flag ({two})"));
    desk.type_value("Density", "0.7");
    assert_eq!((desk.get::<Fabric>(one).density, desk.get::<Fabric>(two).density), (Fabric::default().density, 0.7));
}

#[test]
fn a_chosen_cloth_may_go_while_it_is_shown() {
    let mut app = app();
    let curtain = spawn_cloth(&mut app, "Curtain", ());
    let flag = spawn_cloth(&mut app, "Flag", ());
    let mut desk = Desk::new(app);
    desk.choose(Role::ComboBox, "Cloth", "Flag");
    desk.app().world_mut().despawn(flag);
    desk.frames(3);
    assert_eq!(desk.resource::<ClothPanel>().choice, ClothChoice::First);
    desk.type_value("Density", "0.7");
    assert_eq!(desk.get::<Fabric>(curtain).density, 0.7);
    desk.app().world_mut().entity_mut(curtain).remove::<Cloth>();
    desk.frames(3);
    assert!(desk.harness.query_by_label_contains("There is no cloth").is_some());
}

#[test]
fn without_any_cloth_the_panel_says_so() {
    let mut desk = Desk::new(app());
    assert!(desk.harness.query_by_label_contains("There is no cloth").is_some());
    desk.type_nth_value("Gravity, m/s²", 1, "-5");
    assert_eq!(desk.resource::<ClothGravity>().0, Vec3::Y * -5.0, "what is no cloth's can still be edited");
}

#[test]
fn a_cloth_that_doesnt_run_says_why() {
    let mut app = app();
    let cloth = app.world_mut().spawn((Cloth::default(), Mesh3d(Handle::default()))).id();
    let mut desk = Desk::new(app);
    assert!(desk.harness.query_by_label_contains("Waits for its mesh").is_some());
    let line = Mesh::from(Segment3d::new(Vec3::ZERO, Vec3::X));
    let mesh = desk.app().world_mut().resource_mut::<Assets<Mesh>>().add(line);
    desk.app().world_mut().entity_mut(cloth).insert(Mesh3d(mesh));
    desk.frames(3);
    assert!(desk.harness.query_by_label_contains("Can't be built").is_some());
}
