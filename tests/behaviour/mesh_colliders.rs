//! Meshes, convex hulls and height fields become obstacles: as they are scaled, made once, and made anew when they change.

use std::{
    sync::{Arc, Weak},
    thread,
    time::Duration,
};

use bevy::{
    math::{Isometry3d, Vec3A},
    prelude::*,
};
use bevy_drape::{
    Obstacles,
    prelude::*,
    solver::{Obstacle, Shape, TriangleMesh},
};

use crate::common::*;

/// The obstacle that an entity is, if it is one.
pub fn obstacle(app: &App, entity: Entity) -> Option<&Obstacle> {
    let mut obstacles = app.world().resource::<Obstacles>().iter();
    obstacles.find(|&(of, ..)| of == entity).map(|(.., obstacle)| obstacle)
}

/// The triangles of a collider that has some.
pub fn mesh(app: &App, entity: Entity) -> &Arc<TriangleMesh> {
    match obstacle(app, entity).map(|obstacle| &obstacle.shape) {
        Some(Shape::Mesh(shape)) => &shape.mesh,
        other => panic!("no triangles but {other:?}"),
    }
}

/// Updates until a collider is an obstacle: large ones are worked on beside the frames.
fn wait_for(app: &mut App, what: impl Fn(&App) -> bool) {
    for _ in 0..2000 {
        app.update();
        if what(app) {
            return;
        }
        thread::sleep(Duration::from_millis(2));
    }
    panic!("it doesn't come");
}

fn size(mesh: &TriangleMesh) -> Vec3 {
    let [low, high] = mesh.bounds();
    (high - low).into()
}

/// Volume that the triangles enclose, m³, facing out of it.
pub fn volume(triangles: &[[u32; 3]], points: &[Vec3A]) -> f32 {
    let corners = |triangle: &[u32; 3]| triangle.map(|i| points[i as usize]);
    triangles.iter().map(corners).map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
}

fn spawn(app: &mut App, mesh: impl Into<Mesh>, more: impl Bundle) -> Entity {
    let mesh = add_mesh(app, mesh);
    app.world_mut().spawn((Mesh3d(mesh), more)).id()
}

fn ptr_eq(app: &App, one: Entity, other: Entity) -> bool {
    Arc::ptr_eq(mesh(app, one), mesh(app, other))
}

#[test]
fn the_mesh_of_an_entity_is_an_obstacle_where_the_entity_is() {
    let mut app = headless();
    let pose = Transform::from_xyz(1.0, 2.0, 3.0).with_rotation(Quat::from_rotation_y(0.7));
    let collider = ClothCollider { friction: 0.3, ..ClothCollider::mesh() };
    let entity = spawn(&mut app, Cuboid::new(1.0, 2.0, 3.0), (collider.in_layers(6), pose));
    run(&mut app, 1);
    let mesh = mesh(&app, entity);
    assert_eq!((mesh.points.len(), mesh.triangles().len(), mesh.is_closed), (8, 12, true));
    assert_eq!(size(mesh), Vec3::new(1.0, 2.0, 3.0));
    let obstacle = obstacle(&app, entity).unwrap();
    let pose = Isometry3d::new(pose.translation, pose.rotation);
    for end in [obstacle.start, obstacle.end] {
        assert!(end.translation.abs_diff_eq(pose.translation, 1e-6) && end.rotation.abs_diff_eq(pose.rotation, 1e-6));
    }
    assert_eq!((obstacle.friction, obstacle.body), (0.3, None));
    let layers: Vec<u32> = app.world().resource::<Obstacles>().iter().map(|(_, layers, _)| layers).collect();
    assert_eq!(layers, [6]);
}

#[test]
fn an_open_mesh_is_thin_and_a_closed_one_solid() {
    let mut app = headless();
    let plane = spawn(&mut app, Plane3d::default(), ClothCollider::mesh());
    let torus = spawn(&mut app, Torus::new(0.2, 0.5), ClothCollider::mesh());
    run(&mut app, 1);
    assert!(!mesh(&app, plane).is_closed);
    assert!(mesh(&app, torus).is_closed);
}

#[test]
fn a_convex_hull_fills_what_is_hollow() {
    let mut app = headless();
    let torus = Mesh::from(Torus { minor_radius: 0.2, major_radius: 0.5 });
    let [shape, hull] =
        [ClothCollider::mesh(), ClothCollider::convex_hull()].map(|c| spawn(&mut app, torus.clone(), c));
    run(&mut app, 1);
    let [shape, hull] = [shape, hull].map(|entity| mesh(&app, entity));
    assert!(hull.is_closed && hull.triangles().len() < shape.triangles().len());
    assert!(size(hull).abs_diff_eq(size(shape), 1e-6));
    assert!(volume(hull.triangles(), &hull.points) > 1.3 * volume(shape.triangles(), &shape.points));
}

