//! Files with mistakes: one warning each, with the file, what in it and the mend; the scene is there, and so is what can be.

use bevy::prelude::*;
use bevy_drape::prelude::*;
use serde_json::json;

use super::{
    file::*,
    shop::{Shop, warnings},
};
use crate::common::run;

/// The only warning of a file, and its scene.
#[track_caller]
fn only_warning(path: &str, file: File) -> (Shop, Entity, String) {
    let (mut shop, root) = Shop::show(path, file);
    // Once for all of its instances, and never again.
    shop.spawn(path, Transform::from_xyz(5.0, 0.0, 0.0));
    run(&mut shop.app, 3);
    let warnings = warnings(path);
    assert_eq!(warnings.len(), 1, "{warnings:#?}");
    assert_eq!(shop.all::<Mesh3d>(root).len(), 1, "the scene is there");
    (shop, root, warnings[0].clone())
}

fn cloth() -> File {
    sheet().property("/nodes/0", "cloth", true).property("/nodes/0", "cloth_pin", "top")
}

#[test]
fn a_misspelt_property_is_told_with_the_one_that_is_meant() {
    let (shop, root, said) = only_warning("misspelt.glb", cloth().property("/nodes/0", "cloth_max_distence", 1.0));
    assert_eq!(said, "object \"Sheet\": no property is called cloth_max_distence; did you mean cloth_max_distance?");
    assert_eq!(*shop.get::<ClothStatus>(shop.cloth(root)), ClothStatus::Ready);
    let (.., said) = only_warning("misspelt_paint.glb", cloth().paint("_CLOTH_BACKSTOPP", &by_row(|down| down)));
    assert_eq!(said, "mesh \"Sheet\": no attribute is called _CLOTH_BACKSTOPP; did you mean _CLOTH_BACKSTOP?");
}

#[test]
fn a_property_of_a_wrong_type_is_told_with_what_it_has_to_be() {
    let wrong = [
        ("cloth_self", json!("yes"), "true or false"),
        ("cloth_layers", json!(1.5), "a whole number from 0 to"),
        ("cloth_mask", json!(-1), "a whole number from 0 to"),
        ("cloth_max_distance", json!("far"), "a number of m, 0 or more"),
        ("cloth_max_distance", json!(-0.1), "a number of m, 0 or more"),
        ("cloth_backstop_radius", json!(0), "a number of m, greater than 0"),
        ("cloth_pull", json!([1.0]), "a number of Hz, 0 or more"),
        ("cloth_pull", json!(1e300), "a number of Hz, 0 or more"),
        ("cloth_body", json!(2), "true or false"),
        ("cloth_collider", json!("cube"), "none, capsule, box"),
        ("cloth_wind", json!([1.0, 0.0, 0.0]), "a speed in m/s"),
        ("cloth_proxy", json!(null), "the name of an object"),
    ];
    for (number, (name, value, rule)) in wrong.into_iter().enumerate() {
        let path = format!("wrong_{number}.glb");
        let (shop, root, said) = only_warning(&path, cloth().property("/nodes/0", name, value.clone()));
        assert!(said.starts_with(&format!("object \"Sheet\": {name} is {value}, and it has to be {rule}")), "{said}");
        assert_eq!(*shop.get::<ClothStatus>(shop.cloth(root)), ClothStatus::Ready);
    }
}

#[test]
fn a_pin_or_a_fabric_of_no_such_name_is_told() {
    let (.., said) =
        only_warning("no_pin.glb", sheet().property("/nodes/0", "cloth", true).property("/nodes/0", "cloth_pin", "up"));
    assert!(said.contains("cloth_pin is \"up\", and it has to be corners, or top"), "{said}");
    let (shop, root, said) = only_warning("no_fabric.glb", sheet().property("/nodes/0", "cloth", "slik"));
    assert!(said.contains("did you mean silk?"), "{said}");
    assert_eq!(shop.all::<Cloth>(root).len(), 0);
}

#[test]
fn a_property_in_the_wrong_place_is_told_with_the_right_one() {
    let (.., said) = only_warning("misplaced.glb", cloth().property("/materials/0", "cloth_body", true));
    assert_eq!(said, "material \"Sheet\": cloth_body does nothing here; write it on an object or a bone");
    let mut file = sheet();
    file.json["nodes"] = json!([{ "name": "Sheet", "mesh": 0 }, { "name": "Empty", "extras": { "cloth": true } }]);
    file.json["scenes"][0]["nodes"] = json!([0, 1]);
    let (.., said) = only_warning("empty.glb", file);
    assert_eq!(said, "object \"Empty\": cloth does nothing where there is no mesh; write it on an object that has one");
    let (.., said) = only_warning("no_cloth.glb", sheet().property("/nodes/0", "cloth_self", true));
    assert_eq!(said, "object \"Sheet\": cloth_self does nothing without the property `cloth`; add that");
    let (.., said) = only_warning("no_armature.glb", cloth().property("/nodes/0", "cloth_pull", 1.0));
    assert_eq!(said, "object \"Sheet\": cloth_pull does nothing: its mesh follows no armature");
}

