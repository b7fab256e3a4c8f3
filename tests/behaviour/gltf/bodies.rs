//! Bodies and obstacles, by properties of armatures, bones and objects.

use bevy::prelude::*;
use bevy_drape::prelude::*;
use serde_json::{Value, json};

use super::{
    file::*,
    shop::{Shop, warnings},
};

/// The solid that a file with these properties on an object has, its place in the object, and how often it is there.
fn solid_of(path: &str, properties: Value) -> (Solid, Transform) {
    let mut file = sheet();
    file.json["nodes"][0]["extras"] = properties;
    let (shop, root) = Shop::show(path, file);
    assert_eq!(warnings(path), [""; 0]);
    only_solid(&shop, root)
}

fn only_solid(shop: &Shop, root: Entity) -> (Solid, Transform) {
    let colliders = shop.all::<ClothCollider>(root);
    assert_eq!(colliders.len(), 1, "one collider");
    let ColliderShape::Solid(solid) = shop.get::<ClothCollider>(colliders[0]).shape else { panic!("a solid") };
    (solid, *shop.get::<Transform>(colliders[0]))
}

#[test]
fn solids_of_an_object_fill_the_box_around_its_mesh() {
    let middle = Vec3::new(0.0, -0.5, 0.0);
    let (solid, at) = solid_of("box.glb", json!({ "cloth_collider": "box" }));
    assert_eq!((solid, at.translation), (Solid::Cuboid(Cuboid { half_size: Vec3::new(0.5, 0.5, 0.0) }), middle));
    let (solid, at) = solid_of("sphere.glb", json!({ "cloth_collider": "sphere", "cloth_radius": 0.2 }));
    assert_eq!((solid, at.translation), (Solid::Sphere(Sphere::new(0.2)), middle));
    let (solid, at) = solid_of("capsule.glb", json!({ "cloth_collider": "capsule", "cloth_radius": 0.1 }));
    assert_eq!((solid, at.translation), (Solid::Capsule(Capsule3d::new(0.1, 0.8)), middle));
}

#[test]
fn a_capsule_on_a_bone_reaches_to_the_next_and_the_last_is_a_ball() {
    let mut file = worn_sheet()
        .property("/nodes/1", "cloth_collider", "capsule")
        .property("/nodes/1", "cloth_radius", 0.07)
        .property("/nodes/1", "cloth_layers", 8);
    file.json["nodes"][2]["translation"] = json!([0.0, 0.0, 0.5]);
    let (shop, root) = Shop::show("bone.glb", file);
    let (solid, at) = only_solid(&shop, root);
    assert_eq!(solid, Solid::Capsule(Capsule3d::new(0.07, 0.5)));
    assert!(at.transform_point(Vec3::Y * 0.25).distance(Vec3::Z * 0.5) < 1e-6, "it ends at the next bone");
    let collider = shop.all::<ClothCollider>(root)[0];
    assert_eq!(shop.get::<ClothCollider>(collider).layers, 8);
    assert_eq!(shop.get::<ChildOf>(collider).parent(), shop.named(root, "upper"));

    let file =
        worn_sheet().property("/nodes/2", "cloth_collider", "capsule").property("/nodes/2", "cloth_radius", 0.05);
    let (shop, root) = Shop::show("last_bone.glb", file);
    let (solid, at) = only_solid(&shop, root);
    assert_eq!((solid, at.translation), (Solid::Capsule(Capsule3d::new(0.05, 0.0)), Vec3::ZERO));
}

#[cfg(feature = "mesh_colliders")]
#[test]
fn an_object_can_be_an_obstacle_by_its_triangles() {
    for (name, expected) in [("mesh", ColliderShape::Mesh(None)), ("hull", ColliderShape::ConvexHull(None))] {
        let path = format!("by_{name}.glb");
        let (shop, root) = Shop::show(&path, sheet().property("/nodes/0", "cloth_collider", name));
        let colliders = shop.all::<ClothCollider>(root);
        assert_eq!(colliders, shop.all::<Mesh3d>(root));
        assert_eq!(shop.get::<ClothCollider>(colliders[0]).shape, expected);
    }
}

#[test]
fn an_armature_is_a_body_without_what_has_a_collider_of_its_own_or_is_to_have_none() {
    let file = worn_sheet()
        .property("/nodes/3", "cloth_body", true)
        .property("/nodes/2", "cloth_collider", "none")
        .property("/nodes/0", "cloth_body", false);
    let (shop, root) = Shop::show("body.glb", file);
    let armature = shop.named(root, "Armature");
    assert_eq!(shop.all::<ClothBody>(root), [armature]);
    assert_eq!(shop.get::<ClothBody>(armature).except, ["lower"]);
    assert_eq!(shop.all::<ClothCollider>(shop.named(root, "lower")).len(), 0);
    assert_eq!(warnings("body.glb"), [""; 0]);
}
