//! Obstacles are where their transforms put them, and move as those move.

use bevy::{math::primitives::InfinitePlane3d, prelude::*};
use bevy_drape::prelude::*;

use crate::common::*;

/// A weightless sheet that lies at height 0.
fn floating(app: &mut App) -> Entity {
    let cloth = Cloth { gravity_scale: 0.0, substeps: Some(16), ..default() };
    spawn_cloth(app, ClothGrid::new(1.0, 1.0, 17, 17).lying(), (cloth, undamped()))
}

fn lowest(app: &App, cloth: Entity) -> f32 {
    positions(app, cloth).into_iter().map(|place| place.y).fold(f32::MAX, f32::min)
}

#[test]
fn a_ball_that_a_transform_moves_at_ten_metres_a_second_is_not_passed() {
    let mut app = headless();
    let cloth = floating(&mut app);
    let ball = app.world_mut().spawn((ClothCollider::from(Sphere::new(0.2)), Transform::from_xyz(0.0, 1.0, 0.0))).id();
    run(&mut app, 2);
    for _ in 0..12 {
        get_mut::<Transform>(&mut app, ball).translation.y -= 10.0 / 60.0;
        run(&mut app, 1);
    }
    let bottom = get::<Transform>(&app, ball).translation.y - 0.2;
    assert!(lowest(&app, cloth) <= bottom, "{} over {bottom}", lowest(&app, cloth));
}

#[test]
fn parent_rotation_and_scale_place_an_obstacle() {
    let mut app = headless();
    // A box of 0.2 x 4 x 0.2, turned to lie along x and put 0.5 below by its parent.
    let parent = app.world_mut().spawn(Transform::from_xyz(0.0, -0.5, 0.0).with_scale(Vec3::splat(2.0))).id();
    let turned = Transform::from_rotation(Quat::from_rotation_z(core::f32::consts::FRAC_PI_2));
    let bar = ClothCollider::from(Cuboid::new(0.1, 2.0, 0.1));
    app.world_mut().spawn((bar, turned, ChildOf(parent)));
    let close = (Cloth { collision_margin: 0.0, ..default() }, Fabric { thickness: 1e-6, ..default() });
    let cloth = spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 9, 9).lying(), close);
    run(&mut app, 40);
    // The row in the middle lies on the bar, from end to end.
    for column in 0..9 {
        let place = place(&app, cloth, 4 * 9 + column);
        assert!((place.y + 0.4).abs() < 0.02, "column {column}: {place}");
    }
}

#[test]
fn a_mirrored_slope_slopes_the_other_way() {
    let slides_to = |scale: f32| {
        let mut app = headless();
        let slope = InfinitePlane3d::new(Vec3::new(0.6, 0.8, 0.0));
        let mirrored = Transform::from_xyz(0.0, -0.5, 0.0).with_scale(Vec3::new(scale, 1.0, 1.0));
        app.world_mut().spawn((ClothCollider { friction: 0.0, ..slope.into() }, mirrored));
        let cloth = spawn_cloth(&mut app, ClothGrid::new(0.5, 0.5, 5, 5).lying(), undamped());
        run(&mut app, 60);
        place(&app, cloth, 12).x
    };
    assert!(slides_to(1.0) > 0.3);
    assert!(slides_to(-1.0) < -0.3);
}

#[test]
fn an_obstacle_that_comes_back_elsewhere_does_not_sweep_there() {
    let mut app = headless();
    let cloth = floating(&mut app);
    let ball = ClothCollider::from(Sphere::new(0.2));
    let entity = app.world_mut().spawn((ball.clone(), Transform::from_xyz(0.0, 0.5, 0.0))).id();
    run(&mut app, 3);
    app.world_mut().entity_mut(entity).remove::<ClothCollider>();
    get_mut::<Transform>(&mut app, entity).translation.y = -0.5;
    run(&mut app, 3);
    app.world_mut().entity_mut(entity).insert(ball);
    run(&mut app, 3);
    assert_eq!(lowest(&app, cloth), 0.0);
}
