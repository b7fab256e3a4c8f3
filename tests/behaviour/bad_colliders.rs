//! What can't be a collider of triangles is left out, and one warning says why and what to do.

use std::{thread, time::Duration};

use bevy::{
    asset::RenderAssetUsages,
    mesh::{
        Indices, PrimitiveTopology, VertexAttributeValues,
        skinning::{SkinnedMesh, SkinnedMeshInverseBindposes},
    },
    prelude::*,
};
use bevy_drape::{Obstacles, prelude::*};

use crate::{common::*, quiet::Quiet};

fn bare(topology: PrimitiveTopology, positions: &[[f32; 3]]) -> Mesh {
    Mesh::new(topology, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions.to_vec())
}

fn triangle(third: [f32; 3]) -> Mesh {
    bare(PrimitiveTopology::TriangleList, &[[0.0; 3], [1.0, 0.0, 0.0], third])
}

fn spawn(app: &mut App, mesh: impl Into<Mesh>, more: impl Bundle) -> Entity {
    let mesh = add_mesh(app, mesh);
    app.world_mut().spawn((Mesh3d(mesh), more)).id()
}

fn obstacle_count(quiet: &Quiet) -> usize {
    quiet.app.world().resource::<Obstacles>().iter().len()
}

/// Expects one warning with all these words, whatever else happens, and no obstacle.
#[track_caller]
fn assert_refused(quiet: &mut Quiet, entity: Entity, words: &[&str]) {
    let said = quiet.run(20);
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said[0].contains(&format!("collider {entity} is left out: ")), "{said:?}");
    assert!(words.iter().all(|word| said[0].contains(word)), "{said:?}");
    assert_eq!(obstacle_count(quiet), 0);
}

#[test]
fn meshes_without_a_surface_are_refused() {
    let line = bare(PrimitiveTopology::LineList, &[[0.0; 3], [1.0; 3]]);
    let nothing = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default());
    let out_of_range = triangle([0.0, 1.0, 0.0]).with_inserted_indices(Indices::U32(vec![0, 1, 7]));
    let mut on_gpu = triangle([0.0, 1.0, 0.0]);
    on_gpu.asset_usage = RenderAssetUsages::RENDER_WORLD;
    let bad = [
        (line, "LineList"),
        (nothing, "no positions"),
        (triangle([2.0, 0.0, 0.0]), "no triangle with an area"),
        (triangle([0.0, f32::NAN, 0.0]), "vertex 2 isn't finite"),
        (out_of_range, "vertex 7"),
        (on_gpu, "render world"),
    ];
    for (mesh, words) in bad {
        for collider in [ClothCollider::mesh(), ClothCollider::convex_hull()] {
            // The hull of what has no area is flat.
            let words =
                if collider == ClothCollider::convex_hull() && words.contains("area") { "one plane" } else { words };
            let mut quiet = Quiet::new();
            let entity = spawn(&mut quiet.app, mesh.clone(), collider);
            assert_refused(&mut quiet, entity, &[words]);
        }
    }
}

#[test]
fn differences_that_do_not_fit_into_an_f32_are_none() {
    let mut quiet = Quiet::new();
    let tiny = bare(PrimitiveTopology::TriangleList, &[[0.0; 3], [1e-37, 0.0, 0.0], [0.0, 1e-37, 0.0]]);
    let entity = spawn(&mut quiet.app, tiny, ClothCollider::mesh());
    assert_refused(&mut quiet, entity, &["no triangle with an area"]);
    // One over the other, nearer than any number tells.
    let places = [[-1.0, -1.0], [1.0, -1.0], [0.0, 1.0]];
    let places: Vec<[f32; 3]> = [0.0, 1e-39, 2e-39].iter().flat_map(|&z| places.map(|[x, y]| [x, y, z])).collect();
    let stacked = bare(PrimitiveTopology::TriangleList, &places);
    get_mut::<ClothCollider>(&mut quiet.app, entity).shape = ClothCollider::from(Sphere::new(0.1)).shape;
    spawn(&mut quiet.app, stacked, ClothCollider::mesh());
    assert_eq!(quiet.run(3), Vec::<String>::new());
    assert_eq!(obstacle_count(&quiet), 2);
}

#[test]
fn meshes_that_are_too_far_away_to_compute_with_are_refused() {
    for collider in [ClothCollider::mesh(), ClothCollider::convex_hull()] {
        let mesh = Mesh::from(Cuboid::default()).translated_by(Vec3::X * 1e30);
        let mut quiet = Quiet::new();
        let entity = spawn(&mut quiet.app, mesh, collider);
        assert_refused(&mut quiet, entity, &["m from the mesh's origin"]);
    }
}

