//! Where the whole world is shifted, cloth goes on as if it hadn't been.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::common::*;

/// A cloth that lies over a ball that moves, and hangs on its entity, a pole and the world, in a gusty wind with a region
/// and in a hand; and one that is free.
fn busy_world() -> (App, [Entity; 2]) {
    let mut app = headless();
    let pole = app.world_mut().spawn(Transform::from_xyz(0.5, 0.0, 0.5)).id();
    let pins = Pins::indices([0]).and(Pins::indices([11]).to_world()).and(Pins::indices([143]).to_entity(pole));
    let cloth = spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 12, 12).lying(), pins);
    let mesh = uneven(ClothGrid::new(0.5, 0.5, 12, 12).lying(), 0.2);
    let free = spawn_cloth(&mut app, mesh, Transform::from_xyz(2.0, 0.25, 0.0));
    for x in [0.0, 2.0] {
        app.world_mut().spawn((ClothCollider::from(Sphere::new(0.25)), Transform::from_xyz(x, -0.25, 0.0)));
    }
    let region = WindShape::Sphere(Sphere::new(4.0));
    app.world_mut().spawn((Wind { velocity: Vec3::X * 3.0, region, ..default() }, Transform::default()));
    let roll = |mut balls: Query<&mut Transform, With<ClothCollider>>| {
        balls.iter_mut().for_each(|mut ball| ball.translation.z += 1.0 / 1024.0);
    };
    app.add_systems(FixedUpdate, roll);
    run(&mut app, 20);
    let point = ClothPoint { triangle: 150, weights: Vec3::X };
    let hand = take_hold(&mut app, cloth, point, ClothGrip::default()).unwrap();
    let at = state(&app, cloth).point_position(point).unwrap();
    // To a place that has no digits to lose.
    lead(&mut app, cloth, hand, (at * 64.0).round() / 64.0 + Vec3::new(0.0, 0.25, 0.0));
    run(&mut app, 5);
    (app, [cloth, free])
}

/// Where cloths are seconds later, from the world's origin, without a shift and with one.
fn after(by: Vec3, shift: impl Fn(&mut App, Vec3)) -> [Vec<Vec3>; 2] {
    let (mut app, cloths) = busy_world();
    run(&mut app, 3);
    shift(&mut app, by);
    run(&mut app, 57);
    cloths.map(|cloth| {
        let state = state(&app, cloth);
        let origin = state.origin() - by;
        state.positions_from_origin().map(|place| origin + place).collect()
    })
}

fn shift_world(app: &mut App, by: Vec3) {
    app.world_mut().commands().shift_world(by);
    app.world_mut().flush();
}

fn shift_by_hand(app: &mut App, by: Vec3) {
    let mut roots = app.world_mut().query_filtered::<&mut Transform, Without<ChildOf>>();
    roots.iter_mut(app.world_mut()).for_each(|mut place| place.translation += by);
    app.world_mut().commands().world_shifted(by);
    app.world_mut().flush();
}

#[test]
fn a_shifted_world_moves_on_as_one_that_stays() {
    let stayed = after(Vec3::ZERO, |_, _| {});
    for (by, tolerance) in [(Vec3::new(1024.0, -64.0, 512.0), 0.0), (Vec3::new(100.0, 33.3, -771.7), 1e-4)] {
        for shift in [shift_world, shift_by_hand] {
            for (stayed, shifted) in stayed.iter().zip(after(by, shift)) {
                for (&stayed, shifted) in stayed.iter().zip(shifted) {
                    assert_close(stayed, shifted, tolerance);
                }
            }
        }
    }
}

#[test]
fn a_shift_that_is_not_finite_does_nothing() {
    let stayed = after(Vec3::ZERO, |_, _| {});
    let shifted = after(Vec3::ZERO, |app, _| shift_world(app, Vec3::new(0.0, f32::NAN, 0.0)));
    assert_eq!(stayed, shifted);
}

#[test]
fn what_is_drawn_of_a_shifted_world_stays_the_same() {
    let (mut app, [cloth, _]) = busy_world();
    set_rates(&mut app, 1.0 / 150.0, 1.0 / 60.0);
    run(&mut app, 8);
    let place = |app: &App| get::<GlobalTransform>(app, cloth).transform_point(points(drawn(app, cloth))[100]);
    let before = place(&app);
    shift_world(&mut app, Vec3::X * 1024.0);
    run(&mut app, 1);
    assert_close(place(&app) - Vec3::X * 1024.0, before, 0.02);
}