#[test]
fn another_mesh_than_the_one_that_is_drawn_can_be_named() {
    let mut app = headless();
    let [coarse, long] = [Cuboid::new(1.0, 1.0, 1.0), Cuboid::new(1.0, 4.0, 1.0)].map(|mesh| add_mesh(&mut app, mesh));
    let one = spawn(&mut app, Sphere::new(0.5), ClothCollider::mesh_of(coarse));
    let other = app.world_mut().spawn(ClothCollider::convex_hull_of(long)).id();
    run(&mut app, 1);
    assert_eq!([one, other].map(|entity| size(mesh(&app, entity)).y), [1.0, 4.0]);
}

#[test]
fn scale_is_worked_in_whatever_it_is() {
    let mut app = headless();
    let parent = Transform::from_rotation(Quat::from_rotation_x(0.4)).with_scale(Vec3::new(2.0, 2.0, 2.0));
    let parent = app.world_mut().spawn(parent).id();
    for scale in [Vec3::ONE, Vec3::new(0.5, 3.0, 1.5), Vec3::new(-0.5, 3.0, 1.5), -Vec3::ONE] {
        for collider in [ClothCollider::mesh(), ClothCollider::convex_hull()] {
            let turned = Transform::from_rotation(Quat::from_rotation_z(0.8)).with_scale(scale);
            let entity = spawn(&mut app, Cuboid::new(1.0, 1.0, 1.0), (collider, turned, ChildOf(parent)));
            run(&mut app, 1);
            let mesh = mesh(&app, entity);
            assert!(size(mesh).abs_diff_eq(2.0 * scale.abs(), 1e-5), "{scale}: {}", size(mesh));
            assert!(mesh.is_closed);
            let volume = volume(mesh.triangles(), &mesh.points);
            assert!((volume - 8.0 * scale.abs().element_product()).abs() < 1e-3, "{scale}: {volume}");
        }
    }
}

#[test]
fn every_point_is_where_it_is_drawn_sheared_or_mirrored() {
    let mut app = headless();
    let parent = Transform::from_xyz(3.0, 0.0, 1.0).with_scale(Vec3::new(1.0, -3.0, 0.5));
    let parent = app.world_mut().spawn(parent).id();
    let turned = Transform::from_xyz(0.0, 1.0, 0.0).with_rotation(Quat::from_euler(EulerRot::XYZ, 0.4, 1.1, -0.3));
    let entity = spawn(&mut app, Cuboid::new(1.0, 2.0, 3.0), (ClothCollider::mesh(), turned, ChildOf(parent)));
    run(&mut app, 1);
    let (obstacle, mesh) = (obstacle(&app, entity).unwrap(), mesh(&app, entity));
    let transform = get::<GlobalTransform>(&app, entity);
    for point in points(drawn(&app, entity)) {
        let place = transform.transform_point(point);
        let distance = |p: &Vec3A| (obstacle.end * *p).distance(place.into());
        assert!(mesh.points.iter().map(distance).fold(f32::MAX, f32::min) < 1e-5, "{place}");
    }
}

#[test]
fn equal_colliders_share_their_triangles() {
    let mut app = headless();
    let asset = add_mesh(&mut app, Sphere::new(0.5));
    let mut spawn = |collider: ClothCollider, transform: Transform| {
        app.world_mut().spawn((Mesh3d(asset.clone()), collider, transform)).id()
    };
    let turned = Transform::from_xyz(5.0, 0.0, 0.0).with_rotation(Quat::from_euler(EulerRot::XYZ, 1.0, 2.0, 3.0));
    let first = spawn(ClothCollider::mesh(), Transform::default());
    let same = [
        spawn(ClothCollider::mesh(), turned),
        spawn(ClothCollider::mesh_of(asset.clone()), Transform::default()),
        spawn(ClothCollider { friction: 0.0, ..ClothCollider::mesh() }, Transform::default()),
    ];
    let others = [
        spawn(ClothCollider::mesh(), Transform::from_scale(Vec3::splat(2.0))),
        spawn(ClothCollider::mesh(), Transform::from_scale(Vec3::new(-1.0, 1.0, 1.0))),
        spawn(ClothCollider::convex_hull(), Transform::default()),
    ];
    run(&mut app, 1);
    assert!(same.into_iter().all(|entity| ptr_eq(&app, first, entity)));
    assert!(!others.into_iter().any(|entity| ptr_eq(&app, first, entity)));
}

