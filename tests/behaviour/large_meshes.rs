//! A large mesh becomes cloth beside the frames, which go on meanwhile.

use std::{sync::Arc, thread, time::Duration};

use bevy::{math::Mat3A, prelude::*};
use bevy_drape::{
    build::{tethers, topology_of},
    prelude::*,
    solver::Topology,
};

use crate::common::*;

/// More than is built at once.
const SIDE: u32 = 80;

fn grid(columns: u32, rows: u32) -> Mesh {
    ClothGrid::new(1.0, 1.0, columns, rows).lying().into()
}

fn large() -> Mesh {
    grid(SIDE, SIDE)
}

fn status(app: &App, cloth: Entity) -> ClothStatus {
    get::<ClothStatus>(app, cloth).clone()
}

fn topology(app: &App, cloth: Entity) -> Arc<Topology> {
    state(app, cloth).topology().clone()
}

/// A cloth whose mesh a task has just begun to work on. What it comes to is looked for in the next update.
fn begin(app: &mut App, more: impl Bundle) -> (Entity, Handle<Mesh>) {
    let cloth = spawn_cloth(app, large(), more);
    let mesh = get::<Mesh3d>(app, cloth).0.clone();
    app.update();
    assert_eq!(status(app, cloth), ClothStatus::Building);
    (cloth, mesh)
}

/// Updates the app until `is_done`.
fn update_until(app: &mut App, is_done: impl Fn(&App) -> bool) {
    for _ in 0..10_000 {
        if is_done(app) {
            return;
        }
        app.update();
        thread::sleep(Duration::from_millis(1));
    }
    panic!("it is never done");
}

fn finish(app: &mut App, cloth: Entity) {
    update_until(app, |app| status(app, cloth) != ClothStatus::Building);
}

fn heard(app: &App) -> &Heard {
    app.world().resource()
}

#[test]
fn a_large_mesh_is_drawn_as_it_is_until_it_is_cloth() {
    let mut app = headless();
    let (cloth, mesh) = begin(&mut app, ());
    assert_eq!(get::<Mesh3d>(&app, cloth).0, mesh);
    assert_eq!(points(drawn(&app, cloth)), points(&large()));
    assert_eq!((state(&app, cloth).particle_count(), heard(&app)), (0, &Heard::default()));
    finish(&mut app, cloth);
    assert_eq!(status(&app, cloth), ClothStatus::Ready);
    assert_eq!(*heard(&app), Heard { ready: vec![cloth], ..default() });
    assert_ne!(get::<Mesh3d>(&app, cloth).0, mesh);
    run(&mut app, 20);
    assert!(points(drawn(&app, cloth))[0].y < -0.2);
    assert_eq!(*heard(&app), Heard { ready: vec![cloth], ..default() });
}

#[test]
fn whenever_it_is_done_it_is_the_same_cloth() {
    let moved = |frames_between: u64| {
        let mut app = headless();
        let (cloth, _) = begin(&mut app, Pins::edge_corners(ClothEdge::Top));
        thread::sleep(Duration::from_millis(frames_between));
        finish(&mut app, cloth);
        run(&mut app, 10);
        assert_eq!(*topology(&app, cloth), topology_of(&large(), Mat3A::IDENTITY).unwrap());
        positions(&app, cloth)
    };
    assert_eq!(moved(0), moved(200));
}

#[test]
fn cloths_that_wait_for_one_mesh_wait_for_one_task() {
    let mut app = headless();
    let (first, mesh) = begin(&mut app, ());
    let elsewhere = Transform::from_xyz(3.0, 0.0, 0.0);
    let second = app.world_mut().spawn((Mesh3d(mesh), Cloth::default(), elsewhere)).id();
    finish(&mut app, first);
    assert_eq!(heard(&app).ready, [first, second], "both in the frame in which it is done");
    assert!(Arc::ptr_eq(&topology(&app, first), &topology(&app, second)));
    assert!(place(&app, second, 0).x > 2.0);
}

