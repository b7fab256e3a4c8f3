//! Clothes that are put on and taken off while a character walks: models of their own, each on the skeleton that it was made with, which
//! `ClothWornBy` puts on the character's. The tunic is of two materials, and so of two meshes: one garment.
//!
//! Press 1, 2 and 3.

mod common;

use std::path::Path;

use bevy::{app::AnimationSystems, prelude::*, world_serialization::WorldInstanceReady};
use bevy_drape::prelude::*;
use drape_lab::clips::Clip;

/// The nodes of the clothes in the file.
const CLOTHES: [&str; 3] = ["Cape", "Skirt", "Tunic"];

fn main() -> Result<AppExit> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/mannequin.glb");
    let walk = Clip::read_all(&file)?.get("walk").cloned().ok_or("the mannequin walks")?;
    Ok(common::app("Wardrobe", "1: cape   2: skirt   3: tunic")
        .add_plugins(ClothPlugin::default())
        .insert_resource(Walk(walk))
        .add_systems(Startup, (common::spawn_scenery, setup))
        .add_systems(Update, change)
        .add_systems(PostUpdate, animate.in_set(AnimationSystems).before(TransformSystems::Propagate))
        .add_observer(leave_piece)
        .run())
}

/// What the character does.
#[derive(Resource)]
struct Walk(Clip);

/// Who wears the clothes.
#[derive(Component)]
struct Character;

/// The node of a model that is of use: the body, or one of the clothes.
#[derive(Component)]
struct Piece(&'static str);

fn setup(mut commands: Commands, assets: Res<AssetServer>) {
    common::spawn_camera(&mut commands, Vec3::new(1.5, 1.3, 2.9), Vec3::new(0.0, 0.95, 0.0));
    let character = commands.spawn((model(&assets), Piece("Body"), Character)).id();
    commands.spawn((model(&assets), Piece("Tunic"), ClothWornBy(character)));
}

/// The file has body and clothes: each piece is a scene of its own, of which the rest is left out.
fn model(assets: &AssetServer) -> WorldAssetRoot {
    WorldAssetRoot(assets.load(GltfAssetLabel::Scene(0).from_asset("mannequin.glb")))
}

/// Puts on what isn't worn, and takes off what is.
fn change(
    keys: Res<ButtonInput<KeyCode>>,
    assets: Res<AssetServer>,
    character: Single<(Entity, Option<&ClothOutfit>), With<Character>>,
    pieces: Query<&Piece>,
    mut commands: Commands,
) {
    let (character, outfit) = *character;
    for (key, name) in [KeyCode::Digit1, KeyCode::Digit2, KeyCode::Digit3].into_iter().zip(CLOTHES) {
        if !keys.just_pressed(key) {
            continue;
        }
        let is_it = |&entity: &Entity| pieces.get(entity).is_ok_and(|piece| piece.0 == name);
        match outfit.and_then(|outfit| outfit.iter().find(is_it)) {
            Some(worn) => commands.entity(worn).despawn(),
            None => drop(commands.spawn((model(&assets), Piece(name), ClothWornBy(character)))),
        }
    }
}

/// Leaves of a model what is of use. Its file says itself what is cloth, and that the tunic's two materials are one garment.
fn leave_piece(
    ready: On<WorldInstanceReady>,
    pieces: Query<&Piece>,
    names: Query<&Name>,
    children: Query<&Children>,
    mut commands: Commands,
) {
    let Ok(&Piece(piece)) = pieces.get(ready.entity) else { return };
    for node in children.iter_descendants(ready.entity) {
        let name = names.get(node).map_or("", Name::as_str);
        let is_other = name != piece && (name == "Body" || CLOTHES.contains(&name));
        // The fine cape is worn with the coarse one that it follows.
        if is_other || name == "CapeFine" && piece != "Cape" {
            commands.entity(node).despawn();
        } else if piece != "Body" {
            // The armature of clothes has no body.
            commands.entity(node).try_remove::<ClothBody>();
        }
    }
}

/// Poses the joints, as Bevy's `AnimationPlayer` does in a game.
fn animate(walk: Res<Walk>, time: Res<Time>, mut joints: Query<(&Name, &mut Transform)>) {
    for (name, mut transform) in &mut joints {
        walk.0.pose(name, time.elapsed_secs(), &mut transform);
    }
}
