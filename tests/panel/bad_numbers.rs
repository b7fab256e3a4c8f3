//! Whatever is entered, the solver accepts what comes of it.

use bevy::prelude::*;
use bevy_drape::prelude::*;
use bevy_egui::egui::accesskit::Role;
use proptest::{
    prelude::*,
    test_runner::{Config, TestRunner},
};

use crate::common::*;

/// The values that can be typed, with how many fields there are of each.
const FIELDS: [(&str, usize); 31] = [
    ("Warp stiffness", 1),
    ("Weft stiffness", 1),
    ("Warp stiffening", 1),
    ("Weft stiffening", 1),
    ("Compression", 1),
    ("Shear stiffness", 1),
    ("Bending rigidity", 1),
    ("Stretch damping", 1),
    ("Bend damping", 1),
    ("Density", 1),
    ("Thickness", 1),
    ("Friction", 1),
    ("Drag", 1),
    ("Lift", 1),
    ("Damping", 1),
    ("Max strain", 1),
    ("Substeps", 1),
    ("Tether slack", 1),
    ("Max velocity", 1),
    ("Collision margin", 1),
    ("Gravity, m/s²", 3),
    ("Gravity scale", 1),
    ("Fluid density", 1),
    ("Heading", 1),
    ("Elevation", 1),
    ("Wind speed", 1),
    ("Gusts", 1),
    ("Gust period", 1),
    ("Turbulence", 1),
    ("Eddy size", 1),
    ("Game speed", 1),
];

fn desk() -> (Desk, Entity, Entity) {
    let mut app = app();
    let cloth = spawn_cloth(&mut app, "Curtain", ());
    let wind = app.world_mut().spawn(Wind { velocity: Vec3::X, ..default() }).id();
    let mut desk = Desk::new(app);
    desk.click(Role::CheckBox, "Substeps by hand");
    desk.heard();
    (desk, cloth, wind)
}

#[track_caller]
fn assert_valid(desk: &Desk, cloth: Entity, wind: Entity, what: &str) {
    assert_eq!(desk.get::<Cloth>(cloth).validate(), Ok(()), "{what}");
    assert!(desk.get::<Fabric>(cloth).material().is_ok(), "{what}");
    assert!(desk.resource::<ClothGravity>().0.is_finite(), "{what}");
    let Wind { velocity, gusts, gust_period, turbulence, eddy_size, .. } = *desk.get::<Wind>(wind);
    assert!(velocity.is_finite(), "{what}");
    for value in [gusts, gust_period, turbulence, eddy_size] {
        assert!(value.is_finite() && value >= 0.0, "{what}");
    }
    let speed = desk.resource::<Time<Virtual>>().relative_speed();
    assert!(speed.is_finite() && speed > 0.0, "{what}");
    let state = desk.get::<ClothState>(cloth);
    assert!(state.positions().all(Vec3::is_finite), "{what}");
}

#[test]
fn no_text_makes_a_bad_value_of_any_field() {
    let (mut desk, cloth, wind) = desk();
    for (name, count) in FIELDS {
        for nth in 0..count {
            for text in ["-5", "NaN", "-nan", "inf", "1e30", "-1e30", "1e-30", "", "abc", "1e999"] {
                desk.type_nth_value(name, nth, text);
                assert_valid(&desk, cloth, wind, &format!("{name}: {text:?}"));
            }
            desk.type_nth_value(name, nth, "1");
        }
    }
    assert!(desk.get::<Pins>(cloth) == &Pins::edge(ClothEdge::Top) && desk.heard().resets == 0);
}

#[test]
fn what_is_no_number_changes_nothing() {
    let (mut desk, _, _) = desk();
    for text in ["NaN", "-inf", "", "abc", "1-2"] {
        desk.type_value("Density", text);
        desk.type_value("Substeps", text);
        desk.type_value("Wind speed", text);
    }
    assert_eq!(desk.heard(), Heard::default());
}

#[test]
fn what_is_out_of_range_becomes_the_nearest_within() {
    let (mut desk, cloth, wind) = desk();
    desk.type_value("Density", "-5");
    assert_eq!(desk.get::<Fabric>(cloth).density, 0.001);
    desk.type_value("Thickness", "0");
    assert_eq!(desk.get::<Fabric>(cloth).thickness, 1e-6);
    desk.type_value("Compression", "3");
    assert_eq!(desk.get::<Fabric>(cloth).compression, 1.0);
    desk.type_value("Weft stiffness", "2000");
    desk.type_value("Shear stiffness", "1e6");
    assert_eq!(desk.get::<Fabric>(cloth).shear_stiffness, 4000.0, "4000 · 2000 / (4000 - 2000)");
    desk.type_value("Substeps", "0");
    assert_eq!(desk.get::<Cloth>(cloth).substeps, Some(1));
    desk.type_value("Substeps", "2.6");
    assert_eq!(desk.get::<Cloth>(cloth).substeps, Some(3));
    desk.type_value("Wind speed", "1e30");
    assert_eq!(desk.get::<Wind>(wind).velocity, Vec3::X * 200.0);
    desk.choose(Role::ComboBox, "Solver", "Explicit");
    desk.type_value("Max substeps", "1e9");
    assert_eq!(desk.get::<Cloth>(cloth).max_substeps, 10_000);
}

#[test]
fn random_texts_and_pulls_make_no_bad_value() {
    let (desk, cloth, wind) = desk();
    let desk = std::cell::RefCell::new(desk);
    let number = prop_oneof![
        any::<f64>().prop_map(|value| value.to_string()),
        any::<f32>().prop_map(|value| format!("{value:e}")),
        (-1e6..1e6).prop_map(|value: f64| value.to_string()),
        "[-+0-9.eE a-zµ²/]{0,12}",
    ];
    let mut runner = TestRunner::new(Config { cases: 150, failure_persistence: None, ..Config::default() });
    let edits = (0..FIELDS.len(), 0.0_f32..1.0, number);
    let result = runner.run(&edits, |(field, share, text)| {
        let mut desk = desk.borrow_mut();
        let name = FIELDS[field].0;
        if name != "Gravity, m/s²" {
            desk.slide(name, share);
            assert_valid(&desk, cloth, wind, &format!("{name} at {share}"));
        }
        desk.type_value(name, &text);
        assert_valid(&desk, cloth, wind, &format!("{name}: {text:?}"));
        Ok(())
    });
    assert_eq!(result, Ok(()));
}
