//! What the panel measures stands at its top.

use bevy::prelude::*;
use bevy_drape::prelude::*;
use bevy_egui::egui::{PointerButton, accesskit::Role};
use egui_kittest::kittest::Queryable;

use crate::common::*;

/// The number before its caption.
fn figure(desk: &Desk, caption: &str) -> f32 {
    let texts = desk.texts();
    let place = texts.iter().position(|text| text == caption).expect("the caption");
    texts[place - 1].parse().expect("a number")
}

fn top(desk: &Desk, label: &str) -> f32 {
    desk.harness.get_by_label(label).rect().top()
}

#[test]
fn readings_come_first_and_then_advice_and_settings() {
    let mut app = app();
    spawn_cloth(&mut app, "Curtain", Cloth { solver: ClothSolver::Explicit, max_substeps: 1, ..default() });
    let mut desk = Desk::new(app);
    desk.frames(3);
    let advice = desk.harness.get_by_label_contains("substeps carry only").rect();
    let readings = ["Step time, ms", "Substeps taken", "Stretch, %", "Energy, J", "Contacts"];
    for label in readings {
        assert!(top(&desk, label) < advice.top(), "{label}");
    }
    let fabric = desk.control(Role::Button, "Fabric").rect();
    assert!(advice.bottom() < fabric.top());
    for section in ["Solver", "Collision", "Wind", "Budget", "Mesh"] {
        assert!(desk.control(Role::Button, section).rect().top() > fabric.top(), "{section}");
    }
}

#[test]
fn time_stretch_and_energy_are_those_of_the_cloth() {
    let mut app = app();
    // It swings down from where it lies.
    let lying = Transform::from_rotation(Quat::from_rotation_x(1.3));
    let cloth = spawn_cloth(&mut app, "Curtain", (Pins::edge_corners(ClothEdge::Top), lying));
    let mut desk = Desk::new(app);
    desk.frames(20);
    let near = |caption: &str, expected: f32, digits: f32| {
        let shown = figure(&desk, caption);
        assert!((shown - expected).abs() <= digits, "{caption}: {shown}, {expected}");
    };
    let (state, report) = (desk.get::<ClothState>(cloth), desk.get::<ClothReport>(cloth));
    let (strain, energy) = (state.strain(), state.energy(desk.resource::<ClothGravity>().0));
    assert!(strain.largest > 1e-4 && energy.kinetic > 1e-3, "it swings: {strain:?} {energy:?}");
    near("largest", strain.largest * 100.0, 0.006);
    near("kinetic", energy.kinetic, 0.01 * energy.kinetic);
    near("elastic", energy.elastic, 0.01 * energy.elastic);
    near("total", energy.total(), 0.01 * energy.total().abs());
    near("latest", report.step_time().as_secs_f32() * 1e3, 0.006);
    let (mean, worst) = (figure(&desk, "mean"), figure(&desk, "worst"));
    assert!(worst >= mean && worst >= figure(&desk, "latest"), "{mean} {worst}");
}

#[test]
fn why_so_many_substeps_are_taken_is_told() {
    let mut app = app();
    let cloth = spawn_cloth(&mut app, "Curtain", Cloth { substeps: Some(12), ..default() });
    let mut desk = Desk::new(app);
    let tells = |desk: &Desk, text: &str| desk.texts().iter().any(|shown| shown == text);
    desk.frame();
    assert!(tells(&desk, "12, a fixed number"));
    desk.get_mut::<Cloth>(cloth).max_work = Some(64 * 4);
    desk.frames(2);
    assert!(tells(&desk, "4 of 12, cut by a budget"), "{:?}", desk.texts());
}

#[test]
fn a_longer_reason_pushes_nothing_about() {
    let mut app = app();
    spawn_cloth(&mut app, "Curtain", ());
    let mut desk = Desk::new(app);
    // Columns find their widths in the first frames.
    desk.frames(4);
    let before = desk.control(Role::Slider, "Density").rect();
    let cone = ClothCollider::from(Cone::new(0.2, 0.4));
    desk.app().world_mut().spawn((cone, Transform::from_xyz(0.0, 0.0, 0.21)));
    desk.frames(3);
    let texts = desk.texts();
    assert!(texts.iter().any(|text| text.contains(", something with")), "{texts:?}");
    let after = desk.control(Role::Slider, "Density").rect();
    // But for rounding: the window grows by fractions of a point.
    let moved = (after.min - before.min).length().max((after.max - before.max).length());
    assert!(moved < 0.5, "from {before:?} to {after:?}");
}

#[test]
fn readings_can_be_folded() {
    let mut app = app();
    spawn_cloth(&mut app, "Curtain", ());
    let mut desk = Desk::new(app);
    desk.click(Role::Button, "Readings");
    assert!(desk.harness.query_by_label("Energy, J").is_none());
    assert!(desk.controls(Role::ComboBox, "Cloth").next().is_some());
}

#[test]
fn advice_neither_comes_nor_goes_while_a_control_is_held() {
    let mut app = app();
    let cloth = spawn_cloth(&mut app, "Curtain", Cloth { solver: ClothSolver::Explicit, ..default() });
    let mut desk = Desk::new(app);
    let is_advised = |desk: &Desk| desk.harness.query_by_label_contains("substeps carry only").is_some();
    desk.frames(2);
    assert!(!is_advised(&desk));
    let slider = desk.control(Role::Slider, "Density").rect();
    desk.harness.hover_at(slider.center());
    desk.harness.drag_at(slider.center());
    desk.harness.run();
    desk.harness.hover_at(slider.left_center());
    desk.harness.run();
    desk.get_mut::<Cloth>(cloth).max_substeps = 1;
    desk.frames(3);
    assert!(!is_advised(&desk));
    let moved = desk.control(Role::Slider, "Density").rect().top() - slider.top();
    assert!(moved.abs() < 1.0, "more than rounding: {moved}");
    assert!(desk.harness.query_by_label_contains("Softer than it should be").is_some(), "the status tells at once");
    let button = PointerButton::Primary;
    let (pos, modifiers) = (slider.left_center(), default());
    desk.harness.event(bevy_egui::egui::Event::PointerButton { pos, button, pressed: false, modifiers });
    desk.frames(3);
    assert!(is_advised(&desk));
}
