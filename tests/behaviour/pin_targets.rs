//! Pinned vertices stay with what they are pinned to; the others are free.

use core::f32::consts::FRAC_PI_2;

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::common::*;

const GRID: ClothGrid = ClothGrid { size: Vec2::new(1.0, 1.0), particles: UVec2::new(5, 5), lying: false };
/// The top left corner, which all tests pin.
const CORNER: u32 = 0;
const CORNER_AT: Vec3 = Vec3::new(-0.5, 0.5, 0.0);

fn moved() -> Transform {
    Transform::from_xyz(0.3, -0.2, 0.1).with_rotation(Quat::from_euler(EulerRot::XYZ, 0.2, FRAC_PI_2, -0.4))
}

fn corner() -> Pins {
    Pins::indices([CORNER])
}

#[test]
fn a_pin_to_the_world_stays_while_the_entity_moves() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, GRID, corner().to_world());
    run(&mut app, 5);
    *get_mut::<Transform>(&mut app, cloth) = moved();
    run(&mut app, 5);
    assert_eq!(place(&app, cloth, CORNER), CORNER_AT);
}

#[test]
fn a_pin_to_the_cloth_follows_its_entity() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, GRID, corner());
    run(&mut app, 5);
    assert_eq!(place(&app, cloth, CORNER), CORNER_AT);
    for step in 1..=5 {
        let pose = Transform::from_rotation(Quat::from_rotation_y(0.1 * step as f32)).with_translation(Vec3::X);
        *get_mut::<Transform>(&mut app, cloth) = pose;
        run(&mut app, 1);
        assert_close(place(&app, cloth, CORNER), pose * CORNER_AT, 1e-6);
    }
}

#[test]
fn a_pin_to_an_entity_follows_how_it_moves_and_turns() {
    let mut app = headless();
    let start = Transform::from_xyz(1.0, 2.0, 3.0).with_rotation(Quat::from_rotation_z(0.7));
    let pole = app.world_mut().spawn(start).id();
    let cloth = spawn_cloth(&mut app, GRID, corner().to_entity(pole));
    run(&mut app, 5);
    assert_close(place(&app, cloth, CORNER), CORNER_AT, 1e-6);
    *get_mut::<Transform>(&mut app, pole) = moved();
    run(&mut app, 1);
    let expected = moved().to_matrix() * start.to_matrix().inverse();
    assert_close(place(&app, cloth, CORNER), expected.transform_point3(CORNER_AT), 1e-6);
}

#[test]
fn a_target_that_is_a_child_is_followed_without_a_frame_of_delay() {
    let mut app = headless();
    let hand = app.world_mut().spawn(Transform::from_xyz(0.0, 1.0, 0.0)).id();
    let arm = app.world_mut().spawn(Transform::default()).add_child(hand).id();
    let cloth = spawn_cloth(&mut app, GRID, corner().to_entity(hand));
    run(&mut app, 2);
    get_mut::<Transform>(&mut app, arm).rotation = Quat::from_rotation_z(FRAC_PI_2);
    run(&mut app, 1);
    assert_close(place(&app, cloth, CORNER), Vec3::new(-0.5, -0.5, 0.0), 1e-6);
}

#[test]
fn a_pin_stays_where_it_is_when_its_target_is_despawned() {
    let mut app = headless();
    let pole = app.world_mut().spawn(Transform::default()).id();
    let cloth = spawn_cloth(&mut app, GRID, corner().to_entity(pole));
    run(&mut app, 5);
    *get_mut::<Transform>(&mut app, pole) = moved();
    run(&mut app, 1);
    app.world_mut().despawn(pole);
    run(&mut app, 30);
    assert_close(place(&app, cloth, CORNER), moved() * CORNER_AT, 1e-6);
    assert_eq!(state(&app, cloth).velocity(0), Some(Vec3::ZERO));
}

