//! Cloths meet each other where both are told to.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::common::*;

fn meeting() -> Cloth {
    Cloth { self_collision: true, substeps: Some(8), ..default() }
}

/// A sheet that is held at its four corners at `height`.
fn held(app: &mut App, height: f32, cloth: Cloth) -> Entity {
    let corners = [0, 16, 16 * 17, 17 * 17 - 1];
    let bundle = (cloth, undamped(), Pins::indices(corners), Transform::from_xyz(0.0, height, 0.0));
    spawn_cloth(app, ClothGrid::new(1.0, 1.0, 17, 17).lying(), bundle)
}

/// A smaller sheet that falls from `height`.
fn falling(app: &mut App, height: f32, cloth: Cloth) -> Entity {
    let bundle = (cloth, Fabric { damping: 1.0, ..undamped() }, Transform::from_xyz(0.02, height, 0.03));
    spawn_cloth(app, ClothGrid::new(0.4, 0.4, 13, 13).lying(), bundle)
}

fn middle(app: &App, cloth: Entity) -> f32 {
    let places = positions(app, cloth);
    places.iter().map(|place| place.y).sum::<f32>() / places.len() as f32
}

#[test]
fn a_cloth_falls_onto_another_and_stays_there() {
    let mut app = headless();
    let net = held(&mut app, 0.0, meeting());
    let sheet = falling(&mut app, 0.2, meeting());
    run(&mut app, 120);
    assert!(middle(&app, sheet) > -0.4, "it lies at {}", middle(&app, sheet));
    let lowest = |app: &App, cloth| positions(app, cloth).iter().map(|place| place.y).fold(f32::MAX, f32::min);
    assert!(lowest(&app, sheet) > lowest(&app, net), "on top");
}

#[test]
fn a_cloth_passes_one_that_is_not_told_to_meet_it() {
    let passes = |of_net: Cloth, of_sheet: Cloth| {
        let mut app = headless();
        held(&mut app, 0.0, of_net);
        let sheet = falling(&mut app, 0.2, of_sheet);
        run(&mut app, 60);
        middle(&app, sheet) < -1.0
    };
    assert!(passes(Cloth::default(), meeting()));
    assert!(passes(meeting(), Cloth::default()));
    assert!(passes(meeting(), Cloth { collision_layers: 2, collision_mask: 2, ..meeting() }));
    assert!(!passes(Cloth { collision_layers: 2, ..meeting() }, Cloth { collision_mask: 2, ..meeting() }));
}

#[test]
fn cloths_meet_wherever_their_origins_are() {
    let lies_at = |origin: f32| {
        let mut app = headless();
        let net = held(&mut app, 0.0, meeting());
        let sheet = falling(&mut app, 0.2, meeting());
        for cloth in [net, sheet] {
            get_mut::<Transform>(&mut app, cloth).translation.x += origin;
        }
        run(&mut app, 60);
        middle(&app, sheet)
    };
    assert!((lies_at(0.0) - lies_at(512.0)).abs() < 0.01, "{} and {}", lies_at(0.0), lies_at(512.0));
}

#[test]
fn cloths_that_meet_have_the_same_bits_on_one_thread_and_on_many() {
    let places = |plugin: ClothPlugin| {
        let mut app = headless_with(plugin);
        let net = held(&mut app, 0.0, meeting());
        let sheets = [0.1, 0.2, 0.3].map(|height| falling(&mut app, height, meeting()));
        run(&mut app, 60);
        let all = sheets.into_iter().chain([net]).flat_map(|cloth| positions(&app, cloth)).collect::<Vec<_>>();
        all.into_iter().flat_map(|place| place.to_array()).map(f32::to_bits).collect::<Vec<_>>()
    };
    assert_eq!(places(ClothPlugin::default()), places(ClothPlugin::default().single_threaded()));
}

#[test]
fn a_cloth_that_is_told_to_meet_itself_does_not_when_it_is_alone_and_flat() {
    let hung = |cloth: Cloth| {
        let mut app = headless();
        let pins = Pins::edge_corners(ClothEdge::Top);
        let cloth = spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 17, 17), (cloth, undamped(), pins));
        run(&mut app, 30);
        positions(&app, cloth)
    };
    assert_eq!(hung(meeting()), hung(Cloth { self_collision: false, ..meeting() }));
}
