//! Capsules come, follow, change and go.

use bevy::{
    mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes},
    prelude::*,
};
use bevy_drape::{Obstacles, prelude::*, solver::Solid};

use super::limb::{self, Limb, distance, names, parts, spawn, spawn_body};
use crate::common::*;

fn obstacle_count(app: &App) -> usize {
    app.world().resource::<Obstacles>().iter().len()
}

/// Distances of places along the limb's skin from all capsules at the end of the latest step, m.
fn distances(app: &App, limb: &Limb) -> Vec<f32> {
    let pose = limb.joints.map(|joint| get::<GlobalTransform>(app, joint).affine());
    let bind = limb::bindposes();
    let places = points(&limb::mesh()).into_iter().enumerate().map(|(i, place)| {
        let joint = i / 72;
        pose[joint].transform_point3(bind[joint].transform_point3(place))
    });
    let obstacles = app.world().resource::<Obstacles>();
    let nearest = |place| obstacles.iter().map(|(.., it)| distance(it, place)).fold(f32::INFINITY, f32::min);
    places.take(144).map(nearest).collect()
}

fn assert_fits(app: &App, limb: &Limb) {
    let distances = distances(app, limb);
    let inside = distances.iter().filter(|distance| **distance < 1e-4).count() as f32 / distances.len() as f32;
    assert!(inside > 0.84, "{inside} inside");
    assert!(distances.iter().all(|distance| *distance < 0.01), "{distances:?}");
    // Where the limb is bent, a capsule has skin of the other joint deep inside.
    let on_surface = distances.iter().filter(|distance| distance.abs() < 0.01).count() as f32 / distances.len() as f32;
    assert!(on_surface > 0.95, "{distances:?}");
}

#[test]
fn a_joint_gets_a_capsule_that_fits_its_skin_and_follows_it() {
    let mut app = headless();
    let limb = spawn_body(&mut app, Transform::from_xyz(3.0, 2.0, 1.0));
    run(&mut app, 1);
    let parts = parts(&mut app, limb.root);
    assert_eq!(parts.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(), ["lower", "upper"]);
    for (part, joint) in [(parts[0].1, limb.joints[1]), (parts[1].1, limb.joints[0])] {
        assert_eq!(get::<ChildOf>(&app, part).parent(), joint);
        let ColliderShape::Solid(Solid::TaperedCapsule(_)) = get::<ClothCollider>(&app, part).shape else {
            panic!("a capsule")
        };
    }
    assert_fits(&app, &limb);
    get_mut::<Transform>(&mut app, limb.joints[1]).rotation = Quat::from_rotation_x(1.5);
    get_mut::<Transform>(&mut app, limb.root).translation = Vec3::new(-1.0, 0.0, 5.0);
    run(&mut app, 1);
    assert_fits(&app, &limb);
}

#[test]
fn a_character_of_another_size_has_capsules_of_that_size() {
    let mut app = headless();
    let limb = spawn_body(&mut app, Transform::from_scale(Vec3::splat(0.1)));
    run(&mut app, 1);
    assert!(names(&mut app, limb.root).is_empty(), "all of it is thinner than `smallest`");
    get_mut::<ClothBody>(&mut app, limb.root).smallest = 0.002;
    run(&mut app, 1);
    assert_eq!(names(&mut app, limb.root), ["lower", "upper"]);
}

#[test]
fn names_are_excepted_and_small_joints_go_to_those_above() {
    let mut app = headless();
    let limb = spawn_body(&mut app, Transform::default());
    get_mut::<ClothBody>(&mut app, limb.root).smallest = 0.0;
    run(&mut app, 1);
    assert_eq!(names(&mut app, limb.root), ["finger", "lower", "upper"]);
    let excepted = ClothBody { except: vec!["upper".into(), "toe".into()], ..default() };
    app.world_mut().entity_mut(limb.root).insert(excepted);
    run(&mut app, 1);
    assert_eq!(names(&mut app, limb.root), ["lower"]);
    // A mesh that isn't the body's.
    app.world_mut().entity_mut(limb.mesh).insert(Name::new("hair"));
    get_mut::<ClothBody>(&mut app, limb.root).except = vec!["hair".into()];
    run(&mut app, 1);
    assert!(names(&mut app, limb.root).is_empty());
}

#[test]
fn more_cover_is_more_thickness() {
    let mut app = headless();
    let limb = spawn_body(&mut app, Transform::default());
    let mut radius = |cover| {
        get_mut::<ClothBody>(&mut app, limb.root).cover = cover;
        run(&mut app, 1);
        let part = parts(&mut app, limb.root)[1].1;
        match get::<ClothCollider>(&app, part).shape {
            ColliderShape::Solid(Solid::TaperedCapsule(capsule)) => capsule.radius_top + capsule.radius_bottom,
            _ => panic!("a capsule"),
        }
    };
    let radii = [0.3, 0.85, 1.0].map(&mut radius);
    assert!(radii[0] < radii[1] && radii[1] < radii[2], "{radii:?}");
}

