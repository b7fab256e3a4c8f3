//! Clothes: cloth on the skeleton of an animated character.

use core::f32::consts::FRAC_PI_2;

use bevy::{
    math::Affine3A,
    mesh::{
        VertexAttributeValues,
        skinning::{SkinnedMesh, SkinnedMeshInverseBindposes},
    },
    prelude::*,
};
use bevy_drape::prelude::*;

use crate::{common::*, quiet::Quiet};

/// Vertices along each side.
pub const SIDE: usize = 9;

/// Clothes on two joints, the second a child of the first, half a metre below it.
struct Worn {
    cloth: Entity,
    joints: [Entity; 2],
}

/// A sheet of 1 x 1 m below the origin: its upper part follows the first joint, its lower part more and more the second. With
/// triangles of any shape, if it is `uneven`.
pub fn dress(uneven: bool) -> Mesh {
    let mut mesh: Mesh = ClothGrid::new(1.0, 1.0, SIDE as u32, SIDE as u32).into();
    let mut places = points(&mesh);
    for (i, place) in places.iter_mut().enumerate() {
        place.y -= 0.5;
        let is_inside = place.x.abs() < 0.49 && (place.y + 0.5).abs() < 0.49;
        if uneven && is_inside {
            *place += Vec3::new((i * 7 % 5) as f32 - 2.0, (i * 3 % 5) as f32 - 2.0, 0.0) * 0.012;
        }
    }
    let lower: Vec<f32> = places.iter().map(|place| -place.y).collect();
    let places: Vec<[f32; 3]> = places.into_iter().map(|place| place.to_array()).collect();
    let joints = vec![[0, 1, 0, 0]; places.len()];
    mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, places);
    mesh.with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_INDEX, VertexAttributeValues::Uint16x4(joints))
        .with_inserted_attribute(
            Mesh::ATTRIBUTE_JOINT_WEIGHT,
            lower.into_iter().map(|lower| [1.0 - lower, lower, 0.0, 0.0]).collect::<Vec<_>>(),
        )
}

/// Spawns clothes whose first joint is at `root`.
fn spawn_worn(app: &mut App, mesh: Mesh, root: Transform, more: impl Bundle) -> Worn {
    spawn_worn_above(app, mesh, 0.0, root, more)
}

/// The same with a mesh whose origin is so far below the first joint, m, as the feet of a character are.
fn spawn_worn_above(app: &mut App, mesh: Mesh, height: f32, root: Transform, more: impl Bundle) -> Worn {
    let first = app.world_mut().spawn(root).id();
    let second = app.world_mut().spawn((Transform::from_xyz(0.0, -0.5, 0.0), ChildOf(first))).id();
    let bindposes = [0.0, 0.5].map(|below| Mat4::from_translation(Vec3::Y * (below - height)));
    let bindposes = SkinnedMeshInverseBindposes::from(bindposes.to_vec());
    let inverse_bindposes = app.world_mut().resource_mut::<Assets<SkinnedMeshInverseBindposes>>().add(bindposes);
    let joints = [first, second];
    let skeleton = SkinnedMesh { inverse_bindposes, joints: joints.to_vec() };
    let mesh = mesh.translated_by(Vec3::Y * height);
    let cloth = spawn_cloth(app, mesh, (skeleton, Pins::edge(ClothEdge::Top)));
    app.world_mut().entity_mut(cloth).insert(more);
    run(app, 1);
    Worn { cloth, joints }
}

/// What the renderer's skinning does to the mesh that an entity has, vertex by vertex: its positions in the world.
fn skinned(app: &App, worn: &Worn, mesh: &Mesh) -> Vec<Vec3> {
    let bindposes = [Mat4::IDENTITY, Mat4::from_translation(Vec3::Y * 0.5)];
    let pose = |i: usize| get::<GlobalTransform>(app, worn.joints[i]).affine() * Affine3A::from_mat4(bindposes[i]);
    let matrices = [pose(0), pose(1)];
    let (Some(VertexAttributeValues::Uint16x4(joints)), Some(VertexAttributeValues::Float32x4(weights))) =
        (mesh.attribute(Mesh::ATTRIBUTE_JOINT_INDEX), mesh.attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT))
    else {
        panic!("it has a skin")
    };
    let place = |((place, joints), weights): ((&Vec3, &[u16; 4]), &[f32; 4])| {
        let parts = joints.iter().zip(weights).filter(|(_, weight)| **weight > 0.0);
        parts.map(|(&joint, &weight)| matrices[usize::from(joint)].transform_point3(*place) * weight).sum()
    };
    points(mesh).iter().zip(joints).zip(weights).map(place).collect()
}

