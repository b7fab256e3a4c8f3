//! Clothes on armatures, by what is painted and written in the file.

use bevy::prelude::*;
use bevy_drape::prelude::*;
use serde_json::json;

use super::{
    file::*,
    shop::{Shop, warnings},
};
use crate::{
    common::{get, pinned, place, run, state},
    mannequin::spawned_with,
};

#[test]
fn what_is_painted_is_how_far_clothes_may_be_from_their_armature() {
    let file = worn_sheet()
        .paint("_CLOTH", &by_row(|down| down))
        .property("/nodes/0", "cloth", true)
        .property("/nodes/0", "cloth_max_distance", 0.1)
        .property("/nodes/0", "cloth_backstop", 0.02)
        .property("/nodes/0", "cloth_backstop_radius", 0.3)
        .property("/nodes/0", "cloth_pull", 0.5);
    let (mut shop, root) = Shop::show("worn.glb", file);
    let cloth = shop.cloth(root);
    let expected = ClothSkin {
        max_distance: ClothMap::Painted { scale: 0.1, missing: 0.1 },
        backstop: Some(0.02),
        backstop_radius: 0.3,
        pull: 0.5,
        ..default()
    };
    assert_eq!(*shop.get::<ClothSkin>(cloth), expected);
    assert_eq!(pinned(&shop.app, cloth), (0..SIDE).collect::<Vec<_>>());
    shop.app.world_mut().spawn(Wind { velocity: Vec3::Z * 30.0, gusts: 0.0, ..default() });
    run(&mut shop.app, 60);
    let away = |vertex: u32| place(&shop.app, cloth, vertex).z;
    assert!((0.05..0.102).contains(&away(22)), "the hem is {} m away", away(22));
    assert!((0.02..0.052).contains(&away(12)), "the middle is {} m away", away(12));
    assert_eq!(warnings("worn.glb"), [""; 0]);
}

#[test]
fn without_paint_the_property_counts_for_all_vertices() {
    let file = worn_sheet()
        .property("/nodes/0", "cloth", true)
        .property("/nodes/0", "cloth_max_distance", 0.05)
        .property("/nodes/0", "cloth_pin", "top_corners");
    let (mut shop, root) = Shop::show("unpainted.glb", file);
    let cloth = shop.cloth(root);
    assert_eq!(pinned(&shop.app, cloth), [0, SIDE - 1]);
    shop.app.world_mut().spawn(Wind { velocity: Vec3::Z * 30.0, gusts: 0.0, ..default() });
    run(&mut shop.app, 60);
    let farthest = state(&shop.app, cloth).positions().map(|place| place.z).fold(0.0, f32::max);
    assert!((0.04..0.052).contains(&farthest), "{farthest} m");
}

#[test]
fn a_painted_backstop_keeps_cloth_out_where_it_is_painted() {
    let file = worn_sheet()
        .paint("_CLOTH", &by_row(|down| down))
        .paint("_CLOTH_BACKSTOP", &by_row(|down| if down > 0.9 { -1.0 } else { 0.0 }))
        .property("/nodes/0", "cloth", true)
        .property("/nodes/0", "cloth_backstop_radius", 10.0);
    let (mut shop, root) = Shop::show("backstop.glb", file);
    let cloth = shop.cloth(root);
    shop.app.world_mut().spawn(Wind { velocity: Vec3::NEG_Z * 20.0, gusts: 0.0, ..default() });
    run(&mut shop.app, 60);
    assert!(place(&shop.app, cloth, 17).z > -0.01, "{}", place(&shop.app, cloth, 17).z);
    assert!(place(&shop.app, cloth, 22).z < -0.02, "{}", place(&shop.app, cloth, 22).z);
}

#[test]
fn cloth_that_hangs_on_a_bone_moves_with_the_animation_of_the_frame() {
    let mut file = worn_sheet();
    let (mesh, material) = (file.json["meshes"][0].clone(), json!({ "cloth": true }));
    file.add("meshes", mesh);
    file.json["meshes"][1]["extras"] = material;
    let primitive = file.json["meshes"][1]["primitives"][0]["attributes"].as_object_mut().expect("attributes");
    primitive.remove("JOINTS_0");
    primitive.remove("WEIGHTS_0");
    let banner = file.add("nodes", json!({ "name": "Banner", "mesh": 1 }));
    file.json["nodes"][2]["children"] = json!([banner]);
    let (shop, root) = Shop::show("banner.glb", file);
    assert_eq!(shop.get::<Cloth>(shop.cloth(root)).timing, ClothTiming::Late);
    let (shop, root) = Shop::show("flag.glb", sheet().property("/nodes/0", "cloth", true));
    assert_eq!(shop.get::<Cloth>(shop.cloth(root)).timing, ClothTiming::Auto);
}

#[test]
fn the_mannequin_is_dressed_by_its_file() {
    let mut app = spawned_with(ClothPlugin::default());
    run(&mut app, 3);
    let mut cloths = app.world_mut().query::<(Entity, &ChildOf, &ClothStatus, &Fabric)>();
    // A garment of several materials is on its node.
    let name = |entity, node: &ChildOf| match app.world().get::<Mesh3d>(entity) {
        Some(_) => get::<Name>(&app, node.parent()).to_string(),
        None => get::<Name>(&app, entity).to_string(),
    };
    let mut found: Vec<_> = cloths
        .query(app.world())
        .iter()
        .map(|(entity, node, status, fabric)| (name(entity, node), status.is_running(), fabric.clone()))
        .collect();
    found.sort_by(|one, other| one.0.cmp(&other.0));
    let of = |name: &str, fabric: Fabric| (name.to_owned(), true, fabric);
    let expected =
        [of("Cape", Fabric::WOOL_FLANNEL), of("Skirt", Fabric::COTTON_WOVEN), of("Tunic", Fabric::COTTON_JERSEY)];
    assert_eq!(found, expected);
    let mut parts = app.world_mut().query::<(&ClothBodyPart, &ChildOf)>();
    let on: Vec<String> =
        parts.query(app.world()).iter().map(|(_, joint)| get::<Name>(&app, joint.parent()).to_string()).collect();
    assert!(on.len() >= 9 && on.iter().any(|name| name == "thigh.L"), "{on:?}");
    assert!(!on.iter().any(|name| name.starts_with("lower_arm") || name.starts_with("hand")), "{on:?}");
    let mut proxies = app.world_mut().query::<(&ClothProxy, &ChildOf)>();
    let [(proxy, fine)] = proxies.query(app.world()).into_iter().collect::<Vec<_>>()[..] else { panic!("one proxy") };
    let driver = get::<ChildOf>(&app, proxy.driver);
    assert_eq!([fine, driver].map(|node| get::<Name>(&app, node.parent()).as_str()), ["CapeFine", "Cape"]);
    assert_eq!(*get::<Visibility>(&app, proxy.driver), Visibility::Hidden);
}
