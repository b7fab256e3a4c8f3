//! A state that leaves the finite numbers goes back to the last that was finite.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::common::*;

const GRID: ClothGrid = ClothGrid { size: Vec2::ONE, particles: UVec2::new(6, 6), lying: false };

fn hanging() -> (App, Entity) {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, GRID, Pins::corners());
    run(&mut app, 30);
    (app, cloth)
}

#[test]
fn a_huge_impulse_is_taken_back_and_the_cloth_goes_on() {
    let (mut app, cloth) = hanging();
    let before = positions(&app, cloth);
    get_mut::<ClothState>(&mut app, cloth).add_impulse(14, Vec3::splat(f32::MAX));
    run(&mut app, 1);
    assert_eq!(positions(&app, cloth), before);
    assert!(state(&app, cloth).velocities().all(|velocity| velocity == Vec3::ZERO));
    assert!(points(drawn(&app, cloth)).into_iter().all(Vec3::is_finite));
    run(&mut app, 60);
    assert_ne!(positions(&app, cloth), before);
    assert!(positions(&app, cloth).into_iter().all(|place| place.length() < 2.0));
    let reset = app.world().resource::<Heard>().reset.clone();
    assert_eq!(reset, [(cloth, ResetCause::NotFinite)]);
}

#[test]
fn a_huge_force_is_taken_back_and_forgotten() {
    let (mut app, cloth) = hanging();
    get_mut::<ClothState>(&mut app, cloth).add_force(14, Vec3::Y * f32::MAX);
    get_mut::<ClothState>(&mut app, cloth).add_force(14, Vec3::Y * f32::MAX);
    run(&mut app, 60);
    assert_eq!(app.world().resource::<Heard>().reset, [(cloth, ResetCause::NotFinite)]);
    assert!(positions(&app, cloth).into_iter().all(|place| place.length() < 2.0));
}

#[test]
fn an_impulse_of_any_size_leaves_a_cloth_that_can_come_back() {
    for exponent in [3, 6, 9, 12, 15, 18, 21, 24, 27, 30, 33, 36] {
        let (mut app, cloth) = hanging();
        get_mut::<ClothState>(&mut app, cloth).add_impulse(14, Vec3::Z * 10_f32.powi(exponent));
        run(&mut app, 60);
        let farthest = positions(&app, cloth).into_iter().map(Vec3::length).fold(0.0, f32::max);
        let resets = app.world().resource::<Heard>().reset.len();
        assert!(farthest < 100.0 && resets < 2, "1e{exponent}: {farthest} m, {resets} resets");
    }
}

#[test]
fn an_impulse_of_any_size_leaves_a_free_cloth_finite() {
    for exponent in [3, 6, 9, 12, 15, 18, 21, 24, 27, 30, 33, 36] {
        let mut app = headless();
        let cloth = spawn_cloth(&mut app, GRID, ());
        run(&mut app, 10);
        get_mut::<ClothState>(&mut app, cloth).add_impulse(14, Vec3::Z * 10_f32.powi(exponent));
        run(&mut app, 60);
        let resets = app.world().resource::<Heard>().reset.len();
        assert!(resets < 2, "1e{exponent}: {resets} resets");
        assert!(positions(&app, cloth).into_iter().all(Vec3::is_finite), "1e{exponent}");
    }
}

#[test]
fn one_cloth_that_fails_leaves_the_others_alone() {
    let (mut app, cloth) = hanging();
    let other = spawn_cloth(&mut app, GRID, Pins::corners());
    let (mut control, lone) = hanging();
    get_mut::<ClothState>(&mut app, other).add_impulse(0, Vec3::splat(f32::MAX));
    run(&mut app, 20);
    run(&mut control, 20);
    assert_eq!(positions(&app, cloth), positions(&control, lone));
}
