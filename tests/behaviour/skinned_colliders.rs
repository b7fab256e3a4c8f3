//! Colliders made of skinned meshes follow their skeletons.

use core::f32::consts::FRAC_PI_2;

use bevy::{
    math::Vec3A,
    mesh::{
        VertexAttributeValues,
        skinning::{SkinnedMesh, SkinnedMeshInverseBindposes},
    },
    prelude::*,
};
use bevy_drape::{Obstacles, prelude::*, solver::Shape};

use crate::{
    common::*,
    mesh_colliders::{mesh, obstacle, volume},
};

/// A limb: a box of 0.2 x 2 x 0.2 around the Y axis, its lower half on joint 0 at the origin, its upper half on joint 1,
/// which is a child of the first.
struct Limb {
    entity: Entity,
    joints: [Entity; 2],
}

/// A box, of which each vertex follows the joint of its half.
fn limb_mesh() -> Mesh {
    let mesh: Mesh = Cuboid::new(0.2, 2.0, 0.2).into();
    let joints = points(&mesh).into_iter().map(|point| [u16::from(point.y > 0.0), 0, 0, 0]).collect();
    let weights = vec![[1.0, 0.0, 0.0, 0.0]; mesh.count_vertices()];
    mesh.with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_INDEX, VertexAttributeValues::Uint16x4(joints))
        .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, weights)
}

fn bindposes(app: &mut App) -> Handle<SkinnedMeshInverseBindposes> {
    let mut all = app.world_mut().resource_mut::<Assets<SkinnedMeshInverseBindposes>>();
    all.add(SkinnedMeshInverseBindposes::from(vec![Mat4::IDENTITY; 2]))
}

fn spawn_limb(app: &mut App, root: Transform, collider: ClothCollider) -> Limb {
    let lower = app.world_mut().spawn(root).id();
    let upper = app.world_mut().spawn((Transform::default(), ChildOf(lower))).id();
    let joints = [lower, upper];
    let skeleton = SkinnedMesh { inverse_bindposes: bindposes(app), joints: joints.to_vec() };
    let mesh = add_mesh(app, limb_mesh());
    let entity = app.world_mut().spawn((Mesh3d(mesh), skeleton, collider)).id();
    Limb { entity, joints }
}

/// World places of a skinned collider's points at the start and at the end of the latest step.
fn places(app: &App, entity: Entity) -> [Vec<Vec3>; 2] {
    let obstacle = obstacle(app, entity).expect("it is an obstacle");
    let Shape::Mesh(shape) = &obstacle.shape else { panic!("it has triangles") };
    let [start, end] = shape.deformed.as_ref().expect("it is skinned").ends();
    [(obstacle.start, start), (obstacle.end, end)]
        .map(|(pose, points)| points.iter().map(|&point| (pose * point).into()).collect())
}

/// Where the points would be if all of them followed their joint as it is drawn.
fn drawn_places(app: &App, limb: &Limb) -> Vec<Vec3> {
    let poses = limb.joints.map(|joint| get::<GlobalTransform>(app, joint).affine());
    let bind = &mesh(app, limb.entity).points;
    bind.iter().map(|&point| poses[usize::from(point.y > 0.0)].transform_point3a(point).into()).collect()
}

#[track_caller]
fn assert_places(found: &[Vec3], expected: &[Vec3], tolerance: f32) {
    assert_eq!(found.len(), expected.len());
    for (&found, &expected) in found.iter().zip(expected) {
        assert_close(found, expected, tolerance);
    }
}

#[test]
fn points_follow_their_joints_from_step_to_step() {
    let mut app = headless();
    let limb = spawn_limb(&mut app, Transform::from_xyz(1.0, 2.0, 3.0), ClothCollider::mesh());
    run(&mut app, 1);
    let [start, end] = places(&app, limb.entity);
    assert_eq!(start, end, "it has been there");
    assert_places(&end, &drawn_places(&app, &limb), 1e-6);
    assert!(mesh(&app, limb.entity).is_closed);
    let mut before = end;
    for i in 1..10 {
        let turn = Quat::from_rotation_z(0.1 * i as f32);
        get_mut::<Transform>(&mut app, limb.joints[1]).rotation = turn;
        get_mut::<Transform>(&mut app, limb.joints[0]).translation.x += 0.05;
        run(&mut app, 1);
        let [start, end] = places(&app, limb.entity);
        assert_places(&start, &before, 1e-6);
        // Within the frame in which they move.
        assert_places(&end, &drawn_places(&app, &limb), 1e-5);
        assert!(end.iter().zip(&start).any(|(end, start)| end.distance(*start) > 0.05));
        before = end;
    }
}

