//! The capsules of a mannequin lie where its skin is, at rest and bent.

use std::collections::HashMap;

use bevy::{
    mesh::{
        VertexAttributeValues,
        skinning::{SkinnedMesh, SkinnedMeshInverseBindposes},
    },
    prelude::*,
};
use bevy_drape::{Obstacles, prelude::*};

use super::limb::{distance, names};
use crate::{common::*, mannequin::spawned_with};

/// What it wears.
const CLOTHES: [&str; 4] = ["Cape", "CapeFine", "Skirt", "Tunic"];

/// The mannequin with a body, and its root.
fn embodied() -> (App, Entity) {
    let mut app = spawned_with(ClothPlugin::new(Update));
    let mut roots = app.world_mut().query_filtered::<Entity, (With<Children>, Without<ChildOf>)>();
    let root = roots.single(app.world()).expect("one scene");
    // Of all of its limbs, not only of those that its file asks for.
    let mut bodies = app.world_mut().query_filtered::<Entity, With<ClothBody>>();
    for body in bodies.iter(app.world()).collect::<Vec<_>>() {
        app.world_mut().entity_mut(body).remove::<ClothBody>();
    }
    let except = CLOTHES.map(String::from).to_vec();
    app.world_mut().entity_mut(root).insert(ClothBody { except, ..default() });
    run(&mut app, 1);
    (app, root)
}

/// Where the skin of the body is in the world.
fn skin(app: &mut App) -> Vec<Vec3> {
    let mut meshes = app.world_mut().query::<(&Mesh3d, &SkinnedMesh, &ChildOf)>();
    let body = meshes.iter(app.world()).find(|(.., node)| get::<Name>(app, node.parent()).as_str() == "Body");
    let (mesh, skeleton, _) = body.expect("a body");
    let mesh = app.world().resource::<Assets<Mesh>>().get(&mesh.0).expect("a mesh");
    let bind = app.world().resource::<Assets<SkinnedMeshInverseBindposes>>().get(&skeleton.inverse_bindposes);
    let bind = bind.expect("bind poses");
    let pose = |i: usize| get::<GlobalTransform>(app, skeleton.joints[i]).to_matrix() * bind[i];
    let poses: Vec<Mat4> = (0..skeleton.joints.len()).map(pose).collect();
    let (Some(VertexAttributeValues::Uint16x4(joints)), Some(VertexAttributeValues::Float32x4(weights))) =
        (mesh.attribute(Mesh::ATTRIBUTE_JOINT_INDEX), mesh.attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT))
    else {
        panic!("it has a skin")
    };
    let place = |((place, joints), weights): ((Vec3, &[u16; 4]), &[f32; 4])| {
        let parts = joints.iter().zip(weights);
        parts.map(|(&joint, &weight)| poses[usize::from(joint)].transform_point3(place) * weight).sum()
    };
    points(mesh).into_iter().zip(joints).zip(weights).map(place).collect()
}

/// How far each vertex of the skin sticks out of all capsules, m, in rising order.
fn distances(app: &mut App) -> Vec<f32> {
    let skin = skin(app);
    let obstacles = app.world().resource::<Obstacles>();
    let nearest = |place| obstacles.iter().map(|(.., it)| distance(it, place)).fold(f32::INFINITY, f32::min);
    let mut distances: Vec<f32> = skin.into_iter().map(nearest).collect();
    distances.sort_unstable_by(f32::total_cmp);
    distances
}

/// The share of the skin that sticks out more than 15 mm; prints how far it does.
fn share_outside(app: &mut App, pose: &str) -> f32 {
    let distances = distances(app);
    let at = |share: f32| distances[(share * (distances.len() - 1) as f32) as usize] * 1000.0;
    let share =
        |limit: f32| distances.iter().filter(|distance| **distance > limit).count() as f32 / distances.len() as f32;
    println!(
        "{pose}: of {} vertices {:.1} % stick out more than 15 mm, {:.1} % at all; 1 % {:.0}, 5 % {:.0}, half {:.0}, \
         95 % {:.0}, 99 % {:.0} mm, all {:.0} mm",
        distances.len(),
        100.0 * share(0.015),
        100.0 * share(0.0),
        at(0.01),
        at(0.05),
        at(0.5),
        at(0.95),
        at(0.99),
        at(1.0),
    );
    share(0.015)
}

fn turn(app: &mut App, joints: &HashMap<String, Entity>, turns: &[(&str, Vec3)]) {
    for &(name, angles) in turns {
        let turn = Quat::from_euler(EulerRot::XYZ, angles.x, angles.y, angles.z);
        get_mut::<Transform>(app, joints[name]).rotation *= turn;
    }
    run(app, 2);
}

#[test]
fn little_of_a_mannequins_skin_is_outside_of_its_capsules() {
    let (mut app, root) = embodied();
    let names = names(&mut app, root);
    println!("{} capsules: {}", names.len(), names.join(", "));
    for big in ["pelvis", "spine", "chest", "head", "thigh.L", "thigh.R", "shin.L", "upper_arm.R", "lower_arm.L"] {
        assert!(names.iter().any(|name| name == big), "{big} has none");
    }
    assert!(share_outside(&mut app, "at rest") < 0.1);
    let mut named = app.world_mut().query_filtered::<(&Name, Entity), Without<Mesh3d>>();
    let joints: HashMap<String, Entity> =
        named.iter(app.world()).map(|(name, entity)| (name.to_string(), entity)).collect();
    let bent = [
        ("thigh.L", Vec3::new(-1.2, 0.0, 0.0)),
        ("shin.L", Vec3::new(1.4, 0.0, 0.0)),
        ("upper_arm.R", Vec3::new(0.5, 0.0, 0.6)),
        ("lower_arm.R", Vec3::new(-1.2, 0.0, 0.0)),
        ("spine", Vec3::new(0.3, 0.2, 0.0)),
    ];
    turn(&mut app, &joints, &bent);
    assert!(share_outside(&mut app, "bent") < 0.1);
}

#[test]
fn its_capsules_arent_far_outside_of_its_skin() {
    let (mut app, _) = embodied();
    let skin = skin(&mut app);
    // What is deep inside of a capsule of its own would be skin that clothes stand off.
    let distances = distances(&mut app);
    let deep = distances.iter().filter(|distance| **distance < -0.05).count() as f32 / skin.len() as f32;
    println!("{:.1} % of the skin is deeper than 50 mm inside", 100.0 * deep);
    assert!(deep < 0.05);
}

#[test]
fn the_same_skin_gives_the_same_bits() {
    let parts = || {
        let (mut app, _) = embodied();
        let mut parts = app.world_mut().query::<(&Name, &ClothCollider, &Transform)>();
        let mut all: Vec<String> =
            parts.iter(app.world()).map(|(name, collider, place)| format!("{name} {collider:?} {place:?}")).collect();
        all.sort();
        all
    };
    assert_eq!(parts(), parts());
}