#[test]
fn a_collider_that_cant_be_is_told() {
    let on = |node: &str, kind: &str| worn_sheet().property(node, "cloth_collider", kind);
    for (path, file, expected) in [
        ("no_size.glb", on("/nodes/2", "sphere"), "bone \"lower\": cloth_collider has no size"),
        ("no_mesh.glb", on("/nodes/1", "hull"), "bone \"upper\": cloth_collider needs a mesh"),
        ("rigid.glb", on("/nodes/0", "box"), "object \"Sheet\": cloth_collider wouldn't follow the armature"),
        (
            "alone.glb",
            worn_sheet().property("/nodes/1", "cloth_radius", 1.0),
            "bone \"upper\": cloth_radius does nothing",
        ),
    ] {
        let (shop, root, said) = only_warning(path, file);
        assert!(said.starts_with(expected), "{said}");
        assert_eq!(shop.all::<ClothCollider>(root).len(), 0);
    }
}

#[test]
fn paint_of_another_length_is_left_out() {
    let (shop, root, said) = only_warning("short.glb", cloth().paint("_CLOTH", &[1.0; 7]));
    assert_eq!(said, "mesh \"Sheet\": _CLOTH has 7 values for 25 vertices and is left out; paint all of them");
    assert!(shop.only_mesh(root).attribute(ATTRIBUTE_CLOTH).is_none());
    assert_eq!(*shop.get::<ClothStatus>(shop.cloth(root)), ClothStatus::Ready);
}

#[test]
fn paint_that_is_no_number_is_left_out() {
    let mut file = cloth();
    file.attribute("_CLOTH", "MAT4", FLOAT, false, &floats(&[0.5; 16 * SIDE * SIDE]));
    let (.., said) = only_warning("matrix.glb", file);
    assert!(said.contains("_CLOTH can't be read and is left out"), "{said}");
    let (.., said) = only_warning("no_direction.glb", cloth().paint("_WARP", &by_row(|down| down)));
    assert!(said.contains("_WARP is no direction and is left out"), "{said}");
}

#[test]
fn paint_that_is_no_distance_is_zero_and_its_vertex_is_named() {
    for (number, bad) in [f32::NAN, f32::INFINITY, -0.5].into_iter().enumerate() {
        let mut values = by_row(|down| down);
        values[13] = bad;
        let path = format!("bad_vertex_{number}.glb");
        let (shop, root, said) =
            only_warning(&path, sheet().property("/nodes/0", "cloth", true).paint("_CLOTH", &values));
        assert_eq!(said, "mesh \"Sheet\": what is painted as _CLOTH on vertex 13 doesn't count; paint 0 or more");
        assert!(crate::common::pinned(&shop.app, shop.cloth(root)).contains(&13));
    }
}

#[test]
fn paint_that_leaves_nothing_loose_or_nothing_held_is_told() {
    for (path, file) in [("stiff.glb", sheet()), ("stiff_worn.glb", worn_sheet())] {
        let file = file.property("/nodes/0", "cloth", true).paint("_CLOTH", &by_row(|_| 0.0));
        let (shop, root, said) = only_warning(path, file);
        assert!(said.starts_with("object \"Sheet\": there is nothing to simulate"), "{said}");
        assert_eq!(*shop.get::<ClothStatus>(shop.cloth(root)), ClothStatus::Ready);
    }
    for (path, file, what) in [("free.glb", sheet(), "so it falls"), ("free_worn.glb", worn_sheet(), "slide about")] {
        let file = file.property("/nodes/0", "cloth", true).paint("_CLOTH", &by_row(|_| 0.5));
        let (.., said) = only_warning(path, file);
        assert!(said.starts_with("object \"Sheet\": nothing holds it") && said.contains(what), "{said}");
    }
    let file = sheet().property("/nodes/0", "cloth", true).paint("_PIN", &by_row(|_| 0.0));
    let (shop, root, said) = only_warning("no_pins.glb", file);
    assert!(said.contains("_PIN is painted and pins nothing"), "{said}");
    assert_eq!(*shop.get::<ClothStatus>(shop.cloth(root)), ClothStatus::Ready);
}

#[test]
fn a_fabric_file_that_isnt_there_leaves_the_cloth_with_the_default() {
    let (mut shop, root) = Shop::show("lost_fabric.glb", cloth().property("/nodes/0", "cloth", "lost_1.fabric.ron"));
    shop.spawn("lost_fabric.glb", Transform::default());
    run(&mut shop.app, 5);
    let cloth = shop.cloth(root);
    assert_eq!(*shop.get::<ClothStatus>(cloth), ClothStatus::Ready);
    assert_eq!(*shop.get::<Fabric>(cloth), Fabric::default());
}

#[test]
fn extras_that_arent_ours_are_left_alone() {
    for (number, extras) in
        [json!("cloth"), json!([1, 2]), json!({ "targetNames": ["a"], "weight": 3 })].into_iter().enumerate()
    {
        let mut file = sheet();
        file.json["nodes"][0]["extras"] = extras.clone();
        file.json["meshes"][0]["extras"] = extras;
        let path = format!("others_{number}.glb");
        let (shop, root) = Shop::show(&path, file);
        assert_eq!(warnings(&path), [""; 0]);
        assert_eq!(shop.all::<Cloth>(root).len(), 0);
    }
}