#[test]
fn what_is_no_longer_cloth_is_not_built() {
    let mut app = headless();
    let despawned = spawn_cloth(&mut app, large(), ());
    let (removed, mesh) = begin(&mut app, ());
    app.world_mut().despawn(despawned);
    app.world_mut().entity_mut(removed).remove::<Cloth>();
    for _ in 0..50 {
        app.update();
        thread::sleep(Duration::from_millis(2));
    }
    assert_eq!(*heard(&app), Heard::default());
    assert_eq!(get::<Mesh3d>(&app, removed).0, mesh);
    assert!(!app.world().entity(removed).contains::<ClothState>());
}

#[test]
fn a_mesh_that_changes_meanwhile_is_built_as_it_is_then() {
    for changed in [grid(SIDE, SIDE + 1), grid(4, 4)] {
        let mut app = headless();
        let (cloth, mesh) = begin(&mut app, ());
        let expected = topology_of(&changed, Mat3A::IDENTITY).unwrap();
        // The task is done by the time that the change is made, which nobody is told of before the frame ends.
        thread::sleep(Duration::from_millis(200));
        *app.world_mut().resource_mut::<Assets<Mesh>>().get_mut(&mesh).unwrap() = changed.clone();
        finish(&mut app, cloth);
        assert_eq!(*topology(&app, cloth), expected);
        run(&mut app, 5);
        assert_eq!(drawn(&app, cloth).count_vertices(), changed.count_vertices());
    }
}

#[test]
fn what_is_set_meanwhile_counts() {
    let mut app = headless();
    let (cloth, _) = begin(&mut app, Pins::edge(ClothEdge::Top));
    let place = Transform::from_xyz(0.0, 5.0, 0.0);
    let settings = Cloth { gravity_scale: 0.0, ..default() };
    app.world_mut().entity_mut(cloth).insert((Pins::indices([0, 7]), place, settings));
    finish(&mut app, cloth);
    assert_eq!(pinned(&app, cloth), [0, 7]);
    run(&mut app, 20);
    assert!(positions(&app, cloth).iter().all(|p| (p.y - 5.0).abs() < 1e-4));
}

#[test]
fn a_large_cloth_has_its_tethers_from_the_first_step_on() {
    let mut app = headless();
    let (cloth, _) = begin(&mut app, Pins::edge_corners(ClothEdge::Top));
    finish(&mut app, cloth);
    let expected = tethers(&topology(&app, cloth), &[0, SIDE - 1]);
    assert!(get::<ClothAttachments>(&app, cloth).tethers().eq(expected.iter()));
}

#[test]
fn pins_that_change_while_tethers_are_made_get_theirs_in_time() {
    let mut app = headless();
    let (cloth, _) = begin(&mut app, Pins::indices([0, SIDE - 1]));
    // By now the particles are there, and their distances to the pins are worked out.
    thread::sleep(Duration::from_millis(200));
    app.update();
    assert_eq!(status(&app, cloth), ClothStatus::Building);
    app.world_mut().entity_mut(cloth).insert(Pins::indices([0, 7]));
    app.world_mut().resource_mut::<Time<Virtual>>().pause();
    finish(&mut app, cloth);
    assert_eq!(pinned(&app, cloth), [0, 7]);
    assert!(get::<ClothAttachments>(&app, cloth).tethers().all(|tether| tether.pin == 0));
    assert!(get::<ClothAttachments>(&app, cloth).tethers().count() > 0);
    app.world_mut().resource_mut::<Time<Virtual>>().unpause();
    run(&mut app, 5);
    let expected = tethers(&topology(&app, cloth), &[0, 7]);
    assert!(get::<ClothAttachments>(&app, cloth).tethers().eq(expected.iter()));
}

#[test]
fn a_cloth_that_turns_all_the_time_is_built_and_turned() {
    let mut app = headless();
    let (cloth, _) = begin(&mut app, Cloth { gravity_scale: 0.0, ..default() });
    let turn = |mut place: Single<&mut Transform, With<Cloth>>| place.rotate_x(0.3);
    app.add_systems(First, turn);
    finish(&mut app, cloth);
    let place_of = get::<Transform>(&app, cloth);
    for vertex in [0, SIDE - 1, SIDE * SIDE - 1] {
        let expected = place_of.transform_point(points(&large())[vertex as usize]);
        assert_close(place(&app, cloth, vertex), expected, 1e-4);
    }
}

