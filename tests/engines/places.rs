//! Colliders of engines are met where they are.

use core::f32::consts::{FRAC_1_SQRT_2, FRAC_PI_2, FRAC_PI_4};

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::{
    common::*,
    engine::{BOTH, Engine, Form},
};

/// Distance that [`patch`] keeps, m.
const KEPT: f32 = 0.006;

/// A small patch of cloth that falls on what is below, flat in the air at first.
pub fn patch(app: &mut App, at: Vec3) -> Entity {
    let cloth = Cloth { collision_margin: KEPT - 0.001, substeps: Some(16), ..default() };
    let fabric = Fabric { thickness: 0.001, friction: 0.9, ..undamped() };
    spawn_cloth(app, ClothGrid::new(0.1, 0.1, 5, 5).lying(), (cloth, fabric, Transform::from_translation(at)))
}

/// Height of the middle of a patch that has fallen on a collider for half a second, above the collider's summit.
fn height_above(engine: Engine, form: &Form, at: Transform, summit: Vec3) -> f32 {
    let mut app = engine.app();
    engine.fixed(&mut app, form, at);
    let patch = patch(&mut app, summit + Vec3::Y * 0.1);
    run(&mut app, 30);
    place(&app, patch, 12).y - summit.y
}

fn assert_lies_on(form: &Form, at: Transform, summit: Vec3) {
    for engine in BOTH {
        let height = height_above(engine, form, at, summit);
        assert!((height - KEPT).abs() < 2e-3, "{engine:?}, {form:?}: {height} m above");
    }
}

#[test]
fn a_patch_lies_on_every_solid() {
    let place = Vec3::new(0.3, 0.2, -0.4);
    let upright = Transform::from_translation(place);
    assert_lies_on(&Form::Ball(0.4), upright, place + Vec3::Y * 0.4);
    assert_lies_on(&Form::Cuboid(Vec3::new(0.2, 0.3, 0.2)), upright, place + Vec3::Y * 0.3);
    assert_lies_on(&Form::Cylinder(0.5, 0.2), upright, place + Vec3::Y * 0.25);
    assert_lies_on(&Form::HalfSpace(Vec3::Y), upright, place);
    let (a, b) = (Vec3::new(-0.3, 0.2, 0.0), Vec3::new(0.3, 0.2, 0.0));
    assert_lies_on(&Form::Capsule(a, b, 0.1), upright, place + Vec3::Y * 0.3);
    let turned = upright.with_rotation(Quat::from_rotation_x(FRAC_PI_2));
    assert_lies_on(&Form::Cylinder(0.5, 0.2), turned, place + Vec3::Y * 0.2);
    let on_its_side = Quat::from_rotation_z(FRAC_PI_2);
    assert_lies_on(&Form::Cuboid(Vec3::new(0.3, 0.2, 0.2)), upright.with_rotation(on_its_side), place + Vec3::Y * 0.3);
    let head_down = upright.with_rotation(Quat::from_rotation_x(2.0 * FRAC_PI_2));
    assert_lies_on(&Form::Cone(0.4, 0.3), head_down, place + Vec3::Y * 0.2);
}

#[test]
fn a_patch_lies_on_meshes_and_hulls() {
    let place = Vec3::new(0.3, 0.2, -0.4);
    let upright = Transform::from_translation(place);
    let square = [(-0.3, -0.3), (0.3, -0.3), (0.3, 0.3), (-0.3, 0.3)].map(|(x, z)| Vec3::new(x, 0.1, z));
    assert_lies_on(&Form::Mesh(square.to_vec(), vec![[0, 2, 1], [0, 3, 2]]), upright, place + Vec3::Y * 0.1);
    let block = square.into_iter().flat_map(|corner| [corner, corner - Vec3::Y * 0.4]).collect();
    assert_lies_on(&Form::Hull(block), upright, place + Vec3::Y * 0.1);
}

