//! Custom properties make cloth of what has no armature: flags, curtains, tablecloths.

use core::f32::consts::FRAC_PI_2;

use bevy::prelude::*;
use bevy_drape::prelude::*;
use serde_json::json;

use super::{
    file::*,
    shop::{Shop, warnings},
};
use crate::common::{pinned, place, run};

fn top() -> Vec<usize> {
    (0..SIDE).collect()
}

#[test]
fn an_object_that_says_so_is_cloth_of_its_fabric() {
    let file = sheet()
        .property("/nodes/0", "cloth", "silk")
        .property("/nodes/0", "cloth_pin", "top")
        .property("/nodes/0", "cloth_self", true)
        .property("/nodes/0", "cloth_layers", 2)
        .property("/nodes/0", "cloth_mask", 6.0);
    let (mut shop, root) = Shop::show("silk.glb", file);
    let cloth = shop.cloth(root);
    assert_eq!(*shop.get::<ClothStatus>(cloth), ClothStatus::Ready);
    assert_eq!(*shop.get::<Fabric>(cloth), Fabric::SILK);
    assert_eq!(pinned(&shop.app, cloth), top());
    let expected = Cloth { self_collision: true, collision_layers: 2, collision_mask: 6, ..default() };
    assert_eq!(*shop.get::<Cloth>(cloth), expected);
    let before = place(&shop.app, cloth, 24);
    shop.app.world_mut().spawn(Wind { velocity: Vec3::Z * 5.0, ..default() });
    run(&mut shop.app, 20);
    assert!(place(&shop.app, cloth, 24).distance(before) > 0.01, "it moves");
    assert_eq!(warnings("silk.glb"), [""; 0]);
}

#[test]
fn a_mesh_or_a_material_makes_cloth_of_every_object_that_has_it() {
    for (path, on) in [("of_mesh.glb", "/meshes/0"), ("of_material.glb", "/materials/0")] {
        let mut file = sheet().property(on, "cloth", "Wool Flannel");
        file.json["nodes"] =
            json!([{ "name": "One", "mesh": 0 }, { "name": "Other", "mesh": 0, "extras": { "cloth": false } }]);
        file.json["scenes"][0]["nodes"] = json!([0, 1]);
        let (shop, root) = Shop::show(path, file);
        assert_eq!(shop.all::<Cloth>(shop.named(root, "One")).len(), 1, "{on}");
        assert_eq!(shop.all::<Cloth>(shop.named(root, "Other")).len(), 0, "the object knows better than {on}");
        assert_eq!(*shop.get::<Fabric>(shop.cloth(root)), Fabric::WOOL_FLANNEL);
    }
}

#[test]
fn what_an_object_leaves_open_its_material_and_the_scene_may_say() {
    let file = sheet()
        .property("/nodes/0", "cloth", true)
        .property("/materials/0", "cloth", "denim")
        .property("/scenes/0", "cloth", "leather")
        .property("/scenes/0", "cloth_mask", 4);
    let (shop, root) = Shop::show("left_open.glb", file);
    let cloth = shop.cloth(root);
    assert_eq!(*shop.get::<Fabric>(cloth), Fabric::DENIM);
    assert_eq!(shop.get::<Cloth>(cloth).collision_mask, 4);
    let (shop, root) = Shop::show("scene_alone.glb", sheet().property("/scenes/0", "cloth", "leather"));
    assert_eq!(shop.all::<Cloth>(root).len(), 0, "a scene makes nothing cloth");
}

#[test]
fn what_is_painted_zero_or_as_a_pin_is_held_by_the_object() {
    let held = by_row(|down| f32::from(down == 0.0));
    let loose = by_row(|down| down);
    for (path, name, values) in [("pinned.glb", "_PIN", &held), ("loose.glb", "_CLOTH", &loose)] {
        let file = sheet().property("/nodes/0", "cloth", true).paint(name, values);
        for (path, file) in [(path.to_owned(), file.clone()), (format!("flat_{path}"), file.without_normals())] {
            let (shop, root) = Shop::show(&path, file);
            let cloth = shop.cloth(root);
            let state = shop.get::<ClothState>(cloth);
            let held = (0..state.particle_count()).filter(|&particle| state.is_pinned(particle));
            assert_eq!(held.count(), SIDE, "{path}");
            assert!(pinned(&shop.app, cloth).iter().all(|&vertex| place(&shop.app, cloth, vertex as u32).y == 0.0));
            assert_eq!(warnings(&path), [""; 0]);
        }
    }
}

#[test]
fn a_fabric_file_is_looked_for_beside_the_model_or_from_the_root_of_the_assets() {
    for (model, fabric, written) in [
        ("models/flag.glb", "models/bunting.fabric.ron", "bunting.fabric.ron"),
        ("other/flag.glb", "fabrics/bunting.fabric.ron", "/fabrics/bunting.fabric.ron"),
    ] {
        let mut shop = Shop::new();
        shop.write_text(fabric, &Fabric { density: 0.123, ..default() }.to_ron());
        shop.write(model, sheet().property("/nodes/0", "cloth", written).property("/nodes/0", "cloth_pin", "top"));
        let root = shop.spawn(model, Transform::default());
        let cloth = shop.cloth(root);
        crate::fabric_assets::wait_for(&mut shop.app, |app| crate::common::get::<Fabric>(app, cloth).density == 0.123);
    }
}

