//! Looks around in the scene of a file, before it is anybody's: nodes, the primitives of their meshes, names.

use bevy::{
    gltf::{GltfExtras, GltfMaterialExtras, GltfMaterialName, GltfMeshExtras, GltfMeshName},
    mesh::skinning::SkinnedMesh,
    platform::collections::HashSet,
    prelude::*,
};

use super::{
    property::{Place, Properties},
    report::Report,
};

/// An object, a bone or an empty, and what is written on it.
pub(super) struct Node {
    pub entity: Entity,
    /// How warnings call it.
    pub subject: String,
    pub properties: Properties,
    /// The parts of its mesh, one for each material.
    pub parts: Vec<Part>,
}

/// A primitive of a node's mesh.
pub(super) struct Part {
    pub entity: Entity,
    /// What is written on its mesh and its material.
    pub properties: Properties,
    pub is_skinned: bool,
}

/// The bones of all skeletons in a scene.
pub(super) fn bones(world: &mut World) -> HashSet<Entity> {
    let mut skins = world.query::<&SkinnedMesh>();
    skins.iter(world).flat_map(|skin| skin.joints.iter().copied()).collect()
}

/// All nodes of a scene, always in the same order.
pub(super) fn nodes(world: &mut World, bones: &HashSet<Entity>, report: &mut Report) -> Vec<Node> {
    let mut entities = world.query_filtered::<Entity, (With<Transform>, With<ChildOf>, Without<Mesh3d>)>();
    let mut entities: Vec<Entity> = entities.iter(world).collect();
    entities.sort_unstable();
    entities
        .into_iter()
        .map(|entity| {
            let kind = if bones.contains(&entity) { "bone" } else { "object" };
            let subject = format!("{kind} \"{}\"", name(world, entity));
            let properties = read::<GltfExtras>(world, entity, Place::Node, &subject, report);
            let children = world.get::<Children>(entity).map_or(&[][..], |children| children);
            let parts = children.iter().filter(|&&child| world.get::<Mesh3d>(child).is_some());
            let parts = parts.map(|&entity| part(world, entity, report)).collect();
            Node { entity, subject, properties, parts }
        })
        .collect()
}

fn part(world: &World, entity: Entity, report: &mut Report) -> Part {
    let named = |kind: &str, name: Option<&String>| match name {
        Some(name) => format!("{kind} \"{name}\""),
        None => format!("a {kind} without a name"),
    };
    let mesh = named("mesh", world.get::<GltfMeshName>(entity).map(|name| &name.0));
    let material = named("material", world.get::<GltfMaterialName>(entity).map(|name| &name.0));
    let of_primitive = read::<GltfExtras>(world, entity, Place::Mesh, &mesh, report);
    let of_mesh = read::<GltfMeshExtras>(world, entity, Place::Mesh, &mesh, report);
    let of_material = read::<GltfMaterialExtras>(world, entity, Place::Material, &material, report);
    let is_skinned = world.get::<SkinnedMesh>(entity).is_some();
    Part { entity, properties: of_primitive.or(&of_mesh).or(&of_material), is_skinned }
}

/// What an entity has of the extras of a file.
pub(super) trait Extras: Component {
    /// The text, which is JSON.
    fn text(&self) -> &str;
}

macro_rules! extras {
    ($($component:ty),+) => {
        $(impl Extras for $component {
            fn text(&self) -> &str {
                &self.value
            }
        })+
    };
}

extras!(GltfExtras, GltfMeshExtras, GltfMaterialExtras, bevy::gltf::GltfSceneExtras);

/// Reads what is written on an entity.
pub(super) fn read<E: Extras>(
    world: &World,
    entity: Entity,
    place: Place,
    subject: &str,
    report: &mut Report,
) -> Properties {
    let extras = world.get::<E>(entity);
    extras.map_or_else(Properties::default, |extras| Properties::read(extras.text(), place, subject, report))
}

/// The name of an entity; empty for one without.
pub(super) fn name(world: &World, entity: Entity) -> &str {
    world.get::<Name>(entity).map_or("", Name::as_str)
}
