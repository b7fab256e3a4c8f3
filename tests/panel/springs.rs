//! A cloth with plain springs of its own is tuned by those.

use bevy::prelude::*;
use bevy_drape::{
    panel::{ClothChoice, ClothPanel},
    prelude::*,
};
use bevy_egui::egui::accesskit::Role;
use egui_kittest::kittest::Queryable;

use crate::common::*;

const ELASTIC: [&str; 7] = [
    "Warp stiffness",
    "Weft stiffness",
    "Warp stiffening",
    "Weft stiffening",
    "Compression",
    "Shear stiffness",
    "Bending rigidity",
];
const SPRINGS: [&str; 4] = ["Stretch", "Shear", "Bend", "Shear damping"];

/// The knobs of `names` that are shown.
fn shown<'a>(desk: &Desk, names: &[&'a str]) -> Vec<&'a str> {
    names.iter().copied().filter(|name| desk.controls(Role::Slider, name).next().is_some()).collect()
}

#[test]
fn what_is_in_force_is_shown_and_nothing_else() {
    let mut app = app();
    let cloth = spawn_cloth(&mut app, "Curtain", ());
    let mut desk = Desk::new(app);
    let nothing: [&str; 0] = [];
    let says_why = |desk: &Desk| desk.harness.query_by_label_contains("springs (below) are in force").is_some();
    assert_eq!((shown(&desk, &ELASTIC), shown(&desk, &SPRINGS)), (ELASTIC.to_vec(), nothing.to_vec()));
    assert!(!says_why(&desk));
    desk.app().world_mut().entity_mut(cloth).insert(ClothSprings::default());
    desk.frames(2);
    assert_eq!((shown(&desk, &ELASTIC), shown(&desk, &SPRINGS)), (nothing.to_vec(), SPRINGS.to_vec()));
    assert!(says_why(&desk));
    assert_eq!(shown(&desk, &["Density", "Thickness", "Friction"]).len(), 3, "the fabric has these all the same");
    desk.app().world_mut().entity_mut(cloth).remove::<ClothSprings>();
    desk.frames(2);
    assert_eq!((shown(&desk, &ELASTIC), shown(&desk, &SPRINGS)), (ELASTIC.to_vec(), nothing.to_vec()));
}

#[test]
fn every_value_of_springs_can_be_typed() {
    let mut app = app();
    let cloth = spawn_cloth(&mut app, "Curtain", ClothSprings::default());
    let other = spawn_cloth(&mut app, "Flag", ());
    let mut desk = Desk::new(app);
    for (name, text) in [
        ("Stretch", "1200 N/m"),
        ("Shear", "120"),
        ("Bend", "6"),
        ("Stretch damping", "0.01"),
        ("Shear damping", "0.02"),
        ("Bend damping", "0.03"),
    ] {
        desk.type_value(name, text);
    }
    let springs = ClothSprings {
        structural_stiffness: 1200.0,
        shear_stiffness: 120.0,
        bend_stiffness: 6.0,
        structural_damping: 0.01,
        shear_damping: 0.02,
        bend_damping: 0.03,
    };
    assert_eq!(desk.get::<ClothSprings>(cloth), &springs);
    assert_eq!(desk.get::<Fabric>(cloth), &Fabric::default());
    assert_eq!(desk.heard().changed, ["ClothSprings"; 6]);
    desk.app().world_mut().resource_mut::<ClothPanel>().choice = ClothChoice::All;
    desk.frame();
    desk.type_value("Bend", "9");
    assert_eq!(desk.get::<ClothSprings>(cloth), &ClothSprings { bend_stiffness: 9.0, ..springs });
    assert!(!desk.app().world().entity(other).contains::<ClothSprings>(), "no cloth is given any");
}

#[test]
fn no_text_makes_a_bad_value_of_springs() {
    let mut app = app();
    let cloth = spawn_cloth(&mut app, "Curtain", ClothSprings::default());
    let mut desk = Desk::new(app);
    for name in ["Stretch", "Shear", "Bend", "Stretch damping", "Shear damping", "Bend damping"] {
        for text in ["-5", "NaN", "inf", "1e30", "-1e30", "1e-30", "", "abc"] {
            desk.type_value(name, text);
            assert!(desk.get::<ClothSprings>(cloth).constants().is_ok(), "{name}: {text:?}");
        }
    }
}

#[test]
fn springs_go_back_to_what_they_were() {
    let mut app = app();
    let with = spawn_cloth(&mut app, "With", ClothSprings { bend_stiffness: 3.0, ..default() });
    let without = spawn_cloth(&mut app, "Without", ());
    let mut desk = Desk::new(app);
    let revert = |desk: &mut Desk, name: &str| {
        desk.choose(Role::ComboBox, "Cloth", name);
        desk.choose(Role::Button, "Revert ⏷", "This cloth");
    };
    desk.type_value("Bend", "50");
    revert(&mut desk, "With");
    let loaded = ClothSprings { bend_stiffness: 3.0, ..default() };
    assert_eq!(desk.get::<ClothSprings>(with), &loaded);
    desk.app().world_mut().entity_mut(with).remove::<ClothSprings>();
    revert(&mut desk, "With");
    assert_eq!(desk.get::<ClothSprings>(with), &loaded, "also what is gone");
    desk.app().world_mut().entity_mut(without).insert(ClothSprings::default());
    revert(&mut desk, "Without");
    assert!(!desk.app().world().entity(without).contains::<ClothSprings>(), "what has come goes");
    desk.heard();
    revert(&mut desk, "With");
    assert_eq!(desk.heard(), Heard::default(), "there is nothing left to revert");
}
