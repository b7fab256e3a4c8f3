//! Edits change what was edited, in the next step, and nothing else.

use bevy::prelude::*;
use bevy_drape::{prelude::*, solver::LevelPass};
use bevy_egui::egui::accesskit::Role;

use crate::common::*;

#[test]
fn a_slider_changes_its_own_field_and_no_other() {
    let mut app = app();
    let cloth = spawn_cloth(&mut app, "Curtain", ());
    let mut desk = Desk::new(app);
    desk.slide("Bending rigidity", 0.9);
    let fabric = desk.get::<Fabric>(cloth).clone();
    assert!(fabric.bending_rigidity > 1e-3, "{fabric:?}");
    assert_eq!(fabric, Fabric { bending_rigidity: fabric.bending_rigidity, ..default() });
    assert_eq!(desk.get::<Cloth>(cloth), &Cloth::default());
    assert_eq!(desk.heard().changed, ["Fabric"]);
}

#[test]
fn every_value_can_be_typed() {
    let mut app = app();
    let cloth = spawn_cloth(&mut app, "Curtain", ());
    app.world_mut().spawn(Wind::default());
    let mut desk = Desk::new(app);
    desk.click(Role::CheckBox, "Substeps by hand");
    for (name, text) in [
        ("Warp stiffness", "1200 N/m"),
        ("Weft stiffness", "900"),
        ("Warp stiffening", "11"),
        ("Weft stiffening", "7.5"),
        ("Compression", "0.3"),
        ("Shear stiffness", "120"),
        ("Bending rigidity", "6 µN·m"),
        ("Stretch damping", "10"),
        ("Bend damping", "30 ms"),
        ("Density", "0.235"),
        ("Thickness", "0.4 mm"),
        ("Friction", "0.45"),
        ("Drag", "1"),
        ("Lift", "0.1"),
        ("Damping", "0.5"),
        ("Max strain", "0.03"),
        ("Substeps", "17"),
        ("Tether slack", "0.02"),
        ("Max velocity", "30 m/s"),
        ("Collision margin", "8 mm"),
        ("Gravity scale", "-0.5"),
        ("Fluid density", "1.5"),
    ] {
        desk.type_value(name, text);
    }
    let fabric = Fabric {
        density: 0.235,
        thickness: 0.0004,
        warp_stiffness: 1200.0,
        weft_stiffness: 900.0,
        warp_stiffening: 11.0,
        weft_stiffening: 7.5,
        compression: 0.3,
        shear_stiffness: 120.0,
        bending_rigidity: 6e-6,
        stretch_damping: 0.01,
        bend_damping: 0.03,
        damping: 0.5,
        friction: 0.45,
        drag: 1.0,
        lift: 0.1,
    };
    assert_eq!(desk.get::<Fabric>(cloth), &fabric);
    let settings = Cloth {
        max_strain: 0.03,
        substeps: Some(17),
        tether_slack: Some(0.02),
        max_velocity: 30.0,
        gravity_scale: -0.5,
        fluid_density: 1.5,
        collision_margin: 0.008,
        ..default()
    };
    assert_eq!(desk.get::<Cloth>(cloth), &settings);
    for (axis, text) in ["1", "-1.62", "0.5"].into_iter().enumerate() {
        desk.type_nth_value("Gravity, m/s²", axis, text);
    }
    assert_eq!(desk.resource::<ClothGravity>().0, Vec3::new(1.0, -1.62, 0.5));
}

#[test]
fn the_solver_and_its_own_settings_can_be_chosen() {
    let mut app = app();
    let cloth = spawn_cloth(&mut app, "Curtain", ());
    let mut desk = Desk::new(app);
    desk.click(Role::CheckBox, "Tethers");
    assert_eq!(desk.get::<Cloth>(cloth).tether_slack, None);
    desk.click(Role::CheckBox, "Tethers");
    assert_eq!(desk.get::<Cloth>(cloth).tether_slack, Cloth::default().tether_slack);
    desk.click(Role::CheckBox, "Substeps by hand");
    let by_hand = desk.get::<Cloth>(cloth).substeps;
    assert!(by_hand.is_some_and(|substeps| substeps > 0));
    desk.choose(Role::ComboBox, "Solver", "XPBD");
    assert_eq!(desk.get::<Cloth>(cloth), &Cloth { solver: ClothSolver::Xpbd, substeps: by_hand, ..default() });
    assert!(desk.controls(Role::CheckBox, "Coarse levels").next().is_none(), "it has no levels");
    desk.click(Role::CheckBox, "Substeps by hand");
    assert_eq!(desk.get::<Cloth>(cloth).substeps, None);
    assert!(desk.controls(Role::Slider, "Substeps").next().is_none(), "they are chosen");
    desk.choose(Role::ComboBox, "Solver", "Explicit");
    assert_eq!(desk.get::<Cloth>(cloth).solver, ClothSolver::Explicit);
    desk.type_value("Max substeps", "700");
    assert_eq!(desk.get::<Cloth>(cloth), &Cloth { solver: ClothSolver::Explicit, max_substeps: 700, ..default() });
    assert!(desk.controls(Role::Slider, "Tether slack").next().is_none(), "it has no tethers");
}

