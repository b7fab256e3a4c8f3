//! Outfits: clothes that are put on the skeleton of another entity, joint by joint of the same name.

use bevy::{ecs::system::SystemParam, mesh::skinning::SkinnedMesh, platform::collections::HashMap, prelude::*};

use crate::{frame::PATIENCE, mesh_input::follows};

/// Puts clothes on a character: every skinned mesh on this entity or below it follows the skeleton of the character from now on,
/// each joint that of the same [`Name`] at or below the entity that is given.
///
/// For clothes that are models of their own, made on the same skeleton as the character. Insert it on the root of their scene, at any
/// time, be either loaded or not; remove it to take them off: then they follow their own skeleton again. Cloth starts anew where its
/// skin is by then ([`ClothReset`](crate::prelude::ClothReset)). What isn't cloth, such as shoes, is put on as well.
///
/// A joint that the character lacks is told of after five seconds, unless nothing follows it; till then nothing is put on. Have
/// clothes that aren't cloth be children of the character: the renderer culls them by where their entity is.
///
/// ```
/// # use bevy::{prelude::*, world_serialization::WorldAssetRoot};
/// # use bevy_drape::prelude::*;
/// # #[derive(Component)] struct Hero;
/// fn put_on_coat(mut commands: Commands, assets: Res<AssetServer>, hero: Single<Entity, With<Hero>>) {
///     let coat = assets.load("coat.glb#Scene0");
///     commands.spawn((WorldAssetRoot(coat), ClothWornBy(*hero), ChildOf(*hero)));
/// }
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq, Reflect)]
#[relationship(relationship_target = ClothOutfit)]
#[require(Unworn)]
#[reflect(Component, Debug, Clone, PartialEq)]
pub struct ClothWornBy(pub Entity);

/// The clothes that are put on a character, each of which is [`ClothWornBy`] it.
#[derive(Component, Debug, Default, Reflect)]
#[relationship_target(relationship = ClothWornBy)]
#[reflect(Component, Debug)]
pub struct ClothOutfit(Vec<Entity>);

/// How long some of an outfit couldn't be put on, s.
#[derive(Component, Clone, Copy, Debug, Default)]
#[component(clone_behavior = Ignore)]
pub(crate) struct Unworn(f32);

/// The joints that a mesh followed before it was put on a character, and that character.
#[derive(Component, Clone, Debug)]
#[component(clone_behavior = Ignore)]
pub(crate) struct OwnJoints {
    joints: Vec<Entity>,
    character: Entity,
}

/// Names in the hierarchy.
#[derive(SystemParam)]
pub(crate) struct Names<'w, 's> {
    names: Query<'w, 's, &'static Name>,
    outfits: Query<'w, 's, (), With<ClothWornBy>>,
    children: Query<'w, 's, &'static Children>,
}

impl Names<'_, '_> {
    /// The first entity of each name at or below a character, but for those of clothes that are there.
    fn below(&self, character: Entity) -> HashMap<&str, Entity> {
        let mut found = HashMap::new();
        let mut next = vec![character];
        while let Some(entity) = next.pop() {
            if entity != character && self.outfits.contains(entity) {
                continue;
            }
            if let Ok(name) = self.names.get(entity) {
                found.entry(name.as_str()).or_insert(entity);
            }
            next.extend(self.children.get(entity).into_iter().flatten().rev());
        }
        found
    }
}

/// Puts on what has come, or been given to another character.
pub(crate) fn put_on(
    mut commands: Commands,
    mut outfits: Query<(Entity, &ClothWornBy, &mut Unworn)>,
    mut worn: Query<(&mut SkinnedMesh, Option<&Mesh3d>, Option<&OwnJoints>)>,
    names: Names,
    meshes: Res<Assets<Mesh>>,
    time: Res<Time>,
) {
    for (outfit, &ClothWornBy(character), mut unworn) in &mut outfits {
        let (mut by_name, mut missing) = (None, None);
        for entity in core::iter::once(outfit).chain(names.children.iter_descendants(outfit)) {
            let Ok((mut skeleton, mesh, own)) = worn.get_mut(entity) else { continue };
            if own.is_some_and(|own| own.character == character) {
                continue;
            }
            let own = own.map_or(&skeleton.joints, |own| &own.joints).clone();
            let by_name = by_name.get_or_insert_with(|| names.below(character));
            let counterpart = |joint: &Entity| names.names.get(*joint).ok().and_then(|name| by_name.get(name.as_str()));
            let is_followed =
                |joint: usize| mesh.and_then(|mesh| meshes.get(&mesh.0)).is_none_or(|mesh| follows(mesh, joint));
            let lacking = own.iter().enumerate().find(|&(i, joint)| counterpart(joint).is_none() && is_followed(i));
            if let Some((_, &joint)) = lacking {
                missing = Some((entity, joint));
                continue;
            }
            skeleton.joints = own.iter().map(|joint| *counterpart(joint).unwrap_or(joint)).collect();
            commands.entity(entity).try_insert(OwnJoints { joints: own, character });
        }
        let waited = unworn.0;
        unworn.0 = if missing.is_some() { waited + time.delta_secs() } else { 0.0 };
        if let Some((mesh, joint)) = missing.filter(|_| waited <= PATIENCE && unworn.0 > PATIENCE) {
            let name = names.names.get(joint).map_or("without a Name", |name| name.as_str());
            warn!(
                "outfit {outfit} can't be put on {character}: its mesh {mesh} follows a joint {name:?}, and there is none of that \
                 name at or below the character; give ClothWornBy the entity that is above its skeleton, and clothes made on the same"
            );
        }
    }
}

/// Gives an outfit that is taken off its own skeleton back.
pub(crate) fn on_taken_off(
    removed: On<Remove, ClothWornBy>,
    mut commands: Commands,
    mut worn: Query<(&mut SkinnedMesh, &OwnJoints)>,
    children: Query<&Children>,
) {
    let outfit = removed.entity;
    for entity in core::iter::once(outfit).chain(children.iter_descendants(outfit)) {
        if let Ok((mut skeleton, own)) = worn.get_mut(entity) {
            skeleton.joints.clone_from(&own.joints);
            commands.entity(entity).try_remove::<OwnJoints>();
        }
    }
}
