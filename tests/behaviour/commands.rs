//! What a game may ask of a cloth.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::common::*;

const GRID: ClothGrid = ClothGrid { size: Vec2::ONE, particles: UVec2::new(6, 6), lying: false };

fn rest() -> Vec<Vec3> {
    points(&GRID.into())
}

#[test]
fn a_reset_puts_the_cloth_back_at_rest() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, GRID, Pins::corners());
    run(&mut app, 40);
    let pose = Transform::from_xyz(3.0, 0.0, 0.0).with_scale(Vec3::splat(2.0));
    *get_mut::<Transform>(&mut app, cloth) = pose;
    *get_mut::<Cloth>(&mut app, cloth) = Cloth { gravity_scale: 0.0, ..default() };
    command(&mut app, cloth, |cloth| cloth.reset_cloth());
    run(&mut app, 2);
    for ((now, velocity), rest) in positions(&app, cloth).into_iter().zip(state(&app, cloth).velocities()).zip(rest()) {
        assert_close(now, pose * rest, 1e-5);
        assert_close(velocity, Vec3::ZERO, 1e-3);
    }
    assert_eq!(pinned(&app, cloth), [0, 5, 30, 35]);
    for (shown, rest) in points(drawn(&app, cloth)).into_iter().zip(rest()) {
        assert_close(shown, rest, 1e-5);
    }
    assert_eq!(app.world().resource::<Heard>().reset, [(cloth, ResetCause::Requested)]);
}

#[test]
fn a_reset_of_a_cloth_that_is_not_ready_yet_changes_nothing() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, GRID, Pins::corners());
    command(&mut app, cloth, |cloth| cloth.reset_cloth());
    run(&mut app, 3);
    assert_eq!(*app.world().resource::<Heard>(), Heard { ready: vec![cloth], ..default() });
}

#[test]
fn vertices_are_pinned_and_unpinned() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, GRID, (Pins::edge(ClothEdge::Top), undamped()));
    run(&mut app, 20);
    let low = place(&app, cloth, 32);
    command(&mut app, cloth, |cloth| cloth.pin_cloth(Pins::indices([32]).to_world()));
    run(&mut app, 10);
    assert_eq!(place(&app, cloth, 32), low);
    command(&mut app, cloth, |cloth| cloth.unpin_cloth(Pins::edge(ClothEdge::Top)));
    run(&mut app, 60);
    assert_eq!(pinned(&app, cloth), [32]);
    assert_eq!(place(&app, cloth, 32), low);
    assert!(place(&app, cloth, 2).y < low.y, "the cloth hangs from its lower edge");
    command(&mut app, cloth, |cloth| cloth.unpin_cloth(Pins::indices([32])));
    run(&mut app, 1);
    assert!(pinned(&app, cloth).is_empty());
}

/// A cloth that swings from three kinds of pins.
fn swinging() -> (App, Entity) {
    let mut app = headless();
    let pins = Pins::indices([0]).and(Pins::indices([5]).to_world());
    let cloth = spawn_cloth(&mut app, GRID, (pins, Transform::from_xyz(1.0, 2.0, 3.0)));
    run(&mut app, 20);
    (app, cloth)
}

fn teleport(app: &mut App, cloth: Entity, to: Transform) {
    command(app, cloth, |cloth| cloth.teleport_cloth(to));
}

#[test]
fn a_teleported_cloth_goes_on_as_if_the_world_had_moved() {
    // Turned about the vertical, so that gravity stays the same.
    let to = Transform::from_xyz(707.0, -30.0, 707.0).with_rotation(Quat::from_rotation_y(1.1));
    let (mut stayed, one) = swinging();
    let (mut moved, other) = swinging();
    let carry = to.to_matrix() * get::<Transform>(&stayed, one).to_matrix().inverse();
    teleport(&mut moved, other, to);
    for frames in [1, 1, 28] {
        run(&mut stayed, frames);
        run(&mut moved, frames);
        for (here, there) in positions(&stayed, one).into_iter().zip(positions(&moved, other)) {
            assert_close(carry.transform_point3(here), there, 1e-3);
        }
        for (here, there) in state(&stayed, one).velocities().zip(state(&moved, other).velocities()) {
            assert_close(carry.transform_vector3(here), there, 1e-2);
        }
        for (here, there) in points(drawn(&stayed, one)).into_iter().zip(points(drawn(&moved, other))) {
            assert_close(here, there, 1e-3);
        }
    }
}