#[test]
fn edits_stay_until_the_body_or_its_mesh_changes() {
    let mut app = headless();
    let limb = spawn_body(&mut app, Transform::default());
    run(&mut app, 1);
    let [lower, upper] = [0, 1].map(|i| parts(&mut app, limb.root)[i].1);
    app.world_mut().despawn(lower);
    *get_mut::<ClothCollider>(&mut app, upper) = Sphere::new(0.3).into();
    // Something else comes to the world.
    spawn(&mut app, Transform::from_xyz(9.0, 0.0, 0.0));
    run(&mut app, 3);
    assert_eq!(parts(&mut app, limb.root), [("upper".into(), upper)]);
    get_mut::<ClothBody>(&mut app, limb.root).set_changed();
    run(&mut app, 1);
    assert_eq!(names(&mut app, limb.root), ["lower", "upper"]);
    assert!(app.world().get_entity(upper).is_err(), "all are made anew");

    let thick = limb::mesh().scaled_by(Vec3::new(2.0, 1.0, 2.0));
    let handle = get::<Mesh3d>(&app, limb.mesh).0.clone();
    app.world_mut().resource_mut::<Assets<Mesh>>().insert(&handle, thick).unwrap();
    run(&mut app, 2);
    let radius = |app: &mut App| {
        let part = parts(app, limb.root)[1].1;
        match get::<ClothCollider>(app, part).shape {
            ColliderShape::Solid(Solid::TaperedCapsule(capsule)) => capsule.radius_bottom,
            _ => panic!("a capsule"),
        }
    };
    assert!(radius(&mut app) > 0.15, "its mesh has been written anew");
    get_mut::<Mesh3d>(&mut app, limb.mesh).0 = add_mesh(&mut app, limb::mesh());
    run(&mut app, 1);
    assert!(radius(&mut app) < 0.12, "it has another mesh");
}

#[test]
fn what_loads_late_gets_its_capsules_then() {
    let mut app = headless();
    let limb = spawn(&mut app, Transform::default());
    let late = spawn(&mut app, Transform::default());
    app.world_mut().entity_mut(late.mesh).remove::<ChildOf>();
    app.world_mut().entity_mut(late.root).insert(ClothBody::default());
    let poses = app.world().resource::<Assets<SkinnedMeshInverseBindposes>>().reserve_handle();
    let mesh = app.world().resource::<Assets<Mesh>>().reserve_handle();
    get_mut::<SkinnedMesh>(&mut app, limb.mesh).inverse_bindposes = poses.clone();
    get_mut::<Mesh3d>(&mut app, limb.mesh).0 = mesh.clone();
    app.world_mut().entity_mut(limb.root).insert(ClothBody::default());
    run(&mut app, 3);
    app.world_mut().resource_mut::<Assets<Mesh>>().insert(&mesh, limb::mesh()).unwrap();
    run(&mut app, 3);
    assert_eq!(obstacle_count(&app), 0);
    app.world_mut().resource_mut::<Assets<SkinnedMeshInverseBindposes>>().insert(&poses, limb::bindposes()).unwrap();
    app.world_mut().entity_mut(late.mesh).insert(ChildOf(late.root));
    run(&mut app, 1);
    assert_eq!(names(&mut app, limb.root), ["lower", "upper"]);
    assert_eq!(names(&mut app, late.root), ["lower", "upper"]);
}

#[test]
fn capsules_go_with_their_body() {
    let mut app = headless();
    let limbs = [0, 1, 2].map(|_| spawn_body(&mut app, Transform::default()));
    // On the body's mesh, with joints that aren't below it.
    let apart = spawn(&mut app, Transform::default());
    app.world_mut().entity_mut(apart.mesh).insert(ClothBody::default()).remove::<ChildOf>();
    run(&mut app, 1);
    assert_eq!(obstacle_count(&app), 8);
    app.world_mut().entity_mut(limbs[0].root).remove::<ClothBody>();
    run(&mut app, 1);
    assert_eq!(obstacle_count(&app), 6);
    app.world_mut().despawn(limbs[1].root);
    app.world_mut().despawn(apart.mesh);
    run(&mut app, 1);
    assert_eq!(obstacle_count(&app), 2);
    app.world_mut().despawn(limbs[2].joints[1]);
    run(&mut app, 2);
    assert_eq!(names(&mut app, limbs[2].root), ["upper"]);
    app.world_mut().entity_mut(limbs[0].root).insert(ClothBody::default());
    run(&mut app, 1);
    assert_eq!(names(&mut app, limbs[0].root), ["lower", "upper"], "it comes back");
    // In the frame in which it comes.
    let brief = spawn_body(&mut app, Transform::default());
    app.add_systems(
        PreUpdate,
        (move |mut commands: Commands| commands.entity(brief.root).try_despawn()).before(ClothSystems::Prepare),
    );
    run(&mut app, 2);
    assert_eq!(names(&mut app, brief.root).len(), 0);
}

#[test]
fn a_copy_has_capsules_of_its_own_and_no_more() {
    let mut app = headless();
    let limb = spawn_body(&mut app, Transform::default());
    run(&mut app, 2);
    let copy = app.world_mut().entity_mut(limb.root).clone_and_spawn_with_opt_out(|builder| {
        builder.linked_cloning(true);
    });
    run(&mut app, 3);
    assert_eq!(names(&mut app, limb.root), ["lower", "upper"]);
    assert_eq!(names(&mut app, copy), ["lower", "upper"]);
    assert_eq!(obstacle_count(&app), 4);
    get_mut::<Transform>(&mut app, copy).translation.x = 5.0;
    run(&mut app, 1);
    for (_, part) in parts(&mut app, copy) {
        assert!((get::<GlobalTransform>(&app, part).translation().x - 5.0).abs() < 0.1);
    }
}