#[test]
fn rounding_adds_to_the_size() {
    assert_lies_on(&Form::RoundCuboid(Vec3::splat(0.2), 0.1), Transform::default(), Vec3::Y * 0.3);
}

#[test]
fn scales_apply() {
    let place = Vec3::new(0.3, 0.2, -0.4);
    let scaled = Transform::from_translation(place).with_scale(Vec3::new(1.0, 3.0, 1.0));
    assert_lies_on(&Form::Cuboid(Vec3::new(0.2, 0.1, 0.2)), scaled, place + Vec3::Y * 0.3);
    let doubled = Transform::from_translation(place).with_scale(Vec3::splat(2.0));
    assert_lies_on(&Form::Ball(0.2), doubled, place + Vec3::Y * 0.4);
}

#[test]
fn parts_of_a_compound_are_at_their_places() {
    let form = Form::Compound(vec![
        (Vec3::new(-0.5, 0.0, 0.0), Form::Ball(0.3)),
        (Vec3::new(0.5, 0.4, 0.0), Form::Cuboid(Vec3::splat(0.2))),
    ]);
    let at = Transform::from_xyz(0.0, 1.0, 0.0);
    assert_lies_on(&form, at, Vec3::new(-0.5, 1.3, 0.0));
    assert_lies_on(&form, at, Vec3::new(0.5, 1.6, 0.0));
}

#[test]
fn a_child_collider_is_at_its_place_in_its_body() {
    for engine in BOTH {
        let mut app = engine.app();
        let lying = Transform::from_xyz(0.0, 1.0, 0.0).with_rotation(Quat::from_rotation_z(FRAC_PI_4));
        let body = engine.fixed(&mut app, &Form::Ball(0.1), lying);
        let out = Transform::from_xyz(2.0, 0.0, 0.0);
        let child = app.world_mut().spawn((out, ChildOf(body))).id();
        engine.insert(&mut app, child, &Form::Ball(0.2));
        let summit = Vec3::new(2.0 * FRAC_1_SQRT_2, 1.0 + 2.0 * FRAC_1_SQRT_2 + 0.2, 0.0);
        let patch = patch(&mut app, summit + Vec3::Y * 0.1);
        run(&mut app, 30);
        let height = place(&app, patch, 12).y - summit.y;
        assert!((height - KEPT).abs() < 2e-3, "{engine:?}: {height} m above");
    }
}

#[test]
fn a_body_that_its_user_moves_pushes_cloth() {
    for engine in BOTH {
        let mut app = engine.app();
        let ball = engine.fixed(&mut app, &Form::Ball(0.2), Transform::from_xyz(0.0, 1.0, 0.0));
        let cloth = Cloth { gravity_scale: 0.0, substeps: Some(16), ..default() };
        let cloth = spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 17, 17).lying(), (cloth, undamped()));
        run(&mut app, 2);
        for _ in 0..12 {
            get_mut::<Transform>(&mut app, ball).translation.y -= 10.0 / 60.0;
            run(&mut app, 1);
        }
        let bottom = get::<Transform>(&app, ball).translation.y - 0.2;
        let lowest = positions(&app, cloth).into_iter().map(|place| place.y).fold(f32::MAX, f32::min);
        assert!(lowest <= bottom, "{engine:?}: {lowest} over {bottom}");
    }
}

#[test]
fn a_collider_that_is_despawned_is_no_obstacle_any_more() {
    for engine in BOTH {
        let mut app = engine.app();
        let ground = engine.fixed(&mut app, &Form::HalfSpace(Vec3::Y), Transform::default());
        let patch = patch(&mut app, Vec3::Y * 0.05);
        run(&mut app, 30);
        assert!(place(&app, patch, 12).y > 0.0, "{engine:?}");
        app.world_mut().despawn(ground);
        run(&mut app, 30);
        assert!(place(&app, patch, 12).y < -0.5, "{engine:?}");
    }
}
