//! The way back.

use bevy::prelude::*;
use bevy_drape::prelude::*;
use bevy_egui::egui::accesskit::Role;

use crate::common::*;

const REVERT: &str = "Revert ⏷";

#[test]
fn a_cloth_goes_back_to_what_it_was_once_it_was_ready() {
    let mut app = app();
    let loaded = (Cloth { substeps: Some(11), ..default() }, Fabric::WOOL_FLANNEL, Pins::corners());
    let cloth = spawn_cloth(&mut app, "Curtain", loaded.clone());
    let other = spawn_cloth(&mut app, "Flag", ());
    let mut desk = Desk::new(app);
    desk.type_value("Substeps", "3");
    desk.type_value("Density", "1");
    desk.click(Role::Button, "Unpin all");
    desk.get_mut::<Fabric>(other).density = 0.7;
    desk.choose(Role::Button, REVERT, "This cloth");
    let now = (desk.get::<Cloth>(cloth).clone(), desk.get::<Fabric>(cloth).clone(), desk.get::<Pins>(cloth).clone());
    assert_eq!(now, loaded);
    assert_eq!(desk.get::<Fabric>(other).density, 0.7);
    desk.heard();
    desk.choose(Role::Button, REVERT, "This cloth");
    assert_eq!(desk.heard(), Heard::default(), "there is nothing left to revert");
}

#[test]
fn a_cloth_follows_its_fabrics_asset_again() {
    let mut app = app();
    let handle = app.world_mut().resource_mut::<Assets<Fabric>>().add(Fabric::SILK);
    let cloth = spawn_cloth(&mut app, "Curtain", FabricHandle::new(handle.clone()));
    let mut desk = Desk::new(app);
    desk.type_value("Friction", "0.9");
    let mut fabrics = desk.app().world_mut().resource_mut::<Assets<Fabric>>();
    *fabrics.get_mut(&handle).expect("the asset") = Fabric::DENIM;
    desk.frames(2);
    assert_eq!(desk.get::<Fabric>(cloth).friction, 0.9);
    desk.choose(Role::Button, REVERT, "This cloth");
    assert!(!desk.get::<FabricHandle>(cloth).detached);
    desk.frame();
    assert_eq!(desk.get::<Fabric>(cloth), &Fabric::DENIM, "as it is by now");
}

#[test]
fn an_asset_that_came_late_isnt_lost() {
    let mut app = app();
    let handle = app.world().resource::<Assets<Fabric>>().reserve_handle();
    let cloth = spawn_cloth(&mut app, "Curtain", FabricHandle::new(handle.clone()));
    let mut desk = Desk::new(app);
    let mut fabrics = desk.app().world_mut().resource_mut::<Assets<Fabric>>();
    fabrics.insert(handle.id(), Fabric::SILK).expect("the asset");
    desk.frames(3);
    assert_eq!(desk.get::<Fabric>(cloth), &Fabric::SILK);
    desk.choose(Role::Button, REVERT, "This cloth");
    desk.frame();
    assert_eq!(desk.get::<Fabric>(cloth), &Fabric::SILK);
}

#[test]
fn wind_and_gravity_go_back_and_added_winds_go() {
    let mut app = app();
    let cloth = spawn_cloth(&mut app, "Curtain", ());
    let mut desk = Desk::new(app);
    desk.click(Role::Button, "Add wind");
    desk.type_nth_value("Gravity, m/s²", 1, "3");
    desk.type_value("Gravity scale", "2");
    desk.choose(Role::Button, REVERT, "Wind, gravity, budget");
    let world = desk.app().world_mut();
    assert_eq!(world.query::<&Wind>().iter(world).count(), 0);
    assert_eq!(desk.resource::<ClothGravity>(), &ClothGravity::default());
    assert_eq!(desk.get::<Cloth>(cloth).gravity_scale, 2.0, "that is the cloth's own");

    let wind = Wind { velocity: Vec3::X, ..default() };
    let entity = desk.app().world_mut().spawn(wind.clone()).id();
    desk.frames(2);
    desk.type_value("Heading", "10");
    desk.type_value("Gusts", "1");
    desk.choose(Role::Button, REVERT, "Everything");
    assert_eq!(desk.get::<Wind>(entity), &wind);
    assert_eq!(desk.get::<Cloth>(cloth), &Cloth::default());
}
