//! Contact that can't be kept, or that changes while it is there: nothing is thrown and nothing gets lost.

use bevy::{math::primitives::InfinitePlane3d, prelude::*};
use bevy_drape::{prelude::*, solver::measure};

use crate::{common::*, quiet::Quiet};

/// A sheet of 40 cm at `height`.
fn sheet(app: &mut App, height: f32, cloth: Cloth) -> Entity {
    let fabric = Fabric { damping: 1.0, ..undamped() };
    let grid = ClothGrid::new(0.4, 0.4, 13, 13).lying();
    spawn_cloth(app, grid, (cloth, fabric, Transform::from_xyz(0.01, height, 0.02)))
}

fn meeting() -> Cloth {
    Cloth { self_collision: true, substeps: Some(16), ..default() }
}

fn fastest(app: &App, cloth: Entity) -> f32 {
    state(app, cloth).velocities().map(Vec3::length).fold(0.0, f32::max)
}

fn ground(app: &mut App) -> Entity {
    app.world_mut().spawn((ClothCollider::from(InfinitePlane3d::default()), Transform::default())).id()
}

#[test]
fn a_cloth_comes_to_rest_on_colliders_that_are_in_each_other() {
    let mut quiet = Quiet::new();
    let app = &mut quiet.app;
    ground(app);
    for (collider, place) in [
        (ClothCollider::from(Cuboid::new(0.3, 0.2, 0.3)), Vec3::new(0.0, 0.1, 0.0)),
        (ClothCollider::from(Sphere::new(0.15)), Vec3::new(0.05, 0.15, 0.0)),
        (ClothCollider::from(Sphere::new(0.15)), Vec3::new(0.05, 0.15, 0.0)),
        (ClothCollider::from(Capsule3d::new(0.05, 0.6)), Vec3::new(-0.05, 0.1, 0.05)),
    ] {
        app.world_mut().spawn((collider, Transform::from_translation(place)));
    }
    #[cfg(feature = "mesh_colliders")]
    {
        let torus = add_mesh(app, Torus::new(0.05, 0.2));
        app.world_mut().spawn((ClothCollider::mesh_of(torus), Transform::from_xyz(0.0, 0.18, 0.0)));
    }
    let cloth = sheet(app, 0.5, Cloth { substeps: Some(16), ..default() });
    assert_eq!(quiet.run(180), Vec::<String>::new());
    assert!(fastest(&quiet.app, cloth) < 0.2, "{} m/s", fastest(&quiet.app, cloth));
    assert!(positions(&quiet.app, cloth).iter().all(|place| place.is_finite() && place.y > 0.0));
    assert_eq!(quiet.app.world().resource::<Heard>().reset, []);
}

#[test]
fn a_cloth_that_starts_where_colliders_are_in_each_other_stays_whole() {
    let mut app = headless();
    for x in [-0.05, 0.05] {
        app.world_mut().spawn((ClothCollider::from(Sphere::new(0.15)), Transform::from_xyz(x, 0.0, 0.0)));
        app.world_mut().spawn((ClothCollider::from(Cuboid::from_length(0.2)), Transform::from_xyz(0.0, x, x)));
    }
    let cloth = sheet(&mut app, 0.0, Cloth { gravity_scale: 0.0, ..default() });
    for _ in 0..120 {
        run(&mut app, 1);
        // What hangs out is jerked along: 20 m/s were measured.
        assert!(fastest(&app, cloth) < 40.0, "{} m/s", fastest(&app, cloth));
    }
    assert_eq!(app.world().resource::<Heard>().reset, []);
}

/// The highest speed of two sheets that fall on each other and keep such a distance for so many frames, m/s.
fn thrown(self_distance: f32, frames: usize) -> f32 {
    let mut app = headless();
    ground(&mut app);
    let cloth = Cloth { self_distance, ..meeting() };
    let cloths = [0.1, 0.15].map(|height| sheet(&mut app, height, cloth.clone()));
    let mut most = 0.0_f32;
    for _ in 0..frames {
        run(&mut app, 1);
        most = cloths.iter().map(|&cloth| fastest(&app, cloth)).fold(most, f32::max);
    }
    assert!(cloths.iter().all(|&cloth| positions(&app, cloth).iter().all(|place| place.is_finite())));
    assert_eq!(app.world().resource::<Heard>().reset, [], "{self_distance} m");
    most
}

