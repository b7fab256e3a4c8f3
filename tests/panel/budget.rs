//! The time that all cloth may take.

use bevy::prelude::App;
use bevy_drape::prelude::*;
use bevy_egui::egui::accesskit::Role;

use crate::common::*;

#[test]
fn the_budget_is_limited_typed_and_lifted() {
    let mut app = app();
    spawn_cloth(&mut app, "Curtain", ());
    let mut desk = Desk::new(app);
    assert!(desk.controls(Role::Slider, "Time for a step").next().is_none(), "nothing is cut");
    desk.click(Role::CheckBox, "Limited time");
    let begun = desk.resource::<ClothBudget>().milliseconds;
    assert!(begun > 0.0 && begun.is_finite(), "{begun}");
    desk.type_value("Time for a step", "2.5 ms");
    assert_eq!(desk.resource::<ClothBudget>(), &ClothBudget { milliseconds: 2.5 });
    assert_eq!(desk.heard().changed, ["ClothBudget"; 2]);
    desk.click(Role::CheckBox, "Limited time");
    assert_eq!(desk.resource::<ClothBudget>(), &ClothBudget::default());
}

#[test]
fn no_text_makes_a_budget_that_cuts_nothing() {
    let mut app = app();
    app.insert_resource(ClothBudget { milliseconds: 2.0 });
    let mut desk = Desk::new(app);
    for text in ["-5", "0", "NaN", "inf", "1e30", "1e-30", "", "abc"] {
        desk.type_value("Time for a step", text);
        let ClothBudget { milliseconds } = *desk.resource();
        assert!(milliseconds > 0.0 && milliseconds.is_finite(), "{text:?}: {milliseconds}");
    }
}

#[test]
fn nothing_is_written_while_nothing_is_edited() {
    let mut app = app();
    app.insert_resource(ClothBudget { milliseconds: f32::NAN });
    let mut desk = Desk::new(app);
    desk.frames(5);
    assert_eq!(desk.heard(), Heard::default());
}

#[test]
fn the_budget_goes_back_with_what_is_around() {
    // Before the panel looks for the first time.
    let mut app = app_with(|app: &mut App| {
        app.insert_resource(ClothBudget { milliseconds: 4.0 });
    });
    spawn_cloth(&mut app, "Curtain", ());
    let mut desk = Desk::new(app);
    for entry in ["Wind, gravity, budget", "Everything"] {
        desk.type_value("Time for a step", "0.5");
        desk.choose(Role::Button, "Revert ⏷", entry);
        assert_eq!(desk.resource::<ClothBudget>(), &ClothBudget { milliseconds: 4.0 }, "{entry}");
    }
    desk.type_value("Time for a step", "0.5");
    desk.choose(Role::Button, "Revert ⏷", "This cloth");
    assert_eq!(desk.resource::<ClothBudget>(), &ClothBudget { milliseconds: 0.5 }, "it is no cloth's");
}

#[test]
fn the_budget_is_copied_as_rust() {
    let mut app = app();
    app.insert_resource(ClothBudget { milliseconds: 2.5 });
    let mut desk = Desk::new(app);
    let at = desk.control(Role::Button, "Copy budget as Rust").rect().center();
    assert_eq!(desk.copy_at(at).as_deref(), Some("ClothBudget { milliseconds: 2.5 },\n"));
    // What was copied, as code.
    let _ = ClothBudget { milliseconds: 2.5 };
}