#[test]
fn points_go_from_late_step_to_late_step_beside_fixed_ones() {
    for rate in [30.0, 60.0, 144.0] {
        let mut app = headless();
        set_rates(&mut app, 1.0 / rate, 1.0 / 64.0);
        let limb = spawn_limb(&mut app, Transform::from_xyz(1.0, 2.0, 3.0), ClothCollider::mesh());
        for timing in [ClothTiming::Late, ClothTiming::Fixed] {
            let away = Transform::from_xyz(30.0, 0.0, 0.0);
            spawn_cloth(&mut app, ClothGrid::new(0.4, 0.4, 5, 5), (Cloth { timing, ..default() }, away));
        }
        let joints = limb.joints;
        let animate = move |mut places: Query<&mut Transform>, time: Res<Time>| {
            places.get_mut(joints[1]).unwrap().rotation = Quat::from_rotation_z(3.0 * time.elapsed_secs());
            places.get_mut(joints[0]).unwrap().translation.x = time.elapsed_secs();
        };
        app.add_systems(PostUpdate, animate.before(TransformSystems::Propagate));
        run(&mut app, 2);
        let mut before = places(&app, limb.entity)[1].clone();
        for _ in 0..20 {
            run(&mut app, 1);
            // The late pass comes last.
            let [start, end] = places(&app, limb.entity);
            assert_places(&start, &before, 1e-6);
            assert_places(&end, &drawn_places(&app, &limb), 1e-5);
            before = end;
        }
    }
}

#[test]
fn weights_blend_and_bind_poses_count() {
    let mut app = headless();
    let limb = spawn_limb(&mut app, Transform::default(), ClothCollider::mesh());
    let half: Mesh = limb_mesh().with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, vec![[0.5, 0.5, 0.0, 0.0]; 24]);
    let all = VertexAttributeValues::Uint16x4(vec![[0, 1, 0, 0]; 24]);
    get_mut::<Mesh3d>(&mut app, limb.entity).0 =
        add_mesh(&mut app, half.with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_INDEX, all));
    let bind = Mat4::from_translation(Vec3::X);
    let bindposes =
        app.world_mut().resource_mut::<Assets<SkinnedMeshInverseBindposes>>().add(vec![bind, Mat4::IDENTITY]);
    get_mut::<SkinnedMesh>(&mut app, limb.entity).inverse_bindposes = bindposes;
    get_mut::<Transform>(&mut app, limb.joints[1]).translation.y = 4.0;
    run(&mut app, 1);
    let expected: Vec<Vec3> =
        mesh(&app, limb.entity).points.iter().map(|&point| Vec3::from(point) + Vec3::new(0.5, 2.0, 0.0)).collect();
    assert_places(&places(&app, limb.entity)[1], &expected, 1e-6);
}

#[test]
fn the_entitys_own_transform_has_no_say() {
    let mut app = headless();
    let limb = spawn_limb(&mut app, Transform::default(), ClothCollider::mesh());
    let own = Transform::from_xyz(9.0, 9.0, 9.0).with_scale(Vec3::new(2.0, 0.0, f32::NAN));
    app.world_mut().entity_mut(limb.entity).insert(own);
    run(&mut app, 1);
    assert_places(&places(&app, limb.entity)[1], &drawn_places(&app, &limb), 1e-6);
}

#[test]
fn far_away_points_stay_as_exact_as_near() {
    let mut app = headless();
    let far = Transform::from_xyz(20_000.0, 0.0, -20_000.0);
    let limb = spawn_limb(&mut app, far, ClothCollider::mesh());
    get_mut::<Transform>(&mut app, limb.joints[1]).rotation = Quat::from_rotation_z(FRAC_PI_2);
    run(&mut app, 1);
    let Shape::Mesh(shape) = &obstacle(&app, limb.entity).unwrap().shape else { panic!("it has triangles") };
    let [_, end] = shape.deformed.as_ref().unwrap().ends();
    let turned = |&point: &Vec3A| if point.y > 0.0 { Vec3A::new(-point.y, point.x, point.z) } else { point };
    for (found, expected) in end.iter().zip(mesh(&app, limb.entity).points.iter().map(turned)) {
        assert!(found.abs_diff_eq(expected, 1e-6), "{found} and {expected}");
    }
}

#[test]
fn a_hull_and_another_mesh_follow_the_same_skeleton() {
    let mut app = headless();
    let hull = spawn_limb(&mut app, Transform::default(), ClothCollider::convex_hull());
    let coarse = add_mesh(&mut app, limb_mesh());
    let other = spawn_limb(&mut app, Transform::default(), ClothCollider::mesh_of(coarse));
    get_mut::<Mesh3d>(&mut app, other.entity).0 = add_mesh(&mut app, Sphere::new(5.0));
    for limb in [hull, other] {
        get_mut::<Transform>(&mut app, limb.joints[1]).translation = Vec3::new(0.3, 0.7, 0.0);
        run(&mut app, 1);
        assert_places(&places(&app, limb.entity)[1], &drawn_places(&app, &limb), 1e-6);
    }
}