#[test]
fn distances_that_no_cloth_can_keep_throw_nothing() {
    for self_distance in [1e-30, 0.1] {
        let most = thrown(self_distance, 60);
        assert!(most < 2.0, "{self_distance} m: {most} m/s");
    }
    // Beyond all measure, sheets fly apart no faster than they may, and slowly: everything is near everything.
    let most = thrown(f32::MAX, 2);
    assert!(most < 1.01 * Cloth::default().max_velocity, "{most} m/s");
}

#[test]
fn a_self_distance_that_turns_bad_is_ignored() {
    let lies = |bad: Option<f32>| {
        let mut app = headless();
        ground(&mut app);
        let cloths = [0.1, 0.15].map(|height| sheet(&mut app, height, meeting()));
        run(&mut app, 5);
        if let Some(bad) = bad {
            get_mut::<Cloth>(&mut app, cloths[1]).self_distance = bad;
        }
        run(&mut app, 40);
        cloths.map(|cloth| positions(&app, cloth))
    };
    let expected = lies(None);
    for bad in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        assert_eq!(lies(Some(bad)), expected, "{bad}");
    }
}

#[test]
fn cloths_meet_from_the_moment_that_they_are_told_to() {
    let apart = |switch: &[(usize, bool)]| {
        let mut app = headless();
        ground(&mut app);
        let start = switch.is_empty();
        let cloth = |self_collision| Cloth { self_collision, ..meeting() };
        let cloths = [0.02, 0.3].map(|height| sheet(&mut app, height, cloth(start)));
        for frame in 0..90 {
            for &(_, meets) in switch.iter().filter(|&&(when, _)| when == frame) {
                for entity in cloths {
                    get_mut::<Cloth>(&mut app, entity).self_collision = meets;
                }
            }
            run(&mut app, 1);
            assert!(cloths.iter().all(|&cloth| fastest(&app, cloth) < 5.0), "frame {frame}");
        }
        let [lower, upper] =
            cloths.map(|cloth| positions(&app, cloth).iter().map(|place| place.y).sum::<f32>() / 169.0);
        upper - lower
    };
    let kept = Cloth::default().self_distance;
    assert!((apart(&[]) - kept).abs() < 0.2 * kept, "{}", apart(&[]));
    // In the air.
    let switched = apart(&[(3, true)]);
    assert!((switched - kept).abs() < 0.2 * kept, "{switched}");
    // On and off: the upper one sinks to the ground, through the other.
    let off_again = apart(&[(3, true), (60, false)]);
    assert!(off_again < 0.5 * kept, "{off_again}");
    // When they have lain in the same place for long, nothing is thrown; who is above is anyone's guess.
    let late = apart(&[(60, true)]);
    assert!(late.abs() < 2.0 * kept, "{late}");
}

#[test]
fn what_a_cloth_went_through_before_it_was_told_not_to_comes_out() {
    let mut app = headless();
    ground(&mut app);
    let cloth = spawn_cloth(
        &mut app,
        ClothGrid::new(0.3, 0.6, 11, 21),
        (
            undamped(),
            Cloth { substeps: Some(16), ..default() },
            Transform::from_xyz(0.0, 0.4, 0.0).with_rotation(Quat::from_rotation_x(0.1)),
        ),
    );
    let tangles = |app: &App| {
        let state = state(app, cloth);
        let origin = state.origin();
        let places = positions(app, cloth).into_iter().map(|place| (place - origin).into()).collect();
        let particles = bevy_drape::solver::Particles { position: places, ..default() };
        measure::intersecting_pairs(&particles, state.topology())
    };
    run(&mut app, 60);
    let before = tangles(&app);
    get_mut::<Cloth>(&mut app, cloth).self_collision = true;
    run(&mut app, 300);
    assert!(before > 0 && tangles(&app) <= before / 4, "{before} pairs, then {}", tangles(&app));
}
