//! Outfits: clothes that are put on another entity's skeleton, and taken off.

use bevy::{
    mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes},
    prelude::*,
};
use bevy_drape::prelude::*;

use crate::{
    common::*,
    quiet::Quiet,
    worn::{SIDE, dress},
};

/// Two named joints below an entity, the second half a metre below the first.
fn spawn_joints(app: &mut App, root: Entity, names: [&str; 2]) -> [Entity; 2] {
    let [first, second] = names.map(|name| Name::new(name.to_owned()));
    let first = app.world_mut().spawn((first, Transform::default(), ChildOf(root))).id();
    let second = app.world_mut().spawn((second, Transform::from_xyz(0.0, -0.5, 0.0), ChildOf(first))).id();
    [first, second]
}

fn spawn_character(app: &mut App, place: Transform) -> (Entity, [Entity; 2]) {
    let root = app.world_mut().spawn(place).id();
    let joints = spawn_joints(app, root, ["neck", "hips"]);
    (root, joints)
}

/// Clothes on a skeleton of their own, whose joints come in another order in the hierarchy than in the mesh.
fn spawn_clothes(app: &mut App, names: [&str; 2], place: Transform) -> (Entity, Entity, [Entity; 2]) {
    let root = app.world_mut().spawn(place).id();
    let joints = spawn_joints(app, root, names);
    let bindposes = vec![Mat4::IDENTITY, Mat4::from_translation(Vec3::Y * 0.5)];
    let bindposes = SkinnedMeshInverseBindposes::from(bindposes);
    let inverse_bindposes = app.world_mut().resource_mut::<Assets<SkinnedMeshInverseBindposes>>().add(bindposes);
    let skeleton = SkinnedMesh { inverse_bindposes, joints: joints.to_vec() };
    let cloth = spawn_cloth(app, dress(true), (skeleton, stiff(), Pins::edge(ClothEdge::Top), ChildOf(root)));
    (root, cloth, joints)
}

/// Where the clothes' upper edge is in the world: its middle.
fn collar(app: &App, cloth: Entity) -> Vec3 {
    place(app, cloth, SIDE as u32 / 2)
}

#[test]
fn clothes_are_put_on_and_taken_off_while_running() {
    let mut app = headless();
    let (clothes, cloth, own) = spawn_clothes(&mut app, ["neck", "hips"], Transform::from_xyz(-5.0, 1.0, 0.0));
    let (character, joints) = spawn_character(&mut app, Transform::from_xyz(3.0, 2.0, 0.0));
    run(&mut app, 3);
    assert_close(collar(&app, cloth), Vec3::new(-5.0, 1.0, 0.0), 1e-4);
    app.world_mut().entity_mut(clothes).insert(ClothWornBy(character));
    for frame in 0..20 {
        get_mut::<Transform>(&mut app, character).translation.x += 0.02 * frame as f32;
        run(&mut app, 1);
    }
    assert_eq!(get::<SkinnedMesh>(&app, cloth).joints, joints);
    assert_close(collar(&app, cloth), get::<GlobalTransform>(&app, joints[0]).translation(), 1e-4);
    assert!(largest_strain(&app, cloth) < 0.2, "it starts anew on the character: {}", largest_strain(&app, cloth));
    assert_eq!(get::<ClothOutfit>(&app, character).collection(), &[clothes]);
    app.world_mut().entity_mut(clothes).remove::<ClothWornBy>();
    run(&mut app, 3);
    assert_eq!(get::<SkinnedMesh>(&app, cloth).joints, own);
    assert_close(collar(&app, cloth), Vec3::new(-5.0, 1.0, 0.0), 1e-4);
}