/// Turns and moves the joints as an animation would.
fn animate(app: &mut App, worn: &Worn, time: f32) {
    let mut first = get_mut::<Transform>(app, worn.joints[0]);
    first.translation = Vec3::new(3.0 * time, 2.0, 0.1 * ops::sin(9.0 * time));
    first.rotation = Quat::from_rotation_y(0.5 * ops::sin(5.0 * time));
    get_mut::<Transform>(app, worn.joints[1]).rotation = Quat::from_rotation_x(0.7 * ops::sin(7.0 * time));
}

#[test]
fn clothes_are_drawn_where_they_are_simulated_and_their_pins_as_the_body_beside_them() {
    for uneven in [false, true] {
        let mut app = headless();
        let mesh = dress(uneven);
        let worn = spawn_worn(&mut app, mesh.clone(), Transform::from_xyz(0.0, 2.0, 0.0), ());
        for frame in 1..40 {
            animate(&mut app, &worn, frame as f32 * STEP);
            run(&mut app, 1);
            let drawn = drawn(&app, worn.cloth);
            let (seen, body) = (skinned(&app, &worn, drawn), skinned(&app, &worn, &mesh));
            for (vertex, &seen) in (0..).zip(&seen) {
                assert_close(seen, place(&app, worn.cloth, vertex), 1e-4);
            }
            assert_eq!(seen[..SIDE], body[..SIDE], "pinned vertices have the bits of the skin alone");
            assert_ne!(seen[SIDE * SIDE - 1], body[SIDE * SIDE - 1], "the hem swings");
        }
    }
}

#[test]
fn normals_of_clothes_are_those_of_the_simulated_surface() {
    let mut app = headless();
    let turned =
        Transform::from_xyz(0.0, 2.0, 0.0).with_rotation(Quat::from_rotation_y(1.0)).with_scale(Vec3::splat(2.0));
    let worn = spawn_worn(&mut app, dress(false), turned, ());
    run(&mut app, 30);
    let state_normals: Vec<Vec3> = {
        let state = state(&app, worn.cloth);
        let mut normals = vec![Vec3::ZERO; state.particle_count()];
        for [a, b, c] in state.triangles() {
            let [p, q, r] = [a, b, c].map(|i| state.position(*i as usize).unwrap());
            [a, b, c].into_iter().for_each(|i| normals[*i as usize] += (q - p).cross(r - p));
        }
        normals.into_iter().map(Vec3::normalize).collect()
    };
    let normals = vec3s(drawn(&app, worn.cloth), Mesh::ATTRIBUTE_NORMAL);
    let joint = get::<GlobalTransform>(&app, worn.joints[1]).affine().matrix3.inverse().transpose();
    let hem = SIDE * SIDE - 5;
    let particle = state(&app, worn.cloth).particle_of_vertex(hem).unwrap();
    let seen = (joint * normals[hem]).normalize();
    assert!(seen.dot(state_normals[particle]).abs() > 0.9999, "{seen} for {}", state_normals[particle]);
}

#[test]
fn max_distances_hold_every_vertex_near_its_skin() {
    for uneven in [false, true] {
        let mut app = headless();
        let mesh = dress(uneven);
        let skin = ClothSkin { max_distance: ClothMap::Uniform(0.05), ..default() };
        let worn = spawn_worn(&mut app, mesh.clone(), Transform::from_xyz(0.0, 2.0, 0.0), skin);
        let mut farthest = 0.0_f32;
        for frame in 1..60 {
            animate(&mut app, &worn, frame as f32 * STEP);
            run(&mut app, 1);
            let body = skinned(&app, &worn, &mesh);
            for (vertex, &body) in body.iter().enumerate() {
                farthest = farthest.max(place(&app, worn.cloth, vertex as u32).distance(body));
            }
        }
        assert!(farthest < 0.05 + 1e-4, "{farthest} m");
        assert!(farthest > 0.045, "it would go farther: {farthest} m");
    }
}