#[test]
fn when_a_cloth_steps_can_be_chosen() {
    let mut app = app();
    let cloth = spawn_cloth(&mut app, "Curtain", Pins::none());
    let mut desk = Desk::new(app);
    desk.choose(Role::ComboBox, "Timing", "Late");
    assert_eq!(desk.get::<Cloth>(cloth), &Cloth { timing: ClothTiming::Late, ..default() });
    let height = |desk: &Desk| desk.get::<ClothState>(cloth).position(9).expect("a particle").y;
    let before = height(&desk);
    desk.frames(10);
    assert!(height(&desk) < before - 0.05, "it falls on");
    desk.choose(Role::ComboBox, "Timing", "Auto");
    assert_eq!(desk.get::<Cloth>(cloth), &Cloth::default());
}

#[test]
fn what_cloth_keeps_from_itself_can_be_typed_once_it_meets_itself() {
    let mut app = app();
    let cloth = spawn_cloth(&mut app, "Curtain", ());
    let mut desk = Desk::new(app);
    assert!(desk.controls(Role::Slider, "Self distance").next().is_none());
    desk.click(Role::CheckBox, "Self-collision");
    for (name, text) in [("Self distance", "6 mm"), ("Self friction", "0.5"), ("Leaving speed", "2 m/s")] {
        desk.type_value(name, text);
    }
    let settings = Cloth {
        self_collision: true,
        self_distance: 0.006,
        self_friction: 0.5,
        max_depenetration_velocity: 2.0,
        ..default()
    };
    assert_eq!(desk.get::<Cloth>(cloth), &settings);
}

#[test]
fn coarse_levels_go_and_come() {
    let mut app = app();
    let own = Cloth { levels: Some(vec![LevelPass { stride: 4, iterations: 6 }]), ..default() };
    let (auto, own) = (spawn_cloth(&mut app, "Auto", ()), spawn_cloth(&mut app, "Own", own));
    let mut desk = Desk::new(app);
    for (cloth, name) in [(auto, "Auto"), (own, "Own")] {
        desk.choose(Role::ComboBox, "Cloth", name);
        desk.click(Role::CheckBox, "Coarse levels");
        assert_eq!(desk.get::<Cloth>(cloth), &Cloth { levels: Some(Vec::new()), ..default() }, "{name}");
        desk.click(Role::CheckBox, "Coarse levels");
        assert_eq!(desk.get::<Cloth>(cloth), &Cloth::default(), "{name}");
    }
}

#[test]
fn a_preset_takes_all_its_values() {
    let mut app = app();
    let cloth = spawn_cloth(&mut app, "Curtain", ());
    let mut desk = Desk::new(app);
    desk.choose(Role::ComboBox, "Preset", "leather");
    assert_eq!(desk.get::<Fabric>(cloth), &Fabric::LEATHER);
    desk.choose(Role::ComboBox, "Preset", "silk");
    assert_eq!(desk.get::<Fabric>(cloth), &Fabric::SILK);
    assert_eq!(desk.heard().changed, ["Fabric", "Fabric"]);
}

#[test]
fn nothing_is_written_while_nothing_is_edited() {
    let mut app = app();
    let nan = Fabric { lift: f32::NAN, ..default() };
    let cloth = spawn_cloth(&mut app, "Curtain", nan);
    spawn_cloth(&mut app, "Flag", ());
    app.world_mut().spawn(Wind { velocity: Vec3::new(0.1, 0.2, 0.3), ..default() });
    let mut desk = Desk::new(app);
    desk.choose(Role::ComboBox, "Cloth", "All 2 cloths");
    desk.frames(20);
    assert_eq!(desk.heard(), Heard::default());
    assert!(desk.get::<Fabric>(cloth).lift.is_nan());
}