#[test]
fn a_hull_of_what_is_flat_is_refused() {
    let mut quiet = Quiet::new();
    let entity = spawn(&mut quiet.app, Plane3d::default(), ClothCollider::convex_hull());
    assert_refused(&mut quiet, entity, &["one plane", "ClothCollider::mesh"]);
    get_mut::<ClothCollider>(&mut quiet.app, entity).shape = ColliderShape::Mesh(None);
    assert_eq!(quiet.run(3), Vec::<String>::new());
    assert_eq!(obstacle_count(&quiet), 1, "as a mesh it is fine");
}

#[test]
fn transforms_without_a_size_or_a_number_are_refused_until_they_have_one() {
    for (bad, words) in [
        (Transform::from_scale(Vec3::new(1.0, 0.0, 1.0)), "finite and not zero"),
        (Transform::from_scale(Vec3::splat(f32::INFINITY)), "finite and not zero"),
        (Transform::from_xyz(0.0, f32::NAN, 0.0), "finite values"),
    ] {
        let mut quiet = Quiet::new();
        let entity = spawn(&mut quiet.app, Sphere::new(0.5), (ClothCollider::mesh(), bad));
        assert_refused(&mut quiet, entity, &[words]);
        *get_mut::<Transform>(&mut quiet.app, entity) = Transform::from_xyz(0.0, 1.0, 0.0);
        assert_eq!(quiet.run(3), Vec::<String>::new());
        assert_eq!(obstacle_count(&quiet), 1);
        *get_mut::<Transform>(&mut quiet.app, entity) = bad;
        assert_refused(&mut quiet, entity, &[words]);
    }
}

#[test]
fn a_friction_that_is_not_a_number_is_refused() {
    let mut quiet = Quiet::new();
    let collider = ClothCollider { friction: f32::NAN, ..ClothCollider::mesh() };
    let entity = spawn(&mut quiet.app, Sphere::new(0.5), collider);
    assert_refused(&mut quiet, entity, &["friction"]);
}

#[test]
fn height_fields_that_are_none_are_refused() {
    let field = |columns, heights| HeightField { size: Vec2::ONE, columns, heights };
    let bad = [
        (field(0, vec![]), "0 heights in 0 columns"),
        (field(2, vec![0.0; 5]), "5 heights in 2 columns"),
        (field(4, vec![0.0; 4]), "4 heights in 4 columns"),
        (field(2, vec![0.0, 1.0, f32::NAN, 0.0]), "finite values"),
        (HeightField { size: Vec2::new(1.0, -1.0), ..default() }, "a size greater than zero"),
    ];
    for (field, words) in bad {
        let mut quiet = Quiet::new();
        let entity = quiet.app.world_mut().spawn(ClothCollider::from(field)).id();
        assert_refused(&mut quiet, entity, &[words]);
    }
}

#[test]
fn a_mesh_that_is_mended_works() {
    let mut quiet = Quiet::new();
    let entity = spawn(&mut quiet.app, triangle([2.0, 0.0, 0.0]), ClothCollider::mesh());
    assert_refused(&mut quiet, entity, &["area"]);
    let handle = get::<Mesh3d>(&quiet.app, entity).0.clone();
    let mut meshes = quiet.app.world_mut().resource_mut::<Assets<Mesh>>();
    *meshes.get_mut(&handle).unwrap() = triangle([0.0, 1.0, 0.0]);
    assert_eq!(quiet.run(3), Vec::<String>::new());
    assert_eq!(obstacle_count(&quiet), 1);
    let mut meshes = quiet.app.world_mut().resource_mut::<Assets<Mesh>>();
    *meshes.get_mut(&handle).unwrap() = triangle([0.0, f32::NAN, 0.0]);
    assert_refused(&mut quiet, entity, &["isn't finite"]);
}

#[test]
fn a_cloth_does_not_collide_with_itself_that_way() {
    let mut quiet = Quiet::new();
    let cloth = spawn_cloth(&mut quiet.app, ClothGrid::new(1.0, 1.0, 30, 30), ClothCollider::mesh());
    assert_refused(&mut quiet, cloth, &["a cloth's", "ClothCollider::mesh_of"]);
    let drawn = get::<Mesh3d>(&quiet.app, cloth).0.clone();
    quiet.app.world_mut().entity_mut(cloth).remove::<ClothCollider>();
    let other = quiet.app.world_mut().spawn(ClothCollider::convex_hull_of(drawn)).id();
    assert_refused(&mut quiet, other, &["a cloth's"]);
    // A cloth may carry another mesh, and what was a cloth is a mesh like others.
    let ball = add_mesh(&mut quiet.app, Sphere::new(0.1));
    quiet.app.world_mut().entity_mut(cloth).insert(ClothCollider::mesh_of(ball));
    assert_eq!(quiet.run(3), Vec::<String>::new());
    assert_eq!(obstacle_count(&quiet), 1);
    quiet.app.world_mut().entity_mut(cloth).insert(ClothCollider::mesh()).remove::<Cloth>();
    quiet.app.world_mut().despawn(other);
    quiet.run(3);
    assert_eq!(obstacle_count(&quiet), 1);
}