#[test]
fn clothes_change_their_wearer_and_come_off_where_that_is_gone() {
    let mut app = headless();
    let (clothes, cloth, own) = spawn_clothes(&mut app, ["neck", "hips"], Transform::default());
    let (first, _) = spawn_character(&mut app, Transform::from_xyz(3.0, 2.0, 0.0));
    let (second, joints) = spawn_character(&mut app, Transform::from_xyz(6.0, 2.0, 0.0));
    app.world_mut().entity_mut(clothes).insert(ClothWornBy(first));
    run(&mut app, 3);
    app.world_mut().entity_mut(clothes).insert(ClothWornBy(second));
    run(&mut app, 3);
    assert_eq!(get::<SkinnedMesh>(&app, cloth).joints, joints);
    app.world_mut().entity_mut(second).despawn();
    run(&mut app, 3);
    assert_eq!(get::<SkinnedMesh>(&app, cloth).joints, own);
    assert_eq!(*get::<ClothStatus>(&app, cloth), ClothStatus::Ready);
}

#[test]
fn clothes_below_their_wearer_dont_take_each_others_joints() {
    let mut app = headless();
    let character = app.world_mut().spawn(Transform::from_xyz(0.0, 2.0, 0.0)).id();
    let (clothes, cloth, _) = spawn_clothes(&mut app, ["neck", "hips"], Transform::default());
    let (others, other, _) = spawn_clothes(&mut app, ["neck", "hips"], Transform::default());
    for outfit in [clothes, others] {
        app.world_mut().entity_mut(outfit).insert((ClothWornBy(character), ChildOf(character)));
    }
    run(&mut app, 3);
    // The character's own skeleton comes last, as a scene that loads later does.
    let joints = spawn_joints(&mut app, character, ["neck", "hips"]);
    run(&mut app, 3);
    for cloth in [cloth, other] {
        assert_eq!(get::<SkinnedMesh>(&app, cloth).joints, joints);
    }
}

#[test]
fn a_joint_that_the_character_lacks_is_named_once_and_not_before_its_scene_could_have_come() {
    let mut quiet = Quiet::new();
    let (clothes, cloth, own) = spawn_clothes(&mut quiet.app, ["neck", "tail"], Transform::default());
    let (character, _) = spawn_character(&mut quiet.app, Transform::from_xyz(3.0, 2.0, 0.0));
    quiet.app.world_mut().entity_mut(clothes).insert(ClothWornBy(character));
    assert_eq!(quiet.run(240), Vec::<String>::new());
    let said = quiet.run(240);
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said[0].contains("\"tail\"") && said[0].contains(&character.to_string()), "{said:?}");
    assert_eq!(get::<SkinnedMesh>(&quiet.app, cloth).joints, own, "nothing is put on by half");
    // It gets one.
    let tail = quiet.app.world_mut().spawn((Name::new("tail"), Transform::default(), ChildOf(character))).id();
    assert_eq!(quiet.run(3), Vec::<String>::new());
    assert_eq!(get::<SkinnedMesh>(&quiet.app, cloth).joints[1], tail);
}

#[test]
fn a_garment_of_several_meshes_is_put_on_as_one() {
    let mut app = headless();
    let (clothes, cloth, _) = spawn_clothes(&mut app, ["neck", "hips"], Transform::default());
    let (character, joints) = spawn_character(&mut app, Transform::from_xyz(3.0, 2.0, 0.0));
    // The mesh becomes a part, as one of a node with several materials is.
    let garment = app.world_mut().spawn((Transform::default(), ChildOf(clothes))).id();
    app.world_mut().entity_mut(cloth).remove::<(Cloth, Pins)>().insert(ChildOf(garment));
    app.world_mut().entity_mut(garment).insert((Cloth::default(), Pins::edge(ClothEdge::Top)));
    app.world_mut().entity_mut(clothes).insert(ClothWornBy(character));
    run(&mut app, 4);
    assert_eq!(*get::<ClothStatus>(&app, garment), ClothStatus::Ready);
    assert_close(collar(&app, garment), get::<GlobalTransform>(&app, joints[0]).translation(), 1e-4);
}
