//! Winds in the panel.

use bevy::prelude::*;
use bevy_drape::prelude::*;
use bevy_egui::egui::accesskit::Role;

use crate::common::*;

#[test]
fn a_wind_is_turned_and_quickened() {
    let mut app = app();
    let wind = app.world_mut().spawn(Wind { velocity: Vec3::Z * 3.0, seed: 5, ..default() }).id();
    let mut desk = Desk::new(app);
    desk.type_value("Heading", "90");
    assert_eq!(desk.get::<Wind>(wind), &Wind { velocity: Vec3::X * 3.0, seed: 5, ..default() });
    desk.type_value("Wind speed", "8");
    assert_eq!(desk.get::<Wind>(wind).velocity, Vec3::X * 8.0);
    desk.type_value("Elevation", "90°");
    assert_eq!(desk.get::<Wind>(wind).velocity, Vec3::Y * 8.0);
    assert_eq!(desk.heard().changed, ["Wind", "Wind", "Wind"]);
}

#[test]
fn a_calm_keeps_its_direction() {
    let mut app = app();
    let wind = app.world_mut().spawn(Wind { velocity: Vec3::X * 3.0, ..default() }).id();
    let mut desk = Desk::new(app);
    desk.type_value("Wind speed", "0");
    assert_eq!(desk.get::<Wind>(wind).velocity, Vec3::ZERO);
    desk.frames(3);
    desk.type_value("Wind speed", "2");
    assert_eq!(desk.get::<Wind>(wind).velocity, Vec3::X * 2.0);
}

#[test]
fn other_values_leave_the_velocity_to_the_last_bit() {
    let mut app = app();
    let velocity = Vec3::new(0.123_456_7, -0.765_432_1, 3.333_333_3);
    let wind = app.world_mut().spawn(Wind { velocity, ..default() }).id();
    let mut desk = Desk::new(app);
    desk.type_value("Gusts", "0.7");
    desk.type_value("Gust period", "6");
    desk.type_value("Turbulence", "0.3");
    desk.type_value("Eddy size", "0.5");
    let expected = Wind { velocity, gusts: 0.7, gust_period: 6.0, turbulence: 0.3, eddy_size: 0.5, ..default() };
    assert_eq!(desk.get::<Wind>(wind), &expected);
}

#[test]
fn one_of_several_is_chosen_and_may_go() {
    let mut app = app();
    let [breeze, gale] = ["Breeze", "Gale"].map(|name| app.world_mut().spawn((Wind::default(), Name::new(name))).id());
    let mut desk = Desk::new(app);
    desk.choose(Role::ComboBox, "Which wind", "Gale");
    desk.type_value("Gusts", "1");
    assert_eq!((desk.get::<Wind>(breeze).gusts, desk.get::<Wind>(gale).gusts), (0.4, 1.0));
    desk.app().world_mut().despawn(gale);
    desk.frames(2);
    desk.type_value("Gusts", "0.1");
    assert_eq!(desk.get::<Wind>(breeze).gusts, 0.1);
}

#[test]
fn without_a_wind_one_can_be_added() {
    let mut app = app();
    spawn_cloth(&mut app, "Curtain", ());
    let mut desk = Desk::new(app);
    assert!(desk.controls(Role::Slider, "Gusts").next().is_none());
    desk.click(Role::Button, "Add wind");
    desk.frames(2);
    desk.type_value("Wind speed", "5");
    let world = desk.app().world_mut();
    assert_eq!(world.query::<&Wind>().iter(world).map(|wind| wind.velocity).collect::<Vec<_>>(), [Vec3::Z * 5.0]);
}
