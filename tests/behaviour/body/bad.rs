//! Bodies that can't be made say so once, and do no harm.

use bevy::{
    mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes},
    prelude::*,
};
use bevy_drape::prelude::*;

use super::limb::{self, names, spawn, spawn_body};
use crate::{common::*, quiet::Quiet};

/// Runs long enough that waiting ends, and returns the only warning.
#[track_caller]
fn only_warning(quiet: &mut Quiet, body: Entity) -> String {
    let said = quiet.run(330);
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said[0].contains(&body.to_string()), "{said:?}");
    said[0].clone()
}

#[test]
fn settings_out_of_range_are_refused_once_and_what_there_was_stays() {
    let mut quiet = Quiet::new();
    let limb = spawn_body(&mut quiet.app, Transform::default());
    assert!(quiet.run(2).is_empty());
    for (bad, field) in [
        (ClothBody { cover: f32::NAN, ..default() }, "ClothBody::cover"),
        (ClothBody { cover: 1.5, ..default() }, "ClothBody::cover"),
        (ClothBody { smallest: f32::NAN, ..default() }, "ClothBody::smallest"),
        (ClothBody { smallest: -0.1, ..default() }, "ClothBody::smallest"),
    ] {
        assert!(bad.validate().is_err());
        quiet.app.world_mut().entity_mut(limb.root).insert(bad);
        assert!(only_warning(&mut quiet, limb.root).contains(field));
        assert_eq!(names(&mut quiet.app, limb.root), ["lower", "upper"]);
    }
    quiet.app.world_mut().entity_mut(limb.root).insert(ClothBody { smallest: 0.0, ..default() });
    assert!(quiet.run(2).is_empty());
    assert_eq!(names(&mut quiet.app, limb.root).len(), 3);
}

#[test]
fn a_body_without_a_skin_is_told_of_and_still_waits() {
    let mut quiet = Quiet::new();
    let limb = spawn_body(&mut quiet.app, Transform::default());
    let skeleton = quiet.app.world_mut().entity_mut(limb.mesh).take::<SkinnedMesh>().expect("it has one");
    assert!(quiet.run(60).is_empty(), "it may still come");
    assert!(only_warning(&mut quiet, limb.root).contains("no skinned mesh"));
    quiet.app.world_mut().entity_mut(limb.mesh).insert(skeleton);
    assert!(quiet.run(2).is_empty());
    assert_eq!(names(&mut quiet.app, limb.root), ["lower", "upper"]);
}

#[test]
fn a_mesh_without_weights_is_told_of() {
    let mut quiet = Quiet::new();
    let limb = spawn_body(&mut quiet.app, Transform::default());
    let bare = limb::mesh().with_removed_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT);
    get_mut::<Mesh3d>(&mut quiet.app, limb.mesh).0 = add_mesh(&mut quiet.app, bare);
    assert!(only_warning(&mut quiet, limb.root).contains("weights"));
    assert!(names(&mut quiet.app, limb.root).is_empty());
}

#[test]
fn one_joint_is_a_body_too() {
    let mut quiet = Quiet::new();
    let limb = spawn(&mut quiet.app, Transform::default());
    let all = bevy::mesh::VertexAttributeValues::Uint16x4(vec![[0; 4]; limb::mesh().count_vertices()]);
    let mesh = limb::mesh().with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_INDEX, all);
    get_mut::<Mesh3d>(&mut quiet.app, limb.mesh).0 = add_mesh(&mut quiet.app, mesh);
    get_mut::<SkinnedMesh>(&mut quiet.app, limb.mesh).joints.truncate(1);
    quiet.app.world_mut().entity_mut(limb.root).insert(ClothBody::default());
    assert!(quiet.run(2).is_empty());
    assert_eq!(names(&mut quiet.app, limb.root), ["upper"]);
}

#[test]
fn skin_without_any_size_has_no_capsule() {
    let flat = |size: Vec3| {
        let mut mesh = limb::mesh();
        let places: Vec<[f32; 3]> = points(&mesh).into_iter().map(|place| (place * size).to_array()).collect();
        mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, places);
        mesh
    };
    for mesh in [flat(Vec3::ZERO), flat(Vec3::splat(1e-30)), flat(Vec3::new(0.0, 1.0, 0.0))] {
        let mut quiet = Quiet::new();
        let limb = spawn_body(&mut quiet.app, Transform::default());
        get_mut::<Mesh3d>(&mut quiet.app, limb.mesh).0 = add_mesh(&mut quiet.app, mesh);
        assert!(only_warning(&mut quiet, limb.root).contains("ClothBody::smallest"));
        assert!(names(&mut quiet.app, limb.root).is_empty());
    }
}

#[test]
fn joints_that_are_missing_are_told_of_and_the_others_have_capsules() {
    let mut quiet = Quiet::new();
    let limb = spawn(&mut quiet.app, Transform::default());
    quiet.app.world_mut().despawn(limb.joints[1]);
    quiet.app.world_mut().entity_mut(limb.root).insert(ClothBody::default());
    assert!(only_warning(&mut quiet, limb.root).contains("2 are missing"));
    assert_eq!(names(&mut quiet.app, limb.root), ["upper"]);
}

#[test]
fn places_and_bind_poses_that_are_no_numbers_do_no_harm() {
    let mut quiet = Quiet::new();
    let limb = spawn_body(&mut quiet.app, Transform::from_scale(Vec3::NAN));
    let poses = vec![Mat4::NAN, Mat4::ZERO, Mat4::from_scale(Vec3::splat(1e30))];
    let poses = quiet.app.world_mut().resource_mut::<Assets<SkinnedMeshInverseBindposes>>().add(poses);
    get_mut::<SkinnedMesh>(&mut quiet.app, limb.mesh).inverse_bindposes = poses;
    let said = quiet.run(330);
    assert!(said.iter().all(|warning| warning.contains("collider") || warning.contains("cloth body")), "{said:?}");
    assert!(said.len() <= 3, "{said:?}");

    let mut mesh = limb::mesh();
    let mut places: Vec<[f32; 3]> = points(&mesh).into_iter().map(|place| place.to_array()).collect();
    places[5] = [f32::NAN; 3];
    mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, places);
    let mut quiet = Quiet::new();
    let limb = spawn_body(&mut quiet.app, Transform::default());
    get_mut::<Mesh3d>(&mut quiet.app, limb.mesh).0 = add_mesh(&mut quiet.app, mesh);
    assert!(only_warning(&mut quiet, limb.root).contains("vertex 5"));
}
