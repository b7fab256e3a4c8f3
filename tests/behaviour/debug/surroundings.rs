//! Colliders and winds are drawn as the solver sees them.

use core::f32::consts::FRAC_PI_2;

use bevy::{math::primitives::InfinitePlane3d, prelude::*};
use bevy_drape::prelude::*;

use super::*;

fn steady(velocity: Vec3) -> Wind {
    Wind { velocity, gusts: 0.0, turbulence: 0.0, ..default() }
}

/// An app that draws the wind, and a cloth in it.
fn windy(at: Vec3) -> (App, Entity) {
    let mut app = inside();
    config(&mut app).wind = true;
    let cloth = spawn_sheet(&mut app, (Pins::corners(), Transform::from_translation(at)));
    (app, cloth)
}

/// The arrows' shafts: each has four lines more for its tip.
fn arrows(app: &App) -> Vec<Line> {
    lines(app).chunks(5).map(|arrow| arrow[0]).collect()
}

#[test]
fn lines_of_colliders_lie_on_their_surface() {
    let pose = Transform::from_xyz(3.0, -2.0, 1.0).with_rotation(Quat::from_euler(EulerRot::XYZ, 0.4, -0.9, 1.3));
    let twice = Vec3::splat(2.0);
    let (flat, half_size) = (Vec3::new(2.0, 0.4, 1.0), Vec3::new(0.8, 0.16, 0.4));
    let colliders: [(ClothCollider, Vec3, Solid); 5] = [
        (Sphere::new(0.4).into(), twice, Solid::Sphere(Sphere::new(0.8))),
        (Sphere::new(0.4).into(), flat, Solid::Ellipsoid(Ellipsoid { half_size })),
        (Cuboid::new(0.6, 1.0, 0.4).into(), twice, Solid::Cuboid(Cuboid::new(1.2, 2.0, 0.8))),
        (Capsule3d::new(0.2, 0.8).into(), twice, Solid::Capsule(Capsule3d::new(0.4, 1.6))),
        (Cylinder::new(0.3, 0.9).into(), twice, Solid::Cylinder(Cylinder::new(0.6, 1.8))),
    ];
    for (collider, scale, solid) in colliders {
        let mut app = inside();
        config(&mut app).colliders = true;
        app.world_mut().spawn((collider, pose.with_scale(scale)));
        run(&mut app, 1);
        let lines = lines(&app);
        assert!(lines.len() >= 12, "{solid:?}: {}", lines.len());
        for place in lines.iter().flat_map(|line| [line.from, line.to]) {
            let local = pose.to_matrix().inverse().transform_point3(place);
            let distance = solid.surface(local.into()).distance;
            assert!(distance.abs() < 1e-4, "{solid:?}: {local} is {distance} m from the surface");
        }
    }
}

#[test]
fn a_half_space_shows_its_plane_and_the_way_out() {
    let mut app = inside();
    config(&mut app).colliders = true;
    let pose = Transform::from_xyz(0.0, -2.0, 1.0).with_rotation(Quat::from_rotation_z(FRAC_PI_2));
    app.world_mut().spawn((ClothCollider::from(InfinitePlane3d::new(Vec3::Y)), pose));
    run(&mut app, 1);
    let lines = lines(&app);
    let along: Vec<f32> = lines.iter().map(|line| line.to.x).collect();
    let in_plane = along.iter().filter(|x| x.abs() < 1e-4).count();
    assert!(in_plane >= 30, "a grid");
    let (lowest, highest) = along.iter().fold((0.0_f32, 0.0_f32), |(low, high), &x| (low.min(x), high.max(x)));
    assert!(lowest < -0.9 && highest < 1e-4, "an arrow towards -x");
    assert_close(lines[0].from, pose.translation, 1e-5);
}

#[cfg(feature = "mesh_colliders")]
#[test]
fn a_mesh_shows_each_of_its_edges() {
    let mut app = inside();
    config(&mut app).colliders = true;
    let pose = Transform::from_xyz(3.0, -2.0, 1.0).with_rotation(Quat::from_rotation_y(0.4));
    let mesh = add_mesh(&mut app, Cuboid::new(0.6, 1.0, 0.4));
    let block = app.world_mut().spawn((Mesh3d(mesh), ClothCollider::mesh(), pose.with_scale(Vec3::splat(2.0)))).id();
    run(&mut app, 1);
    assert_eq!(lines(&app).len(), 12 + 6, "twelve sides and six diagonals");
    for place in lines(&app).iter().flat_map(|line| [line.from, line.to]) {
        let local = pose.to_matrix().inverse().transform_point3(place);
        assert_close(local.abs(), Vec3::new(0.6, 1.0, 0.4), 1e-5);
    }
    app.world_mut().despawn(block);
    run(&mut app, 1);
    assert_eq!(lines(&app), []);
}

