//! A cape and a skirt on a character that runs. The glTF file says itself what is cloth, of which fabric, how far it may be from the
//! skin, and that capsules from that skin keep the character out of its clothes: `docs/blender.md` tells how.

mod common;

use std::path::Path;

use bevy::{app::AnimationSystems, prelude::*, world_serialization::WorldInstanceReady};
use bevy_drape::prelude::*;
use drape_lab::clips::Clip;

fn main() -> Result<AppExit> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/mannequin.glb");
    let clips = Clip::read_all(&file)?;
    let run = clips.get("run").cloned().ok_or("the mannequin runs")?;
    Ok(common::app("Cape", "A cape and a skirt on an animated character")
        .add_plugins(ClothPlugin::default())
        .insert_resource(Running(run))
        .add_systems(Startup, (common::spawn_scenery, setup))
        .add_systems(PostUpdate, animate.in_set(AnimationSystems).before(TransformSystems::Propagate))
        .add_observer(undress)
        .run())
}

/// What the character does.
#[derive(Resource)]
struct Running(Clip);

fn setup(mut commands: Commands, assets: Res<AssetServer>) {
    common::spawn_camera(&mut commands, Vec3::new(2.6, 1.5, -2.6), Vec3::new(0.0, 0.95, 0.0));
    commands.spawn(WorldAssetRoot(assets.load(GltfAssetLabel::Scene(0).from_asset("mannequin.glb"))));
    // It runs on the spot, so the wind comes from ahead.
    commands.spawn(Wind { velocity: Vec3::new(0.3, 0.0, -4.0), gusts: 0.3, ..default() });
}

/// Takes off the tunic, which is in the file too, once the scene is there.
fn undress(ready: On<WorldInstanceReady>, names: Query<&Name>, children: Query<&Children>, mut commands: Commands) {
    let parts = children.iter_descendants(ready.entity);
    for tunic in parts.filter(|&part| names.get(part).is_ok_and(|name| name.as_str() == "Tunic")) {
        commands.entity(tunic).despawn();
    }
}

/// Poses the joints, as Bevy's `AnimationPlayer` does in a game.
fn animate(running: Res<Running>, time: Res<Time>, mut joints: Query<(&Name, &mut Transform)>) {
    for (name, mut transform) in &mut joints {
        running.0.pose(name, time.elapsed_secs(), &mut transform);
    }
}