#[test]
fn a_body_that_collides_beside_its_own_clothes_follows_their_skeleton() {
    let mut app = headless();
    let body = add_mesh(&mut app, limb_mesh());
    let limb = spawn_limb(&mut app, Transform::default(), ClothCollider::mesh_of(body));
    run(&mut app, 1);
    app.world_mut().entity_mut(limb.entity).insert((Cloth::default(), Pins::predicate(|_| true)));
    for i in 1..5 {
        get_mut::<Transform>(&mut app, limb.joints[1]).translation.x = 0.01 * i as f32;
        run(&mut app, 1);
        assert_places(&places(&app, limb.entity)[1], &drawn_places(&app, &limb), 1e-6);
    }
    assert!(app.world().entity(limb.entity).contains::<SkinnedMesh>());
}

#[test]
fn a_mirrored_skeleton_faces_out_still() {
    let mut app = headless();
    for scale in [Vec3::ONE, Vec3::new(-1.0, 1.0, 1.0), Vec3::splat(-0.5)] {
        let limb = spawn_limb(&mut app, Transform::from_scale(scale), ClothCollider::mesh());
        run(&mut app, 1);
        let end: Vec<Vec3A> = places(&app, limb.entity)[1].iter().copied().map(Vec3A::from).collect();
        let volume = volume(mesh(&app, limb.entity).triangles(), &end);
        assert!((volume - 0.08 * scale.abs().element_product()).abs() < 1e-4, "{scale}: {volume}");
    }
}

#[test]
fn points_are_written_to_the_same_places_again() {
    let mut app = headless();
    let limb = spawn_limb(&mut app, Transform::default(), ClothCollider::mesh());
    // It holds on to what it meets.
    spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 4, 4), ());
    let latest = |app: &App| match &obstacle(app, limb.entity).unwrap().shape {
        Shape::Mesh(shape) => shape.deformed.as_ref().unwrap().ends()[1].as_ptr(),
        Shape::Solid(_) => panic!("it has triangles"),
    };
    run(&mut app, 5);
    let seen: Vec<_> = (0..9)
        .map(|_| {
            run(&mut app, 1);
            latest(&app)
        })
        .collect();
    assert_eq!([&seen[..3], &seen[..3]].concat(), seen[3..]);
    assert!(seen[0] != seen[1] && seen[1] != seen[2] && seen[2] != seen[0]);
}

#[test]
fn a_skeleton_that_comes_or_goes_sweeps_nothing() {
    let mut app = headless();
    let limb = spawn_limb(&mut app, Transform::from_xyz(0.0, 3.0, 0.0), ClothCollider::mesh());
    run(&mut app, 3);
    let skeleton = app.world_mut().entity_mut(limb.entity).take::<SkinnedMesh>().unwrap();
    let is_still = |app: &App| {
        let obstacle = obstacle(app, limb.entity).unwrap();
        assert_eq!(obstacle.start, obstacle.end);
        matches!(&obstacle.shape, Shape::Mesh(shape) if shape.deformed.is_none())
    };
    run(&mut app, 1);
    assert!(is_still(&app), "it is where its own transform puts it");
    app.world_mut().entity_mut(limb.entity).insert(skeleton);
    run(&mut app, 1);
    assert!(!is_still(&app));
    let [start, end] = places(&app, limb.entity);
    assert_eq!(start, end);
    assert!(end.iter().all(|place| place.y > 1.5));
}

#[test]
fn a_collider_waits_for_its_bind_pose() {
    let mut app = headless();
    let limb = spawn_limb(&mut app, Transform::default(), ClothCollider::mesh());
    let poses = app.world().resource::<Assets<SkinnedMeshInverseBindposes>>().reserve_handle();
    get_mut::<SkinnedMesh>(&mut app, limb.entity).inverse_bindposes = poses.clone();
    run(&mut app, 3);
    assert_eq!(app.world().resource::<Obstacles>().iter().len(), 0);
    let mut all = app.world_mut().resource_mut::<Assets<SkinnedMeshInverseBindposes>>();
    all.insert(&poses, vec![Mat4::IDENTITY; 2].into()).unwrap();
    run(&mut app, 1);
    assert_places(&places(&app, limb.entity)[1], &drawn_places(&app, &limb), 1e-6);
}

#[test]
fn a_limb_carries_cloth_along() {
    let mut app = headless();
    let lying = Transform::from_rotation(Quat::from_rotation_z(FRAC_PI_2)).with_scale(Vec3::new(1.0, 1.0, 4.0));
    let limb = spawn_limb(&mut app, lying, ClothCollider { friction: 4.0, ..ClothCollider::mesh() });
    let above = Transform::from_xyz(0.0, 0.11, 0.0);
    let cloth = spawn_cloth(&mut app, ClothGrid::new(0.6, 0.6, 7, 7).lying(), (above, undamped()));
    run(&mut app, 30);
    for _ in 0..60 {
        get_mut::<Transform>(&mut app, limb.joints[0]).translation += Vec3::new(0.005, 0.01, 0.0);
        run(&mut app, 1);
    }
    let middle = place(&app, cloth, 24);
    assert!((middle.y - 0.7).abs() < 0.03 && (middle.x - 0.3).abs() < 0.05, "{middle}");
}
