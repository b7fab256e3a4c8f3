//! Furnishes the scene of a file with what its properties ask for.

use bevy::{
    asset::LoadContext,
    gltf::GltfSceneExtras,
    platform::collections::{HashMap, HashSet},
    prelude::*,
};

use super::{
    node::{self, Node},
    paint::Painted,
    property::Place,
    report::Report,
};
use crate::surroundings::{body::ClothBody, wind::Wind};

/// The scene of a file, and what is known of the file.
pub(super) struct Scenery<'a, 'c> {
    pub world: &'a mut World,
    pub context: &'a mut LoadContext<'c>,
    /// What is painted on its meshes, by the labels of their assets.
    pub painted: &'a HashMap<String, Painted>,
    pub report: &'a mut Report,
}

impl Scenery<'_, '_> {
    /// Inserts the components that its properties ask for.
    pub fn furnish(mut self, root: Entity) {
        let bones = node::bones(self.world);
        let nodes = node::nodes(self.world, &bones, self.report);
        let subject = format!("scene \"{}\"", node::name(self.world, root));
        let of_all = node::read::<GltfSceneExtras>(self.world, root, Place::Scene, &subject, self.report);
        let mut cloths = Vec::new();
        let is_proxy = |node: &&Node| node.properties.proxy.is_some();
        for node in nodes.iter().filter(|node| !is_proxy(node)) {
            let made = self.make_garment(node, &of_all, &bones);
            if !made.is_empty() {
                cloths.push((node.entity, made));
            }
            self.make_collider(node);
            if let Some(speed) = node.properties.wind {
                // An empty's arrow points along Blender's Z, which is Y here.
                self.world.entity_mut(node.entity).insert(Wind { velocity: Vec3::Y * speed, ..default() });
            }
        }
        for node in nodes.iter().filter(is_proxy) {
            self.make_proxy(node, &cloths);
        }
        for node in nodes.iter().filter(|node| node.properties.body == Some(true)) {
            let except = self.left_out_of(node.entity, &nodes);
            self.world.entity_mut(node.entity).insert(ClothBody { except, ..default() });
        }
        let is_painted = || self.painted.values().any(|painted| painted.looseness.is_some());
        if cloths.is_empty() && is_painted() {
            info!(
                "{}: _CLOTH is painted, and nothing says that it is cloth; write the property `cloth` on the object, and export \
                 Custom Properties",
                self.report.file
            );
        }
    }

    /// The names of what is no part of the body on a node: what follows a cloth, and what has a collider of its own, or is to have
    /// none.
    fn left_out_of(&self, body: Entity, nodes: &[Node]) -> Vec<String> {
        let is_left_out = |node: &&Node| node.properties.proxy.is_some() || node.properties.collider.is_some();
        let is_below = |node: &&Node| self.ancestors(node.entity).any(|ancestor| ancestor == body);
        let names = nodes.iter().filter(is_left_out).filter(is_below).map(|node| node::name(self.world, node.entity));
        names.map(Into::into).collect()
    }

    /// The entities above one.
    fn ancestors(&self, entity: Entity) -> impl Iterator<Item = Entity> {
        let parent = |entity: &Entity| self.world.get::<ChildOf>(*entity).map(ChildOf::parent);
        core::iter::successors(parent(&entity), parent)
    }

    /// Whether an entity hangs on a bone.
    pub(super) fn hangs_on(&self, entity: Entity, bones: &HashSet<Entity>) -> bool {
        self.ancestors(entity).any(|ancestor| bones.contains(&ancestor))
    }
}