#[test]
fn an_object_of_several_materials_is_one_garment_if_all_of_them_are_the_same_cloth() {
    let (shop, root) = Shop::show("one_garment.glb", two_materials().property("/nodes/0", "cloth", "silk"));
    let sheet = shop.named(root, "Sheet");
    assert_eq!(shop.all::<Cloth>(root), [sheet]);
    assert_eq!(*shop.get::<Fabric>(sheet), Fabric::SILK);
    assert_eq!(shop.all::<ClothPartOf>(root).len(), 2);
    let state = shop.get::<ClothState>(sheet);
    assert_eq!(state.particle_count(), SIDE * SIDE, "what is at the same place is sewn");
    assert_eq!((0..SIDE * SIDE).filter(|&particle| state.is_pinned(particle)).count(), SIDE, "painted on both");
    assert_eq!(warnings("one_garment.glb"), [""; 0]);
    let file = two_materials().property("/nodes/0", "cloth", true).property("/materials/0", "cloth", "denim");
    let (shop, root) = Shop::show("two_fabrics.glb", file);
    let cloths = shop.all::<Cloth>(root);
    assert_eq!(cloths.len(), 2, "a cloth has one fabric");
    assert!(cloths.iter().all(|&cloth| *shop.get::<ClothStatus>(cloth) == ClothStatus::Ready));
}

#[test]
fn materials_stay_cloths_of_their_own_where_other_meshes_are_below_the_object() {
    let mut file = two_materials().property("/nodes/0", "cloth", "silk");
    let buckle = file.add("nodes", json!({ "name": "Buckle", "mesh": 0, "extras": { "cloth": false } }));
    file.json["nodes"][0]["children"] = json!([buckle]);
    let (shop, root) = Shop::show("buckle.glb", file);
    assert_eq!(shop.all::<Cloth>(root).len(), 2);
    let [warning] = &warnings("buckle.glb")[..] else { panic!("one warning") };
    assert!(warning.contains("object \"Sheet\"") && warning.contains("move them elsewhere"), "{warning}");
}

/// A sheet that is there twice, in two materials, whose upper edge is painted as pinned.
fn two_materials() -> File {
    let mut file = sheet().paint("_PIN", &by_row(|down| f32::from(down == 0.0)));
    let material = file.add("materials", json!({ "name": "Trim" }));
    let mut part = file.primitive().clone();
    part["material"] = material.into();
    file.json["meshes"][0]["primitives"].as_array_mut().expect("primitives").push(part);
    file
}

/// A sheet, and the same as a fine mesh that follows what it names.
fn with_proxy(of: &str) -> File {
    let mut file = sheet().property("/nodes/0", "cloth", "silk").property("/nodes/0", "cloth_pin", "top");
    let fine = file.add("nodes", json!({ "name": "Fine", "mesh": 0, "extras": { "cloth_proxy": of } }));
    file.json["scenes"][0]["nodes"] = json!([0, fine]);
    file
}

#[test]
fn a_fine_mesh_follows_the_cloth_that_it_names() {
    let (mut shop, root) = Shop::show("fine.glb", with_proxy("Sheet"));
    let (cloth, fine) = (shop.cloth(root), shop.all::<ClothProxy>(root)[0]);
    assert_eq!(shop.get::<ClothProxy>(fine).driver, cloth, "of this instance");
    assert_eq!(*shop.get::<Visibility>(cloth), Visibility::Hidden);
    shop.app.world_mut().spawn(Wind { velocity: Vec3::Z * 5.0, ..default() });
    run(&mut shop.app, 30);
    let lowest = |entity| crate::common::points(shop.mesh(entity)).last().copied().expect("it has vertices");
    assert!(lowest(fine).z > 0.05 && lowest(fine).distance(lowest(cloth)) < 1e-4, "{}", lowest(fine));
    assert_eq!(warnings("fine.glb"), [""; 0]);
}

#[test]
fn a_fine_mesh_that_names_no_cloth_is_told_of_with_the_nearest_name() {
    let mut ring = with_proxy("Fine");
    ring.json["nodes"][0]["extras"] = json!({});
    for (path, file, expected) in [
        ("no_such_driver.glb", with_proxy("Sheat"), "did you mean Sheet?"),
        ("own_driver.glb", ring, "write `cloth` on it"),
    ] {
        let (shop, root) = Shop::show(path, file);
        assert_eq!(shop.all::<ClothProxy>(root).len(), 0);
        let [warning] = &warnings(path)[..] else { panic!("one warning") };
        assert!(warning.contains("object \"Fine\"") && warning.contains(expected), "{warning}");
    }
}

#[test]
fn an_empty_blows_along_its_arrow() {
    let mut file = sheet();
    let turn = Quat::from_rotation_z(-FRAC_PI_2).to_array();
    file.json["nodes"] = json!([{ "name": "Breeze", "rotation": turn, "extras": { "cloth_wind": 4.0 } }]);
    let (shop, root) = Shop::show("breeze.glb", file);
    let wind = shop.named(root, "Breeze");
    let blown = shop.get::<GlobalTransform>(wind).affine().transform_vector3(shop.get::<Wind>(wind).velocity);
    assert!(blown.distance(Vec3::X * 4.0) < 1e-5, "{blown}");
}
