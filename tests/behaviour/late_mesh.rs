//! A mesh may come late or not at all, and a cloth may come with its entity from elsewhere.

use std::{thread, time::Duration};

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
fn a_cloth_waits_for_its_mesh() {
    let mut app = headless();
    let handle = meshes(&mut app).reserve_handle();
    let cloth = app.world_mut().spawn((Mesh3d(handle.clone()), Cloth::default(), Pins::corners())).id();
    run(&mut app, 5);
    assert_eq!(*get::<ClothStatus>(&app, cloth), ClothStatus::Waiting);
    assert_eq!(state(&app, cloth).particle_count(), 0);
    meshes(&mut app).insert(&handle, grid(5)).unwrap();
    run(&mut app, 1);
    assert_eq!(*get::<ClothStatus>(&app, cloth), ClothStatus::Ready);
    assert_eq!(pinned(&app, cloth), [0, 4, 15, 19]);
    assert_eq!(*app.world().resource::<Heard>(), Heard { ready: vec![cloth], ..default() });
}

#[test]
fn a_cloth_waits_for_its_mesh_component() {
    let mut app = headless();
    let cloth = app.world_mut().spawn(Cloth::default()).id();
    run(&mut app, 3);
    assert_eq!(*get::<ClothStatus>(&app, cloth), ClothStatus::Waiting);
    let mesh = add_mesh(&mut app, grid(5));
    app.world_mut().entity_mut(cloth).insert(Mesh3d(mesh));
    run(&mut app, 1);
    assert_eq!(*get::<ClothStatus>(&app, cloth), ClothStatus::Ready);
}

#[test]
fn a_mesh_that_fails_to_load_fails_the_cloth_until_it_is_there() {
    let mut app = headless();
    let handle = app.world().resource::<AssetServer>().load("no such file.mesh");
    let cloth = app.world_mut().spawn((Mesh3d(handle), Cloth::default())).id();
    for _ in 0..1000 {
        app.update();
        if *get::<ClothStatus>(&app, cloth) != ClothStatus::Waiting {
            break;
        }
        thread::sleep(Duration::from_millis(2));
    }
    let status = get::<ClothStatus>(&app, cloth);
    assert!(matches!(status, ClothStatus::Failed(ClothError::NotLoaded { .. })), "{status:?}");
    run(&mut app, 3);
    assert_eq!(app.world().resource::<Heard>().failed.len(), 1);

    let handle = get::<Mesh3d>(&app, cloth).0.clone();
    meshes(&mut app).insert(&handle, grid(5)).unwrap();
    run(&mut app, 2);
    assert_eq!(*get::<ClothStatus>(&app, cloth), ClothStatus::Ready);
}

#[test]
fn a_copy_of_a_cloth_is_a_cloth_of_its_own() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, grid(5), (Pins::corners(), Fabric { density: 0.7, ..default() }));
    run(&mut app, 20);
    let copy = app.world_mut().entity_mut(cloth).clone_and_spawn();
    command(&mut app, copy, |copy| copy.unpin_cloth(Pins::corners()));
    run(&mut app, 30);
    assert_eq!(*get::<ClothStatus>(&app, copy), ClothStatus::Ready);
    assert_eq!(get::<Fabric>(&app, copy).density, 0.7);
    assert_ne!(get::<Mesh3d>(&app, copy), get::<Mesh3d>(&app, cloth));
    assert!(points(drawn(&app, copy))[0].y < -0.2);
    assert_eq!(points(drawn(&app, cloth))[0].y, 0.5);
    let rest = |cloth| state(&app, cloth).topology().springs[7].rest;
    assert_eq!(rest(copy), rest(cloth), "it starts from the rest shape");
}

#[test]
fn a_status_that_comes_from_elsewhere_is_made_true() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, grid(5), ClothStatus::Ready);
    run(&mut app, 30);
    assert_eq!(state(&app, cloth).particle_count(), 20);
    assert!(points(drawn(&app, cloth))[0].y < -0.5);
}