#[test]
fn an_entity_without_a_mesh_is_told_of_and_waited_for() {
    let mut quiet = Quiet::new();
    let entity = quiet.app.world_mut().spawn(ClothCollider::mesh()).id();
    assert_refused(&mut quiet, entity, &["no Mesh3d", "waits"]);
    let mesh = add_mesh(&mut quiet.app, Sphere::new(0.5));
    quiet.app.world_mut().entity_mut(entity).insert(Mesh3d(mesh));
    assert_eq!(quiet.run(3), Vec::<String>::new());
    assert_eq!(obstacle_count(&quiet), 1);
}

#[test]
fn a_mesh_that_is_on_its_way_is_waited_for_in_silence() {
    let mut quiet = Quiet::new();
    let handle = quiet.app.world().resource::<Assets<Mesh>>().reserve_handle();
    quiet.app.world_mut().spawn((Mesh3d(handle), ClothCollider::mesh()));
    assert_eq!(quiet.run(20), Vec::<String>::new());
    assert_eq!(obstacle_count(&quiet), 0);
}

#[test]
fn a_mesh_that_fails_to_load_is_told_of_once() {
    let mut quiet = Quiet::new();
    let handle = quiet.app.world().resource::<AssetServer>().load("no such file.mesh");
    let entity = quiet.app.world_mut().spawn(ClothCollider::mesh_of(handle.clone())).id();
    let mut said = Vec::new();
    for _ in 0..1000 {
        said.extend(quiet.run(1).into_iter().filter(|line| line.contains("collider")));
        if !said.is_empty() {
            break;
        }
        thread::sleep(Duration::from_millis(2));
    }
    said.extend(quiet.run(5));
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said[0].contains(&format!("{entity} is left out: the mesh couldn't be loaded")), "{said:?}");
    quiet.app.world_mut().resource_mut::<Assets<Mesh>>().insert(&handle, Sphere::new(0.5).into()).unwrap();
    quiet.run(2);
    assert_eq!(obstacle_count(&quiet), 1);
}

#[test]
fn skeletons_that_do_not_fit_are_refused() {
    let skinned = |joint: u16| {
        let joints = VertexAttributeValues::Uint16x4(vec![[joint, 0, 0, 0]; 24]);
        Mesh::from(Cuboid::default())
            .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_INDEX, joints)
            .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, vec![[1.0, 0.0, 0.0, 0.0]; 24])
    };
    for (joint, bindposes, bones, words) in [
        (2, 3, 2, "follows 3 joints, of which its SkinnedMesh has 2"),
        (2, 1, 3, "follows 3 joints, of which its SkinnedMesh has 1"),
        (0, 1, 0, "has 0"),
    ] {
        let mut quiet = Quiet::new();
        let joints: Vec<Entity> = (0..bones).map(|_| quiet.app.world_mut().spawn(Transform::default()).id()).collect();
        let mut all = quiet.app.world_mut().resource_mut::<Assets<SkinnedMeshInverseBindposes>>();
        let skeleton = SkinnedMesh { inverse_bindposes: all.add(vec![Mat4::IDENTITY; bindposes]), joints };
        let entity = spawn(&mut quiet.app, skinned(joint), (ClothCollider::mesh(), skeleton));
        assert_refused(&mut quiet, entity, &[words]);
    }
}

#[test]
fn a_joint_that_goes_or_is_no_number_takes_the_collider_along() {
    let mut quiet = Quiet::new();
    let joints = [(); 2].map(|()| quiet.app.world_mut().spawn(Transform::default()).id());
    let mesh = Mesh::from(Cuboid::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_INDEX, VertexAttributeValues::Uint16x4(vec![[0, 1, 0, 0]; 24]))
        .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, vec![[0.5, 0.5, 0.0, 0.0]; 24]);
    let mut all = quiet.app.world_mut().resource_mut::<Assets<SkinnedMeshInverseBindposes>>();
    let skeleton = SkinnedMesh { inverse_bindposes: all.add(vec![Mat4::IDENTITY; 2]), joints: joints.to_vec() };
    let entity = spawn(&mut quiet.app, mesh, (ClothCollider::mesh(), skeleton));
    assert_eq!(quiet.run(2), Vec::<String>::new());
    assert_eq!(obstacle_count(&quiet), 1);
    get_mut::<Transform>(&mut quiet.app, joints[1]).translation.x = f32::NAN;
    assert_refused(&mut quiet, entity, &["finite values"]);
    get_mut::<Transform>(&mut quiet.app, joints[1]).translation.x = 0.0;
    assert_eq!(quiet.run(2), Vec::<String>::new());
    assert_eq!(obstacle_count(&quiet), 1);
    quiet.app.world_mut().despawn(joints[1]);
    assert_refused(&mut quiet, entity, &["follows 2 joints, of which its SkinnedMesh has 1"]);
}