#[test]
fn a_scale_that_changes_meanwhile_is_the_one_that_counts() {
    let mut app = headless();
    let (cloth, _) = begin(&mut app, ());
    get_mut::<Transform>(&mut app, cloth).scale = Vec3::splat(3.0);
    finish(&mut app, cloth);
    assert_eq!(*topology(&app, cloth), topology_of(&large(), Mat3A::from_diagonal(Vec3::splat(3.0))).unwrap());
}

#[test]
fn the_old_cloth_goes_on_until_the_new_one_is_done() {
    let mut app = headless();
    let (cloth, mesh) = begin(&mut app, ());
    finish(&mut app, cloth);
    let change = |app: &mut App| {
        *app.world_mut().resource_mut::<Assets<Mesh>>().get_mut(&mesh).unwrap() = grid(SIDE, SIDE + 1);
        // The change is known a frame later.
        app.update();
    };
    let replace = |app: &mut App| {
        let mesh = add_mesh(app, grid(SIDE, SIDE + 2));
        app.world_mut().entity_mut(cloth).insert(Mesh3d(mesh));
    };
    let reset = |app: &mut App| command(app, cloth, |cloth| cloth.reset_cloth());
    let cases: [(&dyn Fn(&mut App), u32, ResetCause); 3] = [
        (&change, SIDE * (SIDE + 1), ResetCause::Rebuilt),
        (&replace, SIDE * (SIDE + 2), ResetCause::Rebuilt),
        (&reset, SIDE * (SIDE + 2), ResetCause::Requested),
    ];
    for (case, (make, particles, cause)) in cases.into_iter().enumerate() {
        run(&mut app, 20);
        make(&mut app);
        let (old, before) = (topology(&app, cloth), place(&app, cloth, 0));
        app.update();
        assert_eq!(status(&app, cloth), ClothStatus::Ready);
        assert!(Arc::ptr_eq(&topology(&app, cloth), &old));
        assert!(place(&app, cloth, 0).y < before.y, "it falls on");
        update_until(&mut app, |app| heard(app).reset.len() > case);
        assert_eq!(heard(&app).reset[case..], [(cloth, cause)]);
        assert_eq!(state(&app, cloth).particle_count(), particles as usize);
        assert!(place(&app, cloth, 0).y > before.y, "it begins anew");
    }
    run(&mut app, 20);
    assert_eq!((heard(&app).reset.len(), heard(&app).ready.len()), (3, 1));
}

#[test]
fn an_error_is_told_once_and_mended_later() {
    let mut app = headless();
    let mut broken = large();
    let mut places = points(&broken);
    places[77].x = f32::NAN;
    broken.insert_attribute(Mesh::ATTRIBUTE_POSITION, places);
    let cloth = spawn_cloth(&mut app, broken, ());
    app.update();
    finish(&mut app, cloth);
    let error: ClothError = MeshError::PositionNotFinite { vertex: 77 }.into();
    assert_eq!(status(&app, cloth), ClothStatus::Failed(error.clone()));
    for _ in 0..20 {
        get_mut::<Fabric>(&mut app, cloth).set_changed();
        app.update();
        thread::sleep(Duration::from_millis(5));
        assert_eq!(status(&app, cloth), ClothStatus::Failed(error.clone()));
    }
    assert_eq!(heard(&app).failed, [(cloth, error)]);
    let mesh = get::<Mesh3d>(&app, cloth).0.clone();
    *app.world_mut().resource_mut::<Assets<Mesh>>().get_mut(&mesh).unwrap() = large();
    update_until(&mut app, |app| status(app, cloth) == ClothStatus::Ready);
    assert_eq!(heard(&app).ready, [cloth]);
}