#[test]
fn what_is_painted_zero_is_fixed_and_the_rest_may_go_as_far_as_painted() {
    let mut app = headless();
    let paint: Vec<f32> = points(&dress(false)).iter().map(|place| (0.2 * (-place.y - 0.3)).max(0.0)).collect();
    let mesh = dress(false).with_inserted_attribute(ATTRIBUTE_CLOTH, paint.clone());
    let worn = spawn_worn(&mut app, mesh.clone(), Transform::from_xyz(0.0, 2.0, 0.0), Pins::none());
    for frame in 1..60 {
        animate(&mut app, &worn, frame as f32 * STEP);
        run(&mut app, 1);
        let body = skinned(&app, &worn, &mesh);
        let seen = skinned(&app, &worn, drawn(&app, worn.cloth));
        for (vertex, &paint) in paint.iter().enumerate() {
            let distance = place(&app, worn.cloth, vertex as u32).distance(body[vertex]);
            assert!(distance < paint + 1e-4, "vertex {vertex}: {distance} m of {paint} m");
            assert!(paint > 0.0 || seen[vertex] == body[vertex], "vertex {vertex} is fixed");
        }
    }
}

#[test]
fn settings_of_the_skin_change_while_it_is_worn() {
    let mut app = headless();
    let mesh = dress(false);
    let worn = spawn_worn(&mut app, mesh.clone(), Transform::from_xyz(0.0, 2.0, 0.0), ());
    get_mut::<Transform>(&mut app, worn.joints[1]).rotation = Quat::from_rotation_x(FRAC_PI_2);
    run(&mut app, 60);
    let farthest = |app: &App| {
        let body = skinned(app, &worn, &mesh);
        let far = |(vertex, body): (usize, &Vec3)| place(app, worn.cloth, vertex as u32).distance(*body);
        body.iter().enumerate().map(far).fold(0.0, f32::max)
    };
    assert!(farthest(&app) > 0.2, "it hangs, and the legs are bent");
    for distance in [0.05, 0.0] {
        app.world_mut()
            .entity_mut(worn.cloth)
            .insert(ClothSkin { max_distance: ClothMap::Uniform(distance), ..default() });
        run(&mut app, 3);
        assert!(farthest(&app) < distance + 1e-4, "{} of {distance} m", farthest(&app));
    }
    app.world_mut().entity_mut(worn.cloth).insert(ClothSkin::default());
    run(&mut app, 60);
    assert!(farthest(&app) > 0.2);
}

#[test]
fn clothes_on_a_scaled_skeleton_are_as_large_as_it() {
    let mut app = headless();
    let worn = spawn_worn(&mut app, dress(false), Transform::from_xyz(0.0, 2.0, 0.0).with_scale(Vec3::splat(0.01)), ());
    run(&mut app, 60);
    let [top, bottom] = [0, SIDE * (SIDE - 1)].map(|vertex| place(&app, worn.cloth, vertex as u32));
    assert!((top.distance(bottom) - 0.01).abs() < 5e-4, "{}", top.distance(bottom));
    get_mut::<Transform>(&mut app, worn.joints[0]).scale = Vec3::splat(0.02);
    run(&mut app, 60);
    let [top, bottom] = [0, SIDE * (SIDE - 1)].map(|vertex| place(&app, worn.cloth, vertex as u32));
    assert!((top.distance(bottom) - 0.02).abs() < 1e-3, "{}", top.distance(bottom));
}

#[test]
fn clothes_are_teleported_with_their_skeleton() {
    let mut app = headless();
    let worn = spawn_worn(&mut app, dress(false), Transform::from_xyz(0.0, 2.0, 0.0), ());
    run(&mut app, 60);
    let before = points(drawn(&app, worn.cloth));
    *get_mut::<Transform>(&mut app, worn.joints[0]) =
        Transform::from_xyz(100.0, 2.0, 0.0).with_rotation(Quat::from_rotation_y(3.0));
    run(&mut app, 1);
    for (&now, before) in points(drawn(&app, worn.cloth)).iter().zip(before) {
        assert_close(now, before, 1e-3);
    }
}

