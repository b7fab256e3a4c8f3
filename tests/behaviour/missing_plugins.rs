//! With less than it needs, the plugin does nothing, and nothing panics.

use bevy::{mesh::MeshPlugin, prelude::*};
use bevy_drape::prelude::*;

/// Plugins that the app has.
#[derive(Clone, Copy, Debug)]
struct Has {
    minimal: bool,
    transform: bool,
    asset: bool,
    mesh: bool,
}

fn all_subsets() -> impl Iterator<Item = Has> {
    (0..16)
        .map(|bits| Has { minimal: bits & 1 > 0, transform: bits & 2 > 0, asset: bits & 4 > 0, mesh: bits & 8 > 0 })
        // Bevy's own needs: assets are loaded on task pools, meshes are assets.
        .filter(|has| (has.minimal || !has.asset) && (has.asset || !has.mesh))
}

fn app_with(has: Has, plugin: ClothPlugin) -> App {
    let mut app = App::new();
    if has.minimal {
        app.add_plugins(MinimalPlugins);
    }
    if has.transform {
        app.add_plugins(TransformPlugin);
    }
    if has.asset {
        app.add_plugins(AssetPlugin::default());
    }
    if has.mesh {
        app.add_plugins(MeshPlugin);
    }
    app.add_plugins(plugin);
    app.finish();
    app.cleanup();
    app
}

#[test]
fn no_subset_of_bevys_plugins_panics() {
    assert_eq!(all_subsets().count(), 8);
    for has in all_subsets() {
        for plugin in [ClothPlugin::default(), ClothPlugin::new(Update), ClothPlugin::default().single_threaded()] {
            let mut app = app_with(has, plugin);
            let mesh = match app.world_mut().get_resource_mut::<Assets<Mesh>>() {
                Some(mut meshes) => meshes.add(ClothGrid::new(1.0, 1.0, 3, 3)),
                None => Handle::default(),
            };
            let cloth = app.world_mut().spawn((Mesh3d(mesh), Cloth::default(), Pins::corners())).id();
            app.world_mut().spawn(Wind { velocity: Vec3::X, ..default() });
            app.world_mut().spawn(ClothCollider::default());
            for _ in 0..3 {
                app.update();
            }
            let status = app.world().get::<ClothStatus>(cloth).unwrap();
            let expected = if has.minimal && has.mesh { ClothStatus::Ready } else { ClothStatus::Waiting };
            assert_eq!(*status, expected, "{has:?} and {plugin:?}");
            app.world_mut().commands().entity(cloth).reset_cloth().teleport_cloth(Transform::default());
            app.update();
            app.world_mut().entity_mut(cloth).remove::<Cloth>();
            app.update();
        }
    }
}