#[test]
fn a_teleport_stretches_nothing() {
    let (mut app, cloth) = swinging();
    let longest = |app: &App| {
        let state = state(app, cloth);
        let places: Vec<Vec3> = state.positions().collect();
        let strain = |s: &bevy_drape::solver::Spring| places[s.a as usize].distance(places[s.b as usize]) / s.rest;
        state.topology().springs.iter().map(strain).fold(0.0, f32::max)
    };
    let before = longest(&app);
    let upside_down = Quat::from_euler(EulerRot::XYZ, 2.0, 0.4, 1.0);
    teleport(&mut app, cloth, Transform::from_xyz(-1000.0, 0.0, 0.0).with_rotation(upside_down));
    run(&mut app, 1);
    assert!(longest(&app) < before + 0.02, "{} before, {} after", before, longest(&app));
}

#[test]
fn a_pin_to_another_entity_is_left_behind_by_a_teleport() {
    let mut app = headless();
    let pole = app.world_mut().spawn(Transform::default()).id();
    let cloth = spawn_cloth(&mut app, GRID, Pins::indices([0]).to_entity(pole));
    run(&mut app, 5);
    teleport(&mut app, cloth, Transform::from_xyz(0.1, 0.0, 0.0));
    run(&mut app, 1);
    assert_close(place(&app, cloth, 0), rest()[0], 1e-6);
}

#[test]
fn commands_for_what_is_no_cloth_do_nothing() {
    let mut app = headless();
    let stone = app.world_mut().spawn(Transform::from_xyz(1.0, 2.0, 3.0)).id();
    let gone = app.world_mut().spawn_empty().id();
    app.world_mut().despawn(gone);
    for entity in [stone, gone] {
        command(&mut app, entity, |entity| {
            entity.reset_cloth().pin_cloth(Pins::corners()).unpin_cloth(Pins::corners())
        });
    }
    run(&mut app, 2);
    assert_eq!(*get::<Transform>(&app, stone), Transform::from_xyz(1.0, 2.0, 3.0));
    assert!(!app.world().entity(stone).contains::<Pins>());
}

#[test]
fn a_teleport_moves_whatever_it_is_asked_of() {
    let mut app = headless();
    let stone = app.world_mut().spawn(Transform::from_xyz(1.0, 2.0, 3.0)).id();
    let [bare, gone] = [(); 2].map(|()| app.world_mut().spawn_empty().id());
    app.world_mut().despawn(gone);
    for entity in [stone, bare, gone] {
        command(&mut app, entity, |entity| entity.teleport_cloth(Transform::from_xyz(4.0, 0.0, 0.0)));
        command(&mut app, entity, |entity| entity.teleport_collider(Transform::from_xyz(5.0, 0.0, 0.0)));
    }
    run(&mut app, 2);
    assert_eq!(*get::<Transform>(&app, stone), Transform::from_xyz(5.0, 0.0, 0.0));
    assert!(!app.world().entity(bare).contains::<Transform>());
}

#[test]
fn a_teleport_is_seen_in_the_frame_in_which_it_is_asked_for() {
    let (mut app, cloth) = swinging();
    // Two updates a step, and the first of them without one.
    set_rates(&mut app, 1.0 / 60.0, 1.0 / 30.0);
    run(&mut app, 2);
    let before = points(drawn(&app, cloth));
    teleport(&mut app, cloth, Transform::from_xyz(500.0, 0.0, 0.0).with_rotation(Quat::from_rotation_y(2.0)));
    for _ in 0..3 {
        run(&mut app, 1);
        for (now, before) in points(drawn(&app, cloth)).into_iter().zip(&before) {
            assert_close(now, *before, 0.2);
        }
    }
}
