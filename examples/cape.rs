//! A cape and a skirt on a character that runs: `Cloth` on skinned meshes of a glTF file. Collar and waist are fixed to the skin, the
//! rest may go as far from it as is painted in the file, and capsules from its own skin keep the character out of its clothes.

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
        .add_observer(dress)
        .run())
}

/// What the character does.
#[derive(Resource)]
struct Running(Clip);

fn setup(mut commands: Commands, assets: Res<AssetServer>) {
    common::spawn_camera(&mut commands, Vec3::new(2.6, 1.5, -2.6), Vec3::new(0.0, 0.95, 0.0));
    let character = WorldAssetRoot(assets.load(GltfAssetLabel::Scene(0).from_asset("mannequin.glb")));
    // The tunic is skinned too, and isn't the body. Arms that swing through a cape would only hook on it.
    let except = ["Tunic", "lower_arm.L", "lower_arm.R", "hand.L", "hand.R"];
    commands.spawn((character, ClothBody { except: except.map(String::from).into(), ..default() }));
    // It runs on the spot, so the wind comes from ahead.
    commands.spawn(Wind { velocity: Vec3::new(0.3, 0.0, -4.0), gusts: 0.3, ..default() });
}

/// Makes cloth of what is named so once the scene is there. The cape that is seen is a finer mesh, which follows the one that is simulated.
fn dress(ready: On<WorldInstanceReady>, names: Query<&Name>, children: Query<&Children>, mut commands: Commands) {
    let nodes = || children.iter_descendants(ready.entity);
    let named = |name: &str| nodes().find(|&node| names.get(node).is_ok_and(|own| own.as_str() == name));
    let [Some(cape), Some(fine), Some(skirt), Some(tunic)] = ["Cape", "CapeFine", "Skirt", "Tunic"].map(named) else {
        return error!("the mannequin lacks its clothes");
    };
    // The cape lies on the skirt.
    let meeting = Cloth { self_collision: true, ..default() };
    let backstop = ClothSkin { backstop: Some(0.01), backstop_radius: 0.3, ..default() };
    commands.entity(cape).insert((meeting.clone(), Fabric::WOOL_FLANNEL, backstop, Visibility::Hidden));
    commands.entity(fine).insert(ClothProxy::new(cape));
    commands.entity(skirt).insert((meeting, Fabric::COTTON_WOVEN, ClothSkin::default()));
    commands.entity(tunic).insert(Visibility::Hidden);
}

/// Poses the joints, as Bevy's `AnimationPlayer` does in a game.
fn animate(running: Res<Running>, time: Res<Time>, mut joints: Query<(&Name, &mut Transform)>) {
    for (name, mut transform) in &mut joints {
        running.0.pose(name, time.elapsed_secs(), &mut transform);
    }
}