#[test]
fn a_pin_to_no_entity_stays_where_it_is() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, GRID, corner().to(PinTarget::Entity(None)));
    run(&mut app, 10);
    assert_eq!(place(&app, cloth, CORNER), CORNER_AT);
}

#[test]
fn a_pinned_vertex_has_the_velocity_of_its_pin() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, GRID, corner());
    for step in 0..5 {
        get_mut::<Transform>(&mut app, cloth).translation = Vec3::X * 3.0 * STEP * step as f32;
        run(&mut app, 1);
    }
    assert_close(state(&app, cloth).velocity(0).unwrap(), Vec3::X * 3.0, 1e-3);
}

#[test]
fn a_vertex_that_is_unpinned_falls() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, GRID, (corner(), undamped()));
    run(&mut app, 10);
    *get_mut::<Pins>(&mut app, cloth) = Pins::none();
    run(&mut app, 1);
    let (before, free) = (place(&app, cloth, CORNER), pinned(&app, cloth));
    assert!(free.is_empty());
    run(&mut app, 30);
    assert!(before.y - place(&app, cloth, CORNER).y > 1.0);
}

#[test]
fn a_vertex_that_is_pinned_while_it_moves_is_held_where_it_is() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, GRID, undamped());
    run(&mut app, 20);
    let here = place(&app, cloth, CORNER);
    assert!(here.y < CORNER_AT.y - 0.3);
    *get_mut::<Pins>(&mut app, cloth) = corner();
    run(&mut app, 60);
    assert_close(place(&app, cloth, CORNER), here, 1e-6);
    assert!(place(&app, cloth, 24).y < here.y - 0.8, "the rest hangs from it");
}

#[test]
fn a_vertex_that_keeps_its_target_keeps_its_place_when_others_are_pinned() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, GRID, corner());
    run(&mut app, 10);
    *get_mut::<Transform>(&mut app, cloth) = moved();
    get_mut::<Pins>(&mut app, cloth).groups.extend(Pins::indices([4]).to_world().groups);
    run(&mut app, 1);
    assert_close(place(&app, cloth, CORNER), moved() * CORNER_AT, 1e-6);
    assert_eq!(pinned(&app, cloth), [0, 4]);
}

#[test]
fn a_later_group_overrides_an_earlier_one() {
    let mut app = headless();
    let pins =
        Pins::edge(ClothEdge::Top).and(Pins::indices([1, 2]).to_world()).and(Pins::indices([2, 3]).to(PinTarget::Free));
    let cloth = spawn_cloth(&mut app, GRID, pins);
    run(&mut app, 1);
    assert_eq!(pinned(&app, cloth), [0, 1, 4]);
    get_mut::<Transform>(&mut app, cloth).translation.z = 1.0;
    run(&mut app, 1);
    assert_eq!([0, 1, 4].map(|vertex| place(&app, cloth, vertex).z), [1.0, 0.0, 1.0]);
}

#[test]
fn pins_hold_through_a_change_of_the_fabric() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, GRID, corner());
    run(&mut app, 5);
    get_mut::<Fabric>(&mut app, cloth).density = 3.0;
    run(&mut app, 30);
    assert_eq!(place(&app, cloth, CORNER), CORNER_AT);
    assert_eq!(pinned(&app, cloth), [0]);
}

#[test]
fn a_target_that_gets_its_transform_later_is_followed_from_then_on() {
    let mut app = headless();
    let target = app.world_mut().spawn_empty().id();
    let cloth = spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 4, 4), Pins::edge(ClothEdge::Top).to_entity(target));
    run(&mut app, 5);
    app.world_mut().entity_mut(target).insert(Transform::from_xyz(10.0, 0.0, 0.0));
    run(&mut app, 5);
    assert_close(place(&app, cloth, 0), Vec3::new(-0.5, 0.5, 0.0), 1e-5);
    get_mut::<Transform>(&mut app, target).translation.y += 1.0;
    run(&mut app, 1);
    assert_close(place(&app, cloth, 0), Vec3::new(-0.5, 1.5, 0.0), 1e-5);
}