#[test]
fn triangles_that_nobody_needs_any_more_are_dropped() {
    let mut app = headless();
    let [one, other] = [(); 2].map(|()| spawn(&mut app, Sphere::new(0.5), ClothCollider::mesh()));
    // A cloth holds what it meets until its next step.
    spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 4, 4), ());
    run(&mut app, 2);
    let kept: [Weak<TriangleMesh>; 2] = [one, other].map(|entity| Arc::downgrade(mesh(&app, entity)));
    app.world_mut().despawn(one);
    get_mut::<Transform>(&mut app, other).scale = Vec3::splat(2.0);
    run(&mut app, 3);
    assert!(kept.iter().all(|triangles| triangles.strong_count() == 0));
    assert_eq!(size(mesh(&app, other)).y, 2.0);
}

#[test]
fn turning_and_moving_make_nothing_anew() {
    let mut app = headless();
    let scaled = Transform::from_scale(Vec3::new(0.3, 1.7, 1.3));
    let entity = spawn(&mut app, Sphere::new(0.5), (ClothCollider::mesh(), scaled));
    run(&mut app, 1);
    let first = Arc::downgrade(mesh(&app, entity));
    for _ in 0..50 {
        let mut transform = get_mut::<Transform>(&mut app, entity);
        transform.rotate(Quat::from_euler(EulerRot::XYZ, 0.1, 0.2, 0.3));
        transform.translation.x += 7.0;
        run(&mut app, 1);
        assert!(core::ptr::eq(Arc::as_ptr(mesh(&app, entity)), first.as_ptr()));
    }
}

#[test]
fn a_mesh_that_is_changed_is_made_anew() {
    let mut app = headless();
    let entity = spawn(&mut app, Cuboid::new(1.0, 1.0, 1.0), ClothCollider::mesh());
    run(&mut app, 2);
    let handle = get::<Mesh3d>(&app, entity).0.clone();
    let mut meshes = app.world_mut().resource_mut::<Assets<Mesh>>();
    *meshes.get_mut(&handle).unwrap() = Cuboid::new(1.0, 3.0, 1.0).into();
    run(&mut app, 2);
    assert_eq!(size(mesh(&app, entity)).y, 3.0);
    let other = add_mesh(&mut app, Cuboid::new(1.0, 5.0, 1.0));
    get_mut::<Mesh3d>(&mut app, entity).0 = other;
    run(&mut app, 1);
    assert_eq!(size(mesh(&app, entity)).y, 5.0);
    get_mut::<ClothCollider>(&mut app, entity).shape = ColliderShape::Solid(Solid::Sphere(Sphere::new(0.5)));
    run(&mut app, 1);
    assert!(matches!(obstacle(&app, entity).unwrap().shape, Shape::Solid(_)));
}

#[test]
fn a_collider_waits_for_its_mesh() {
    let mut app = headless();
    let handle = app.world().resource::<Assets<Mesh>>().reserve_handle();
    let [own, named, bare] = [
        app.world_mut().spawn((Mesh3d(handle.clone()), ClothCollider::mesh())).id(),
        app.world_mut().spawn(ClothCollider::convex_hull_of(handle.clone())).id(),
        app.world_mut().spawn(ClothCollider::mesh()).id(),
    ];
    run(&mut app, 5);
    assert_eq!(app.world().resource::<Obstacles>().iter().len(), 0);
    let mut meshes = app.world_mut().resource_mut::<Assets<Mesh>>();
    meshes.insert(&handle, Sphere::new(0.5).into()).unwrap();
    run(&mut app, 1);
    assert!([own, named].into_iter().all(|entity| mesh(&app, entity).is_closed));
    app.world_mut().entity_mut(bare).insert(Mesh3d(handle));
    run(&mut app, 1);
    assert!(ptr_eq(&app, own, bare));
}

