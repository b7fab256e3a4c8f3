//! Scenes that are instanced, respawned, reloaded, and loaded in apps of other kinds.

use bevy::{ecs::reflect::AppTypeRegistry, gltf::GltfPlugin, mesh::skinning::SkinnedMesh, prelude::*};
use bevy_drape::prelude::*;
use serde_json::json;

use super::{
    file::*,
    shop::{Shop, warnings},
};
use crate::common::{place, run};

fn worn() -> File {
    worn_sheet().paint("_CLOTH", &by_row(|down| down)).property("/nodes/0", "cloth", "silk").property(
        "/nodes/3",
        "cloth_body",
        true,
    )
}

#[test]
fn a_hundred_instances_are_cloth_each_on_its_own_armature() {
    let mut shop = Shop::new();
    shop.write("crowd.glb", worn());
    let roots: Vec<Entity> =
        (0..100).map(|i| shop.spawn("crowd.glb", Transform::from_xyz(3.0 * i as f32, 0.0, 0.0))).collect();
    for (i, root) in roots.into_iter().enumerate() {
        let cloth = shop.cloth(root);
        assert!(shop.get::<ClothStatus>(cloth).is_running());
        assert_eq!(*shop.get::<Fabric>(cloth), Fabric::SILK);
        assert_eq!(shop.get::<SkinnedMesh>(cloth).joints[0], shop.named(root, "upper"));
        assert!(place(&shop.app, cloth, 0).distance(Vec3::new(3.0 * i as f32 - 0.5, 0.0, 0.0)) < 1e-4);
        assert_eq!(shop.all::<ClothBody>(root).len(), 1);
    }
    assert_eq!(warnings("crowd.glb"), [""; 0]);
}

#[test]
fn a_scene_that_is_despawned_and_spawned_again_is_cloth_again() {
    let (mut shop, root) = Shop::show("again.glb", worn());
    let cloth = shop.cloth(root);
    shop.app.world_mut().entity_mut(root).despawn();
    run(&mut shop.app, 2);
    assert!(shop.app.world().get_entity(cloth).is_err());
    let root = shop.spawn("again.glb", Transform::default());
    assert_eq!(*shop.get::<ClothStatus>(shop.cloth(root)), ClothStatus::Ready);
}

#[test]
fn a_file_that_is_edited_while_the_app_runs_is_read_anew() {
    let (mut shop, root) = Shop::show("edited.glb", worn());
    assert_eq!(*shop.get::<Fabric>(shop.cloth(root)), Fabric::SILK);
    // As in a game, something knows the file, besides its scene.
    let _file = shop.load("edited.glb");
    let edited = worn_sheet().paint("_CLOTH", &by_row(|down| 1.0 - down)).property("/nodes/0", "cloth", "denim");
    shop.write("edited.glb", edited);
    shop.reload("edited.glb");
    let cloth = shop.cloth(root);
    assert_eq!(*shop.get::<Fabric>(cloth), Fabric::DENIM);
    assert_eq!(shop.all::<ClothBody>(root).len(), 0);
    assert_eq!(crate::common::pinned(&shop.app, cloth), (SIDE * (SIDE - 1)..SIDE * SIDE).collect::<Vec<_>>());
}

#[test]
fn it_makes_no_difference_which_plugin_comes_first() {
    let mut shop = Shop::with_plugins(|app| {
        app.add_plugins((ClothPlugin::default(), GltfPlugin::default()));
    });
    shop.write("late_loader.glb", sheet().property("/nodes/0", "cloth", true).property("/nodes/0", "cloth_pin", "top"));
    let root = shop.spawn("late_loader.glb", Transform::default());
    assert_eq!(*shop.get::<ClothStatus>(shop.cloth(root)), ClothStatus::Ready);
}

/// All that files can bring.
fn everything() -> File {
    let mut file = worn()
        .property("/nodes/0", "cloth", "everything.fabric.ron")
        .property("/nodes/1", "cloth_collider", "capsule")
        .property("/nodes/3", "cloth_wind", 2.0);
    file.json["scenes"][0]["extras"] = json!({ "cloth_mask": 1 });
    file
}

#[test]
fn scenes_spawn_where_types_dont_register_themselves() {
    let registry = AppTypeRegistry::default();
    let mut app = App::new();
    app.insert_resource(registry.clone()).add_plugins((MinimalPlugins, AssetPlugin::default(), ClothPlugin::default()));
    let registry = registry.read();
    let components = [
        core::any::TypeId::of::<Cloth>(),
        core::any::TypeId::of::<Fabric>(),
        core::any::TypeId::of::<FabricHandle>(),
        core::any::TypeId::of::<Pins>(),
        core::any::TypeId::of::<ClothSkin>(),
        core::any::TypeId::of::<ClothBody>(),
        core::any::TypeId::of::<ClothCollider>(),
        core::any::TypeId::of::<Wind>(),
    ];
    for component in components {
        assert!(registry.get_type_data::<ReflectComponent>(component).is_some());
    }
}

#[test]
fn a_scene_with_all_that_files_can_bring_spawns() {
    let mut shop = Shop::new();
    shop.write_text("everything.fabric.ron", &Fabric::DENIM.to_ron());
    shop.write("everything.glb", everything());
    let root = shop.spawn("everything.glb", Transform::default());
    for found in [
        shop.all::<Cloth>(root),
        shop.all::<FabricHandle>(root),
        shop.all::<ClothSkin>(root),
        shop.all::<ClothBody>(root),
        shop.all::<Wind>(root),
    ] {
        assert_eq!(found.len(), 1);
    }
    assert!(!shop.all::<ClothCollider>(root).is_empty());
    let cloth = shop.cloth(root);
    crate::fabric_assets::wait_for(&mut shop.app, |app| *crate::common::get::<Fabric>(app, cloth) == Fabric::DENIM);
    assert_eq!(warnings("everything.glb"), [""; 0]);
}