#[test]
fn a_field_that_is_entered_and_left_keeps_every_digit() {
    let mut app = app();
    let density = 0.123_456_79;
    let cloth = spawn_cloth(&mut app, "Curtain", Fabric { density, ..default() });
    let mut desk = Desk::new(app);
    let at = desk.control(Role::SpinButton, "Density").rect().center();
    desk.click_at(at);
    desk.harness.key_press(bevy_egui::egui::Key::Enter);
    desk.harness.run();
    desk.frame();
    assert_eq!(desk.get::<Fabric>(cloth).density.to_bits(), density.to_bits());
    assert_eq!(desk.heard(), Heard::default());
}

#[test]
fn an_edit_acts_in_the_next_step_and_the_cloth_moves_on() {
    let mut app = app();
    let cloth = spawn_cloth(&mut app, "Curtain", Pins::none());
    let mut desk = Desk::new(app);
    desk.frames(20);
    let fallen = |desk: &Desk| desk.get::<ClothState>(cloth).position(9).expect("a particle").y;
    let before = fallen(&desk);
    desk.type_value("Gravity scale", "0");
    desk.type_value("Density", "1");
    desk.choose(Role::ComboBox, "Preset", "wool flannel");
    desk.click(Role::CheckBox, "Substeps by hand");
    desk.slide("Substeps", 0.5);
    let state = desk.get::<ClothState>(cloth);
    let speed = state.velocity(9).expect("a particle").y;
    assert!(speed < -1.0, "it goes on as it went: {speed}");
    assert!(fallen(&desk) < before);
    assert_eq!(
        desk.get::<ClothReport>(cloth).latest().map(|report| report.substeps),
        desk.get::<Cloth>(cloth).substeps
    );
    desk.frames(10);
    let later = desk.get::<ClothState>(cloth).velocity(9).expect("a particle").y;
    assert!((later - speed).abs() < 0.3, "nothing accelerates it: {speed} to {later}");
    assert_eq!(desk.heard().resets, 0, "no edit puts a cloth back");
}

#[test]
fn an_edit_takes_a_cloth_off_its_fabrics_asset() {
    let mut app = app();
    let handle = app.world_mut().resource_mut::<Assets<Fabric>>().add(Fabric::SILK);
    let cloth = spawn_cloth(&mut app, "Curtain", FabricHandle::new(handle));
    let other = spawn_cloth(&mut app, "Flag", ());
    let mut desk = Desk::new(app);
    assert!(!desk.get::<FabricHandle>(cloth).detached);
    desk.type_value("Friction", "0.3");
    assert!(desk.get::<FabricHandle>(cloth).detached);
    assert_eq!(desk.get::<Fabric>(cloth), &Fabric { friction: 0.3, ..Fabric::SILK });
    assert_eq!(desk.get::<Fabric>(other), &Fabric::default());
}

#[test]
fn buttons_reset_pin_and_unpin() {
    let mut app = app();
    let cloth = spawn_cloth(&mut app, "Curtain", ());
    let mut desk = Desk::new(app);
    desk.click(Role::Button, "Unpin all");
    assert_eq!(desk.get::<Pins>(cloth), &Pins::none());
    desk.frames(5);
    let state = desk.get::<ClothState>(cloth);
    assert!((0..state.particle_count()).all(|i| !state.is_pinned(i)), "it falls");
    desk.click(Role::Button, "Reset");
    desk.frame();
    assert_eq!(desk.heard().resets, 1);
    desk.choose(Role::Button, "Pin ⏷", "Left edge");
    assert_eq!(desk.get::<Pins>(cloth), &Pins::edge(ClothEdge::Left));
    desk.choose(Role::Button, "Pin ⏷", "Top corners");
    let both = Pins::edge(ClothEdge::Left).and(Pins::edge_corners(ClothEdge::Top));
    assert_eq!(desk.get::<Pins>(cloth), &both);
}

#[test]
fn a_slider_is_held_on_to_while_rows_and_sections_come_and_go() {
    let mut app = app();
    let wind = app.world_mut().spawn(Wind { velocity: Vec3::Z, ..default() }).id();
    let mut desk = Desk::new(app);
    let rect = desk.control(Role::Slider, "Wind speed").rect();
    desk.harness.hover_at(rect.center());
    desk.harness.drag_at(rect.center());
    desk.harness.run();
    spawn_cloth(desk.app(), "Curtain", Cloth { solver: ClothSolver::Explicit, max_substeps: 1, ..default() });
    desk.frames(3);
    assert_ne!(desk.control(Role::Slider, "Wind speed").rect(), rect, "sections and a warning have come");
    desk.harness.hover_at(rect.right_center());
    desk.harness.run();
    desk.frame();
    assert_eq!(desk.get::<Wind>(wind).velocity, Vec3::Z * 30.0, "the end of the slider");
}