#[test]
fn a_large_mesh_is_worked_on_beside_the_frames() {
    let mut app = headless();
    let large = Sphere::new(0.5).mesh().uv(120, 70);
    let entities = [(); 2].map(|()| app.world_mut().spawn(ClothCollider::mesh()).id());
    let asset = add_mesh(&mut app, large);
    for entity in entities {
        app.world_mut().entity_mut(entity).insert(Mesh3d(asset.clone()));
    }
    run(&mut app, 1);
    assert!(obstacle(&app, entities[0]).is_none());
    wait_for(&mut app, |app| obstacle(app, entities[0]).is_some());
    let [one, other] = entities;
    assert!(ptr_eq(&app, one, other));
    // Cloth meets what there was until the new one is done.
    get_mut::<Transform>(&mut app, one).scale = Vec3::splat(2.0);
    run(&mut app, 1);
    assert!(ptr_eq(&app, one, other));
    wait_for(&mut app, |app| !ptr_eq(app, one, other));
    assert!((size(mesh(&app, one)).y - 2.0).abs() < 1e-3);
}

#[test]
fn a_height_field_is_a_terrain() {
    let mut app = headless();
    let slope = |x: f32, z: f32| 0.1 * x + 0.5 * z;
    let field = HeightField::new(Vec2::new(4.0, 2.0), 9, 5, slope);
    let scaled = Transform::from_xyz(0.0, 3.0, 0.0).with_scale(Vec3::new(1.0, 2.0, 1.0));
    let entity = app.world_mut().spawn((ClothCollider::from(field.clone()), scaled)).id();
    let same = app.world_mut().spawn((ClothCollider::from(field), scaled)).id();
    run(&mut app, 1);
    let first = mesh(&app, entity).clone();
    assert_eq!((first.points.len(), first.triangles().len(), first.is_closed), (45, 64, false));
    for point in &first.points {
        assert!((point.y - 2.0 * slope(point.x, point.z)).abs() < 1e-5, "{point}");
    }
    assert!(ptr_eq(&app, entity, same));
    get_mut::<ClothCollider>(&mut app, entity).friction = 0.2;
    run(&mut app, 1);
    assert!(ptr_eq(&app, entity, same), "it is the same still");
    if let ColliderShape::HeightField(field) = &mut get_mut::<ClothCollider>(&mut app, entity).shape {
        field.heights[3] = 9.0;
    }
    run(&mut app, 1);
    assert_eq!(mesh(&app, entity).points[3].y, 18.0);
    assert!(Arc::ptr_eq(mesh(&app, same), &first));
}

#[test]
fn a_mesh_pushes_on_its_way_and_comes_back_out_of_nowhere() {
    let mut app = headless();
    let entity = spawn(&mut app, Cuboid::new(1.0, 1.0, 1.0), ClothCollider::mesh());
    run(&mut app, 2);
    let way = |app: &App, entity: Entity| {
        let Obstacle { start, end, .. } = obstacle(app, entity).unwrap();
        (start.translation.x, end.translation.x)
    };
    get_mut::<Transform>(&mut app, entity).translation.x = 0.5;
    run(&mut app, 1);
    assert_eq!(way(&app, entity), (0.0, 0.5));
    get_mut::<Transform>(&mut app, entity).translation.x = 2.0;
    run(&mut app, 1);
    assert_eq!(way(&app, entity), (2.0, 2.0), "no motion is so fast");
    command(&mut app, entity, |entity| entity.teleport_collider(Transform::from_xyz(2.5, 0.0, 0.0)));
    run(&mut app, 1);
    assert_eq!(way(&app, entity), (2.5, 2.5));
    let collider = app.world_mut().entity_mut(entity).take::<ClothCollider>().unwrap();
    get_mut::<Transform>(&mut app, entity).translation.x = 5.0;
    run(&mut app, 1);
    assert!(obstacle(&app, entity).is_none());
    app.world_mut().entity_mut(entity).insert(collider);
    run(&mut app, 1);
    assert_eq!(way(&app, entity), (5.0, 5.0));
    let copy = app.world_mut().entity_mut(entity).clone_and_spawn();
    get_mut::<Transform>(&mut app, copy).translation.x = 9.0;
    run(&mut app, 1);
    assert_eq!(way(&app, copy), (9.0, 9.0), "a copy doesn't come from where the first is");
}

#[test]
fn cloth_lies_on_what_a_mesh_is() {
    let mut app = headless();
    let table = Transform::from_xyz(0.0, -0.6, 0.0).with_scale(Vec3::new(2.0, 1.0, -2.0));
    spawn(&mut app, Cuboid::new(0.5, 1.0, 0.5), (ClothCollider::mesh(), table));
    let cloth = spawn_cloth(&mut app, ClothGrid::new(0.8, 0.8, 9, 9).lying(), undamped());
    run(&mut app, 60);
    let distance = Fabric::default().thickness + Cloth::default().collision_margin;
    for place in positions(&app, cloth) {
        assert!((place.y + 0.1 - distance).abs() < 5e-3, "{place}");
    }
}
