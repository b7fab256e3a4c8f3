//! A running cloth's mesh may be changed or replaced.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::common::*;

fn grid(columns: u32) -> Mesh {
    ClothGrid::new(1.0, 1.0, columns, 4).into()
}

fn meshes(app: &mut App) -> Mut<'_, Assets<Mesh>> {
    app.world_mut().resource_mut()
}

#[test]
fn another_mesh_makes_another_cloth() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, grid(5), Pins::corners());
    run(&mut app, 10);
    let mesh = add_mesh(&mut app, grid(7));
    app.world_mut().entity_mut(cloth).insert(Mesh3d(mesh.clone()));
    run(&mut app, 1);
    assert_eq!(state(&app, cloth).particle_count(), 28);
    assert_eq!(drawn(&app, cloth).count_vertices(), 28);
    assert_ne!(get::<Mesh3d>(&app, cloth).0, mesh, "the mesh itself isn't drawn");
    assert_eq!(pinned(&app, cloth), [0, 6, 21, 27]);
    run(&mut app, 3);
    assert_eq!(app.world().resource::<Heard>().reset, [(cloth, ResetCause::Rebuilt)]);
}

#[test]
fn a_mesh_that_is_changed_is_built_anew() {
    let mut app = headless();
    let handle = add_mesh(&mut app, grid(5));
    let spawn = |app: &mut App| app.world_mut().spawn((Mesh3d(handle.clone()), Cloth::default())).id();
    let cloths = [spawn(&mut app), spawn(&mut app)];
    run(&mut app, 10);
    *meshes(&mut app).get_mut(&handle).unwrap() = grid(6);
    run(&mut app, 5);
    for cloth in cloths {
        assert_eq!(state(&app, cloth).particle_count(), 24);
        assert_eq!(drawn(&app, cloth).count_vertices(), 24);
    }
    let reset = &app.world().resource::<Heard>().reset;
    assert_eq!(reset.len(), 2);
    assert!(cloths.iter().all(|&cloth| reset.contains(&(cloth, ResetCause::Rebuilt))));
}

#[test]
fn pins_may_change_in_the_frame_in_which_the_mesh_does() {
    let mut app = headless();
    let handle = add_mesh(&mut app, grid(5));
    let cloth = app.world_mut().spawn((Mesh3d(handle.clone()), Cloth::default())).id();
    run(&mut app, 2);
    // In a fixed schedule the cloth steps once more before the change of the mesh is known.
    let change = move |mut done: Local<bool>, mut meshes: ResMut<Assets<Mesh>>, mut pins: Single<&mut Pins>| {
        if !core::mem::replace(&mut *done, true) {
            *meshes.get_mut(&handle).unwrap() = grid(9);
            **pins = Pins::edge(ClothEdge::Bottom);
        }
    };
    app.add_systems(FixedUpdate, change);
    run(&mut app, 3);
    assert_eq!(pinned(&app, cloth), (27..36).collect::<Vec<_>>());
}

#[test]
fn a_mesh_that_is_removed_leaves_the_cloth_running() {
    let mut app = headless();
    let handle = add_mesh(&mut app, grid(5));
    let cloth = app.world_mut().spawn((Mesh3d(handle.clone()), Cloth::default())).id();
    run(&mut app, 2);
    let before = place(&app, cloth, 0);
    meshes(&mut app).remove(&handle);
    run(&mut app, 30);
    assert!(place(&app, cloth, 0).y < before.y - 0.5);
}

#[test]
fn a_mesh_that_turns_bad_stops_the_cloth_until_it_is_mended() {
    let mut app = headless();
    let handle = add_mesh(&mut app, grid(5));
    let cloth = app.world_mut().spawn((Mesh3d(handle.clone()), Cloth::default())).id();
    run(&mut app, 5);
    *meshes(&mut app).get_mut(&handle).unwrap() = Polyline3d::new([Vec3::ZERO, Vec3::X]).into();
    run(&mut app, 5);
    let error = ClothError::NotTriangles { topology: "LineList".into() };
    assert_eq!(*get::<ClothStatus>(&app, cloth), ClothStatus::Failed(error.clone()));
    *meshes(&mut app).get_mut(&handle).unwrap() = grid(6);
    run(&mut app, 5);
    assert_eq!(state(&app, cloth).particle_count(), 24);
    let expected = Heard { ready: vec![cloth; 2], failed: vec![(cloth, error)], ..default() };
    assert_eq!(*app.world().resource::<Heard>(), expected);
}

#[test]
fn a_mesh_that_is_put_in_again_is_drawn_as_cloth_again() {
    let mut app = headless();
    let handle = add_mesh(&mut app, grid(5));
    let cloth = app.world_mut().spawn((Mesh3d(handle.clone()), Cloth::default())).id();
    run(&mut app, 5);
    app.world_mut().entity_mut(cloth).insert(Mesh3d(handle.clone()));
    run(&mut app, 30);
    assert_ne!(get::<Mesh3d>(&app, cloth).0, handle);
    assert!(points(drawn(&app, cloth))[0].y < -0.5);
    assert_eq!(app.world().resource::<Heard>().reset, [(cloth, ResetCause::Rebuilt)]);
}

#[test]
fn a_cloth_made_before_the_change_is_announced_is_made_from_what_the_mesh_is_by_then() {
    let mut app = headless();
    let handle = add_mesh(&mut app, grid(9));
    let first = app.world_mut().spawn((Mesh3d(handle.clone()), Cloth::default())).id();
    run(&mut app, 2);
    *meshes(&mut app).get_mut(&handle).unwrap() = grid(4);
    let second = app.world_mut().spawn((Mesh3d(handle), Cloth::default())).id();
    run(&mut app, 3);
    for cloth in [first, second] {
        assert_eq!(state(&app, cloth).particle_count(), 16);
        assert_eq!(points(drawn(&app, cloth)).len(), 16);
    }
}

#[test]
fn a_cloth_given_anothers_drawn_mesh_is_made_from_what_that_was_made_from() {
    let mut app = headless();
    let first = spawn_cloth(&mut app, grid(5), Cloth::default());
    run(&mut app, 20);
    let handle = get::<Mesh3d>(&app, first).0.clone();
    let second = app.world_mut().spawn((Mesh3d(handle), Cloth::default())).id();
    run(&mut app, 20);
    assert_ne!(get::<Mesh3d>(&app, first), get::<Mesh3d>(&app, second));
    assert_eq!(state(&app, first).topology().springs, state(&app, second).topology().springs);
    assert_eq!(app.world().resource::<Heard>().reset, []);
}

#[test]
fn a_cloth_removed_and_added_again_is_made_once() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, grid(5), Cloth::default());
    run(&mut app, 5);
    app.world_mut().entity_mut(cloth).remove::<Cloth>();
    app.world_mut().entity_mut(cloth).insert(Cloth::default());
    run(&mut app, 5);
    assert_eq!(app.world().resource::<Heard>().ready, [cloth, cloth]);
    assert_eq!(app.world().resource::<Heard>().reset, []);
}
