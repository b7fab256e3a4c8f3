//! Pins, grabs, normals and bounds are marked where they are drawn.

use bevy::prelude::*;
use bevy_drape::{debug::*, prelude::*};

use super::*;

fn askew() -> Transform {
    Transform::from_xyz(1.0, 2.0, 3.0).with_rotation(Quat::from_euler(EulerRot::XYZ, 0.3, 0.8, -0.5))
}

#[test]
fn each_pin_has_a_cross_in_the_colour_of_its_target() {
    let mut app = inside();
    let pole = app.world_mut().spawn_empty().insert(Transform::default()).id();
    let pins = Pins::indices([0]).and(Pins::indices([4]).to_world()).and(Pins::indices([20]).to_entity(pole));
    let pins = Pins { groups: pins.groups.into_iter().rev().collect() };
    let view = ClothDebugView { pins: true, mark_size: 0.02, ..default() };
    let cloth = spawn_sheet(&mut app, (pins, view, askew()));
    run(&mut app, 5);
    let (lines, places) = (lines(&app), shown(&app, cloth));
    assert_eq!(lines.len(), 9);
    for (cross, vertex) in lines.chunks(3).zip([0, 4, 20]) {
        for line in cross {
            assert_close((line.from + line.to) / 2.0, places[vertex], 1e-6);
            assert!((line.way().length() - 0.04).abs() < 1e-5);
        }
    }
    let [of_cloth, of_world, of_entity] = [lines[0], lines[3], lines[6]].map(|line| line.color);
    assert!(of_cloth.green > 0.9 && of_cloth.red < 0.1 && of_cloth.blue < 0.2, "{of_cloth:?}");
    assert!(of_world.blue > 0.9 && of_world.red < 0.2, "{of_world:?}");
    assert!(of_entity.red > 0.9 && of_entity.blue > 0.7 && of_entity.green < 0.1, "{of_entity:?}");
}

#[test]
fn normals_are_those_of_the_cloth_under_any_transform() {
    for scale in [Vec3::ONE, Vec3::new(0.5, 2.0, 1.5), Vec3::new(-1.0, 1.0, 2.0)] {
        let mut app = inside();
        let view = ClothDebugView { normals: true, normal_length: 0.2, ..default() };
        let cloth = spawn_sheet(&mut app, (Pins::indices([0, 17]), view, askew().with_scale(scale)));
        run(&mut app, 40);
        let (lines, normals) = (lines(&app), state(&app, cloth).normals());
        assert!(normals.iter().any(|normal| normal.angle_between(normals[0]) > 0.2), "the sheet is bent");
        assert_eq!(lines.len(), 25);
        for ((line, place), normal) in lines.into_iter().zip(shown(&app, cloth)).zip(normals) {
            assert_close(line.from, place, 1e-5);
            assert_close(line.way(), normal * 0.2, 1e-4);
        }
    }
}

#[test]
fn a_held_point_has_a_mark_and_a_line_to_where_it_is_led() {
    let mut app = inside();
    let view = ClothDebugView { grabs: true, mark_size: 0.02, ..default() };
    let cloth = spawn_sheet(&mut app, (Pins::corners(), view));
    run(&mut app, 1);
    assert_eq!(lines(&app), [], "nothing is held");
    let target = Vec3::new(0.0, 0.1, 0.5);
    let point = state(&app, cloth).nearest_point(Vec3::new(0.1, 0.05, 0.0)).unwrap();
    let grab = take_hold(&mut app, cloth, point, ClothGrip::default()).unwrap();
    assert!(lead(&mut app, cloth, grab, target));
    run(&mut app, 5);
    let held = state(&app, cloth).point_position(point).unwrap();
    let lines = lines(&app);
    let (lead, mark) = lines.split_first().unwrap();
    assert_close(lead.from, held, 1e-5);
    assert_eq!(lead.to, target);
    assert!(lead.way().length() > 0.01, "it is still on its way");
    assert!(!mark.is_empty() && mark.iter().all(|line| (line.from.distance(held) - 0.02).abs() < 1e-5));
}

#[test]
fn the_box_is_the_one_that_bevy_culls_by() {
    let mut app = inside();
    let view = ClothDebugView { bounds: true, ..default() };
    let cloth = spawn_sheet(&mut app, (Pins::indices([0]), view, askew().with_scale(Vec3::new(1.0, 2.0, -1.0))));
    run(&mut app, 30);
    let bounds = drawn(&app, cloth).final_aabb.unwrap();
    let transform = get::<GlobalTransform>(&app, cloth);
    let corners: Vec<Vec3> = (0..8)
        .map(|i| Vec3::select(BVec3::new(i & 1 > 0, i & 2 > 0, i & 4 > 0), bounds.min.into(), bounds.max.into()))
        .map(|corner| transform.transform_point(corner))
        .collect();
    let lines = lines(&app);
    assert_eq!(lines.len(), 12);
    for corner in corners {
        let touching = lines.iter().filter(|line| line.from.distance(corner).min(line.to.distance(corner)) < 1e-5);
        assert_eq!(touching.count(), 3, "{corner}");
    }
}
