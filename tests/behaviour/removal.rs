//! Cloths, and all that they know of, may go at any time.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::common::*;

const GRID: ClothGrid = ClothGrid { size: Vec2::ONE, particles: UVec2::new(6, 6), lying: false };

#[test]
fn a_cloth_that_is_removed_leaves_a_plain_mesh() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, GRID, Pins::indices([0, 17]));
    run(&mut app, 40);
    let before = points(drawn(&app, cloth));
    assert!(drawn(&app, cloth).final_aabb.is_some());
    app.world_mut().entity_mut(cloth).remove::<Cloth>();
    run(&mut app, 5);
    let mesh = drawn(&app, cloth);
    assert_eq!(points(mesh), before);
    assert_eq!(mesh.final_aabb, None);
    for (shown, bevys) in normals(mesh).into_iter().zip(normals(&mesh.clone().with_computed_area_weighted_normals())) {
        assert_close(shown, bevys, 1e-4);
    }
    let entity = app.world().entity(cloth);
    assert!(!entity.contains::<ClothState>() && !entity.contains::<ClothStatus>());
}

#[test]
fn a_cloth_that_is_removed_before_it_is_ready_leaves_its_mesh() {
    let mut app = headless();
    let mesh = add_mesh(&mut app, GRID);
    let cloth = app.world_mut().spawn((Mesh3d(mesh.clone()), Cloth::default())).id();
    app.world_mut().entity_mut(cloth).remove::<Cloth>();
    run(&mut app, 2);
    assert_eq!(get::<Mesh3d>(&app, cloth).0, mesh);
    assert_eq!(app.world().resource::<Heard>().ready, []);
}

#[test]
fn a_cloth_that_is_added_again_starts_from_the_shape_that_was_left() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, GRID, Pins::edge(ClothEdge::Top));
    run(&mut app, 40);
    app.world_mut().entity_mut(cloth).remove::<Cloth>();
    run(&mut app, 5);
    let left = points(drawn(&app, cloth));
    app.world_mut().entity_mut(cloth).insert(Cloth { gravity_scale: 0.0, ..default() });
    run(&mut app, 10);
    assert_eq!(*get::<ClothStatus>(&app, cloth), ClothStatus::Ready);
    assert_eq!(pinned(&app, cloth), [0, 1, 2, 3, 4, 5], "the pins are still there");
    for (now, left) in positions(&app, cloth).into_iter().zip(left) {
        assert_close(now, left, 1e-4);
    }
    assert_eq!(*app.world().resource::<Heard>(), Heard { ready: vec![cloth; 2], ..default() });
}

#[test]
fn a_cloth_can_be_despawned_at_any_moment_of_a_frame() {
    fn despawn(cloths: Query<Entity, With<Cloth>>, mut commands: Commands) {
        cloths.iter().for_each(|cloth| commands.entity(cloth).despawn());
    }
    let moments: [fn(&mut App); 6] = [
        |app| {
            app.add_systems(PreUpdate, despawn.before(ClothSystems::Prepare));
        },
        |app| {
            app.add_systems(PreUpdate, despawn.after(ClothSystems::Prepare));
        },
        |app| {
            let moment = despawn.after(ClothSystems::Gather).before(ClothSystems::Simulate);
            app.add_systems(FixedPostUpdate, moment);
        },
        |app| {
            let moment = despawn.after(ClothSystems::Simulate).before(ClothSystems::Finalize);
            app.add_systems(FixedPostUpdate, moment);
        },
        |app| {
            let moment = despawn.after(TransformSystems::Propagate).before(ClothSystems::Draw);
            app.add_systems(PostUpdate, moment);
        },
        |app| {
            app.add_systems(PostUpdate, despawn.after(ClothSystems::Draw));
        },
    ];
    for moment in moments {
        // Once in the frame in which it is built, and once later.
        for age in [0, 5] {
            let mut app = headless();
            let cloth = spawn_cloth(&mut app, GRID, Pins::corners());
            run(&mut app, age);
            moment(&mut app);
            run(&mut app, 3);
            assert!(app.world().get_entity(cloth).is_err());
        }
    }
}

#[test]
fn a_cloth_can_be_despawned_by_those_who_hear_of_it() {
    let mut app = headless();
    app.add_observer(|event: On<ClothReady>, mut commands: Commands| commands.entity(event.entity).despawn());
    let cloth = spawn_cloth(&mut app, GRID, Pins::corners());
    run(&mut app, 3);
    assert!(app.world().get_entity(cloth).is_err());
}

#[test]
fn a_cloth_outlives_all_that_it_touches() {
    let mut app = headless();
    let pole = app.world_mut().spawn(Transform::default()).id();
    let ball = app.world_mut().spawn((ClothCollider::from(Sphere::new(0.3)), Transform::from_xyz(0.0, -0.4, 0.1))).id();
    let wind = app.world_mut().spawn(Wind { velocity: Vec3::Z * 5.0, ..default() }).id();
    let parent = app.world_mut().spawn(Transform::default()).id();
    let cloth = spawn_cloth(&mut app, GRID, (Pins::edge(ClothEdge::Top).to_entity(pole), ChildOf(parent)));
    run(&mut app, 20);
    for gone in [pole, ball, wind] {
        app.world_mut().despawn(gone);
        run(&mut app, 20);
    }
    let held = positions(&app, cloth);
    for (vertex, place) in held[0..6].iter().enumerate() {
        assert_close(*place, Vec3::new(vertex as f32 * 0.2 - 0.5, 0.5, 0.0), 1e-6);
    }
    app.world_mut().despawn(parent);
    run(&mut app, 2);
    assert_eq!(app.world_mut().query::<&ClothState>().iter(app.world()).count(), 0);
}

#[test]
fn a_cloth_goes_on_without_its_mesh_component() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, GRID, Pins::none());
    run(&mut app, 5);
    let mesh = get::<Mesh3d>(&app, cloth).clone();
    app.world_mut().entity_mut(cloth).remove::<Mesh3d>();
    run(&mut app, 30);
    app.world_mut().entity_mut(cloth).insert(mesh);
    run(&mut app, 2);
    assert!(points(drawn(&app, cloth))[0].y < -0.5);
    assert_eq!(app.world().resource::<Heard>().reset, []);
}

#[test]
fn a_cloth_that_is_inserted_again_goes_on_with_its_new_settings() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, GRID, undamped());
    run(&mut app, 30);
    app.world_mut().entity_mut(cloth).insert(Cloth { gravity_scale: 0.0, ..default() });
    run(&mut app, 1);
    let velocity = state(&app, cloth).velocity(0).unwrap();
    assert!(velocity.y < -4.0);
    run(&mut app, 10);
    assert_close(state(&app, cloth).velocity(0).unwrap(), velocity, 1e-2);
    assert_eq!(*app.world().resource::<Heard>(), Heard { ready: vec![cloth], ..default() });
}

#[test]
fn a_cloth_outlives_its_own_mesh() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, GRID, Pins::none());
    run(&mut app, 5);
    let mesh = get::<Mesh3d>(&app, cloth).0.clone();
    app.world_mut().resource_mut::<Assets<Mesh>>().remove(&mesh);
    run(&mut app, 30);
    command(&mut app, cloth, |cloth| cloth.reset_cloth());
    run(&mut app, 2);
    assert_close(points(drawn(&app, cloth))[0], points(&GRID.into())[0], 0.01);
}