#[test]
fn what_clothes_are_not_to_feel_takes_them_along() {
    let lag = |inertia: ClothInertia| {
        let mut app = headless();
        let worn = spawn_worn(&mut app, dress(false), Transform::from_xyz(0.0, 2.0, 0.0), inertia);
        run(&mut app, 60);
        let mut lag = 0.0_f32;
        for frame in 1..30 {
            get_mut::<Transform>(&mut app, worn.joints[0]).translation.x = 4.0 * frame as f32 * STEP;
            run(&mut app, 1);
            let hem = place(&app, worn.cloth, (SIDE * (SIDE - 1)) as u32);
            lag = lag.max(get::<Transform>(&app, worn.joints[0]).translation.x - 0.5 - hem.x);
        }
        lag
    };
    let [all, half, none] = [1.0, 0.5, 0.0].map(|linear| lag(ClothInertia { linear, ..default() }));
    let capped = lag(ClothInertia { max_speed: 2.0, ..default() });
    println!("the hem lags by {all} m, {half} m, {none} m; {capped} m");
    assert!(all > 0.1 && half < 0.7 * all && none < 0.01);
    assert!((capped - half).abs() < 0.02, "2 of 4 m/s are felt");
}

#[test]
fn a_joint_that_turns_about_itself_goes_no_way_however_far_the_origin_of_its_mesh_is() {
    let hem = |height: f32, linear: f32| {
        let mut app = headless();
        let inertia = ClothInertia { linear, ..default() };
        let worn = spawn_worn_above(&mut app, dress(false), height, Transform::from_xyz(0.0, 2.0, 0.0), inertia);
        for frame in 1..30 {
            let turn = Quat::from_rotation_x(0.5 * ops::sin(6.0 * frame as f32 * STEP));
            get_mut::<Transform>(&mut app, worn.joints[0]).rotation = turn;
            run(&mut app, 1);
        }
        place(&app, worn.cloth, (SIDE * (SIDE - 1)) as u32)
    };
    let all = hem(0.0, 1.0);
    for (height, linear) in [(0.0, 0.0), (2.0, 1.0), (2.0, 0.0)] {
        assert_close(hem(height, linear), all, 1e-3);
    }
}

#[test]
fn clothes_lose_their_skeleton_or_their_skin_and_go_on_without() {
    let mut app = headless();
    let worn = spawn_worn(&mut app, dress(false), Transform::from_xyz(0.0, 2.0, 0.0), ());
    let near = ClothSkin { max_distance: ClothMap::Uniform(0.01), ..default() };
    app.world_mut().entity_mut(worn.cloth).insert(near);
    get_mut::<Transform>(&mut app, worn.joints[1]).rotation = Quat::from_rotation_x(FRAC_PI_2);
    run(&mut app, 60);
    let hem = |app: &App| place(app, worn.cloth, (SIDE * SIDE - 5) as u32);
    let held = hem(&app);
    app.world_mut().entity_mut(worn.cloth).remove::<ClothSkin>();
    run(&mut app, 60);
    assert!(held.distance(hem(&app)) > 0.1, "it hangs by its pins alone");
    app.world_mut().entity_mut(worn.cloth).remove::<SkinnedMesh>();
    for _ in 0..3 {
        assert!(!drawn(&app, worn.cloth).contains_attribute(Mesh::ATTRIBUTE_JOINT_INDEX), "or drawing it ends the app");
        run(&mut app, 1);
    }
    assert_eq!(*get::<ClothStatus>(&app, worn.cloth), ClothStatus::Ready);
    assert_close(place(&app, worn.cloth, 0), Vec3::new(-0.5, 0.0, 0.0), 1e-3);
}

#[test]
fn a_joint_of_no_size_that_nothing_is_bound_to_stops_no_drawing() {
    let mut app = headless();
    let mesh =
        dress(false).with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, vec![[1.0, 0.0, 0.0, 0.0]; SIDE * SIDE]);
    let worn = spawn_worn(&mut app, mesh, Transform::from_xyz(0.0, 2.0, 0.0), ());
    get_mut::<Transform>(&mut app, worn.joints[1]).scale = Vec3::ZERO;
    run(&mut app, 2);
    let before = points(drawn(&app, worn.cloth));
    animate(&mut app, &worn, 0.1);
    run(&mut app, 5);
    assert_ne!(before, points(drawn(&app, worn.cloth)));
}

