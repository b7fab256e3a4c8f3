//! A fabric's values stand in groups, and its preset says where they come from.

use bevy::prelude::*;
use bevy_drape::prelude::*;
use bevy_egui::egui::accesskit::Role;
use egui_kittest::kittest::{NodeT, Queryable};

use crate::common::*;

/// The groups, and the fields of each.
const GROUPS: [(&str, &[&str]); 4] = [
    (
        "Stretch",
        &[
            "Warp stiffness",
            "Weft stiffness",
            "Warp stiffening",
            "Weft stiffening",
            "Compression",
            "Shear stiffness",
            "Stretch damping",
        ],
    ),
    ("Bending", &["Bending rigidity", "Bend damping"]),
    ("Air", &["Drag", "Lift", "Damping"]),
    ("Contact", &["Friction", "Thickness"]),
];

fn top(desk: &Desk, role: Role, name: &str) -> f32 {
    desk.control(role, name).rect().top()
}

/// What is written beneath the presets.
fn source(desk: &Desk) -> String {
    let preset = desk.control(Role::ComboBox, "Preset").rect().center().y;
    let below = |node: &egui_kittest::Node| {
        let is_drawn = node.accesskit_node().bounding_box().is_some();
        is_drawn && node.accesskit_node().role() == Role::Label && node.rect().top() > preset
    };
    let labels = desk.harness.root().children_recursive().filter(below);
    let first = labels.min_by(|a, b| a.rect().top().total_cmp(&b.rect().top())).expect("a label");
    first.accesskit_node().value().unwrap_or_default()
}

#[test]
fn each_value_stands_in_its_group() {
    let mut app = app();
    spawn_cloth(&mut app, "Curtain", ());
    let desk = Desk::new(app);
    let mut latest = top(&desk, Role::Slider, "Density");
    for (group, fields) in GROUPS {
        let header = top(&desk, Role::Button, group);
        assert!(header > latest, "{group}");
        latest = header;
        for field in fields {
            let slider = top(&desk, Role::Slider, field);
            assert!(slider > latest, "{field}");
            latest = slider;
        }
    }
    assert!(top(&desk, Role::Button, "Solver") > latest);
}

#[test]
fn a_group_can_be_folded() {
    let mut app = app();
    spawn_cloth(&mut app, "Curtain", ());
    let mut desk = Desk::new(app);
    for (group, fields) in GROUPS {
        desk.click(Role::Button, group);
        for field in fields {
            assert!(desk.controls(Role::Slider, field).next().is_none(), "{field}");
        }
    }
    assert!(desk.controls(Role::Slider, "Density").next().is_some());
    desk.click(Role::Button, "Bending");
    assert!(desk.controls(Role::Slider, "Bending rigidity").next().is_some());
}

#[test]
fn a_cloth_with_springs_has_no_group_without_values() {
    let mut app = app();
    spawn_cloth(&mut app, "Curtain", ClothSprings::default());
    let desk = Desk::new(app);
    let shown = GROUPS.map(|(group, _)| desk.controls(Role::Button, group).next().is_some());
    assert_eq!(shown, [false, false, true, true]);
}

#[test]
fn the_source_stands_beneath_the_preset() {
    let mut app = app();
    spawn_cloth(&mut app, "Curtain", Fabric::WOOL_FLANNEL);
    let mut desk = Desk::new(app);
    for preset in Fabric::PRESETS {
        desk.choose(Role::ComboBox, "Preset", &preset.name.replace('_', " "));
        let text = source(&desk);
        assert!(text.contains(preset.source), "{text:?} for {}", preset.name);
        assert_eq!(text.contains("Nothing is measured"), preset.measured.is_empty(), "{text:?}");
        let marks = desk.texts().into_iter().filter(|text| text == "•").count();
        assert_eq!(marks, preset.measured.len(), "{}", preset.name);
    }
}

#[test]
fn an_edited_preset_is_told_until_much_of_it_is_edited() {
    let mut app = app();
    let cloth = spawn_cloth(&mut app, "Curtain", Fabric::DENIM);
    let mut desk = Desk::new(app);
    let marks = |desk: &Desk| desk.texts().into_iter().filter(|text| text == "•").count();
    let before = marks(&desk);
    let slider = desk.control(Role::Slider, "Density").rect();
    desk.type_value("Density", "0.5");
    assert!(source(&desk).contains("denim of 11 oz"));
    assert_eq!(marks(&desk), before - 1, "the new density wasn't measured");
    assert!(desk.harness.query_by_value("denim, edited").is_some());
    assert_eq!(desk.control(Role::Slider, "Density").rect(), slider, "nothing is pushed about");
    *desk.get_mut::<Fabric>(cloth) = Fabric { density: 0.7, thickness: 0.01, drag: 0.2, lift: 0.1, ..Fabric::DENIM };
    desk.frame();
    assert!(source(&desk).contains("Own values"));
    assert_eq!(marks(&desk), 0);
}