#[test]
fn colliders_are_shown_as_the_latest_step_saw_them() {
    let mut app = inside();
    config(&mut app).colliders = true;
    let ball = app.world_mut().spawn((ClothCollider::from(Sphere::new(0.4)), Transform::default())).id();
    run(&mut app, 1);
    let on_the_ball = |app: &App, place: Vec3| lines(app).iter().all(|l| (l.from.distance(place) - 0.4).abs() < 1e-5);
    assert!(!lines(&app).is_empty() && on_the_ball(&app, Vec3::ZERO));
    get_mut::<Transform>(&mut app, ball).translation.x = 2.0;
    run(&mut app, 1);
    assert!(on_the_ball(&app, Vec3::X * 2.0));
    // Of no size: the solver leaves it out.
    get_mut::<Transform>(&mut app, ball).scale = Vec3::ZERO;
    run(&mut app, 1);
    assert_eq!(lines(&app), []);
}

#[test]
fn arrows_point_with_the_wind_and_are_as_long_as_it_is_fast() {
    for at in [Vec3::ZERO, Vec3::new(10_000.0, 5.0, -10_000.0)] {
        let (mut app, cloth) = windy(at);
        let turned = Transform::from_rotation(Quat::from_rotation_y(FRAC_PI_2));
        app.world_mut().spawn((steady(Vec3::X * 4.0), turned));
        app.world_mut().spawn(steady(Vec3::Y * 3.0));
        run(&mut app, 2);
        // Away from the origin that its positions are relative to.
        let at = at + Vec3::X * 2.0;
        get_mut::<Transform>(&mut app, cloth).translation = at;
        run(&mut app, 1);
        let bounds = drawn(&app, cloth).final_aabb.unwrap();
        assert_eq!(arrows(&app).len(), 25);
        for arrow in arrows(&app) {
            assert_close(arrow.way(), Vec3::new(0.0, 3.0, -4.0) * 0.05, 2e-3);
            let local = arrow.from - at;
            assert!(
                local.cmpge(Vec3::from(bounds.min) - 1e-3).all() && local.cmple(Vec3::from(bounds.max) + 1e-3).all()
            );
        }
        config(&mut app).wind_scale = 0.1;
        run(&mut app, 1);
        assert_close(arrows(&app)[7].way(), Vec3::new(0.0, 3.0, -4.0) * 0.1, 2e-3);
    }
}

#[test]
fn arrows_show_what_the_cloth_feels() {
    let (mut app, _) = windy(Vec3::new(0.0, 3.0, 0.0));
    let gusty = Wind { velocity: Vec3::X * 4.0, gusts: 0.5, turbulence: 0.5, eddy_size: 0.5, ..default() };
    app.world_mut()
        .spawn((Wind { region: WindShape::Sphere(Sphere::new(0.4)), ..gusty }, Transform::from_xyz(0.5, 3.0, 0.0)));
    run(&mut app, 2);
    let (inside, others): (Vec<Line>, Vec<Line>) =
        arrows(&app).into_iter().partition(|arrow| arrow.from.distance(Vec3::new(0.5, 3.0, 0.0)) < 0.4);
    assert!(inside.len() >= 3 && others.is_empty(), "{} and {}", inside.len(), others.len());
    let ways: Vec<Vec3> = inside.iter().map(|arrow| arrow.way()).collect();
    assert!(ways.iter().all(|way| way.x > 0.0));
    assert!(ways.iter().any(|way| way.angle_between(ways[0]) > 0.01), "eddies differ from place to place");
}

#[test]
fn still_air_has_no_arrows() {
    let (mut app, _) = windy(Vec3::ZERO);
    app.world_mut().spawn(Wind::default());
    run(&mut app, 2);
    assert_eq!(lines(&app), []);
}