#[test]
fn a_lost_joint_leaves_clothes_where_they_are_and_is_told_of_once() {
    let mut quiet = Quiet::new();
    let worn = spawn_worn(&mut quiet.app, dress(false), Transform::from_xyz(0.0, 2.0, 0.0), ());
    quiet.run(10);
    quiet.app.world_mut().despawn(worn.joints[1]);
    let said: Vec<String> = quiet.run(30).into_iter().filter(|line| line.contains("lost a joint")).collect();
    assert_eq!(said.len(), 1, "{said:?}");
    assert!((place(&quiet.app, worn.cloth, 0) - Vec3::new(-0.5, 2.0, 0.0)).length() < 1e-3);
}

#[test]
fn clothes_that_nothing_holds_and_bad_paint_are_told_of() {
    let mut quiet = Quiet::new();
    let worn = spawn_worn(&mut quiet.app, dress(false), Transform::default(), Pins::none());
    let warned = quiet.run(3);
    assert!(warned.is_empty() || warned.iter().any(|line| line.contains("fall off")), "{warned:?}");
    let mut paint = vec![0.1; SIDE * SIDE];
    paint[7] = f32::NAN;
    let painted = dress(false).with_inserted_attribute(ATTRIBUTE_CLOTH, paint);
    get_mut::<Mesh3d>(&mut quiet.app, worn.cloth).0 = add_mesh(&mut quiet.app, painted);
    let said = quiet.run(3);
    assert!(said.iter().any(|line| line.contains("vertex 7")), "{said:?}");
    assert_eq!(*get::<ClothStatus>(&quiet.app, worn.cloth), ClothStatus::Ready);
}

#[test]
fn a_skeleton_of_too_few_joints_is_refused_and_one_that_fits_is_taken() {
    let mut app = headless();
    let worn = spawn_worn(&mut app, dress(false), Transform::default(), ());
    get_mut::<SkinnedMesh>(&mut app, worn.cloth).joints.truncate(1);
    run(&mut app, 2);
    let status = get::<ClothStatus>(&app, worn.cloth);
    assert!(matches!(status, ClothStatus::Failed(ClothError::Skeleton { needed: 2, found: 1 })), "{status:?}");
    get_mut::<SkinnedMesh>(&mut app, worn.cloth).joints = worn.joints.to_vec();
    run(&mut app, 2);
    assert_eq!(*get::<ClothStatus>(&app, worn.cloth), ClothStatus::Ready);
}

#[test]
fn a_skin_that_is_out_of_range_leaves_the_one_before_and_pins_that_change_with_it_are_read() {
    let mut quiet = Quiet::new();
    let skin = ClothSkin { max_distance: ClothMap::Uniform(0.05), ..default() };
    let worn = spawn_worn(&mut quiet.app, dress(true), Transform::from_xyz(0.0, 2.0, 0.0), skin);
    let bad = ClothSkin { max_distance: ClothMap::Uniform(f32::NAN), ..default() };
    let pins = Pins::edge(ClothEdge::Top).and(Pins::edge(ClothEdge::Left));
    quiet.app.world_mut().entity_mut(worn.cloth).insert((bad, pins));
    let said = quiet.run(40);
    assert_eq!(said.len(), 1, "{said:?}");
    assert_eq!(pinned(&quiet.app, worn.cloth).len(), 2 * SIDE - 1);
    let held = skinned(&quiet.app, &worn, &dress(true));
    for (vertex, held) in (0..).zip(held) {
        assert_close(place(&quiet.app, worn.cloth, vertex), held, 0.0501);
    }
}

#[test]
fn clothes_of_an_entity_of_no_size_are_drawn_on_their_skeleton() {
    let mut app = headless();
    let flat = Transform::from_scale(Vec3::new(1.0, 0.0, 1.0));
    let worn = spawn_worn(&mut app, dress(true), Transform::from_xyz(0.0, 2.0, 0.0), flat);
    for frame in 1..20 {
        animate(&mut app, &worn, frame as f32 * STEP);
        run(&mut app, 1);
    }
    let seen = skinned(&app, &worn, drawn(&app, worn.cloth));
    for (vertex, seen) in (0..).zip(seen) {
        assert_close(seen, place(&app, worn.cloth, vertex), 1e-4);
    }
}
