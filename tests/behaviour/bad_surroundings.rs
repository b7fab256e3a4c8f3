//! What surrounds a cloth may be nonsense: the cloth stays finite and does what is left to do.

use bevy::{math::primitives::InfinitePlane3d, prelude::*};
use bevy_drape::prelude::*;

use crate::common::*;

const GRID: ClothGrid = ClothGrid { size: Vec2::ONE, particles: UVec2::new(5, 5), lying: true };

/// A free cloth and where it is after half a second in the company of what `prepare` spawns.
fn after(prepare: impl FnOnce(&mut App, Entity)) -> (App, Entity, Vec<Vec3>) {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, GRID, Pins::indices([0, 4]));
    run(&mut app, 2);
    prepare(&mut app, cloth);
    run(&mut app, 30);
    let places = positions(&app, cloth);
    assert!(places.iter().all(|place| place.is_finite()));
    (app, cloth, places)
}

fn alone() -> Vec<Vec3> {
    after(|_, _| ()).2
}

#[test]
fn forces_and_impulses_that_are_not_numbers_are_ignored() {
    let (_, _, places) = after(|app, cloth| {
        let mut state = get_mut::<ClothState>(app, cloth);
        for bad in [Vec3::NAN, Vec3::INFINITY] {
            state.add_force(12, bad);
            state.add_impulse(12, bad);
            state.add_force_in_radius(Vec3::ZERO, 1.0, bad);
            state.add_impulse_in_radius(Vec3::ZERO, 1.0, bad);
            state.add_force_in_radius(bad, 1.0, Vec3::ONE);
            state.add_impulse_in_radius(Vec3::ZERO, f32::NAN, Vec3::ONE);
        }
        state.add_force_in_radius(Vec3::ZERO, 0.0, Vec3::ONE);
        state.add_impulse_in_radius(Vec3::ZERO, -1.0, Vec3::ONE);
        state.add_force(999, Vec3::ONE);
        state.add_impulse(999, Vec3::ONE);
    });
    assert_eq!(places, alone());
}

#[test]
fn colliders_of_no_size_or_no_number_are_left_out() {
    let below = Transform::from_xyz(0.0, -0.2, 0.0);
    let ball = |radius| ClothCollider::from(Sphere { radius });
    let bad: [(ClothCollider, Transform); 9] = [
        (ball(0.0), below),
        (ball(-0.3), below),
        (ball(f32::NAN), below),
        (ball(f32::INFINITY), below),
        (ball(0.3), below.with_scale(Vec3::ZERO)),
        (ball(0.3), Transform::from_xyz(f32::NAN, 0.0, 0.0)),
        (ClothCollider { friction: f32::NAN, ..ball(0.3) }, below),
        (ClothCollider { friction: f32::INFINITY, ..ball(0.3) }, below),
        (ClothCollider::from(Cuboid { half_size: Vec3::new(0.3, 0.0, 0.3) }), below),
    ];
    let expected = alone();
    for (collider, transform) in bad {
        let what = format!("{collider:?} at {transform:?}");
        let (.., places) = after(|app, _| {
            app.world_mut().spawn((collider, transform));
        });
        assert_eq!(places, expected, "{what}");
    }
    let (.., places) = after(|app, _| {
        app.world_mut().spawn((ball(0.3), below));
    });
    assert_ne!(places, expected, "and a good one isn't");
}

#[test]
fn a_collider_that_is_mended_works_again() {
    let mut app = headless();
    let ground = ClothCollider::from(InfinitePlane3d::new(Vec3::Y));
    let ground = app.world_mut().spawn((ground, Transform::from_xyz(0.0, f32::NAN, 0.0))).id();
    let cloth = spawn_cloth(&mut app, GRID, ());
    run(&mut app, 5);
    *get_mut::<Transform>(&mut app, ground) = Transform::from_xyz(0.0, -0.5, 0.0);
    run(&mut app, 60);
    let distance = Fabric::default().thickness + Cloth::default().collision_margin;
    for place in positions(&app, cloth) {
        assert!((place.y + 0.5 - distance).abs() < 1e-3, "{place}");
    }
}

#[test]
fn winds_that_are_not_numbers_are_left_out() {
    let wind = |velocity: Vec3| Wind { velocity, ..default() };
    let good = wind(Vec3::new(0.0, 3.0, 2.0));
    let bad = [
        wind(Vec3::NAN),
        wind(Vec3::INFINITY),
        Wind { gusts: f32::NAN, ..good.clone() },
        Wind { eddy_size: -1.0, ..good.clone() },
        Wind { region: WindShape::Sphere(Sphere { radius: f32::NAN }), ..good.clone() },
    ];
    let expected = alone();
    for wind in bad {
        let what = format!("{wind:?}");
        let (.., places) = after(|app, _| {
            app.world_mut().spawn(wind);
        });
        assert_eq!(places, expected, "{what}");
    }
    let (.., places) = after(|app, _| {
        app.world_mut().spawn(good);
    });
    assert_ne!(places, expected, "and a good one isn't");
}

#[test]
fn zeros_in_a_wind_are_fine() {
    let still = Wind { gust_period: 0.0, eddy_size: 0.0, edge: 0.0, ..default() };
    for region in [WindShape::Everywhere, WindShape::Sphere(Sphere { radius: 0.0 }), WindShape::default()] {
        let _ = after(|app, _| {
            app.world_mut().spawn(Wind { velocity: Vec3::Y * 4.0, region, ..still.clone() });
        });
    }
}

#[test]
fn gravity_that_is_not_a_number_moves_nothing() {
    let _ = after(|app, _| {
        app.insert_resource(ClothGravity(Vec3::NAN));
    });
}

#[test]
fn steps_of_ten_seconds_are_survived() {
    let mut app = headless();
    app.world_mut().resource_mut::<Time<Virtual>>().set_max_delta(core::time::Duration::from_secs(100));
    set_rates(&mut app, 10.0, 10.0);
    app.world_mut().spawn((ClothCollider::from(Solid::Sphere(Sphere::new(0.3))), Transform::from_xyz(0.0, -0.4, 0.0)));
    let cloth = spawn_cloth(&mut app, GRID, Pins::corners());
    run(&mut app, 1);
    // A tenth of a second of free fall at most, not ten.
    assert!(positions(&app, cloth).into_iter().all(|place| place.is_finite() && place.y > -0.1 && place.y < 0.1));
    run(&mut app, 60);
    assert_eq!(app.world().resource::<Heard>().reset, []);
    assert!(positions(&app, cloth).into_iter().all(|place| place.length() < 2.0));
}

#[test]
fn an_update_of_ten_seconds_runs_no_more_than_bevy_asks_for() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, GRID, Pins::corners());
    run(&mut app, 5);
    set_rates(&mut app, 10.0, 1.0 / 60.0);
    run(&mut app, 3);
    assert!(positions(&app, cloth).into_iter().all(|place| place.length() < 2.0));
    assert!(state(&app, cloth).velocities().all(|velocity| velocity.length() < 10.0));
}
