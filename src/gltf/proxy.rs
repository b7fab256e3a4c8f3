//! Has fine meshes follow the cloth that they name.

use bevy::prelude::*;

use super::{
    node::{self, Node},
    report::nearest,
    scene::Scenery,
};
use crate::proxy::ClothProxy;

impl Scenery<'_, '_> {
    /// Has the mesh of `node` follow the object that it names, one of the `cloths`, each of which comes with the entities that are cloth of
    /// it. What is followed is hidden.
    pub(super) fn make_proxy(&mut self, node: &Node, cloths: &[(Entity, Vec<Entity>)]) {
        let Some(wanted) = &node.properties.proxy else { return };
        let found = cloths.iter().find(|(object, _)| node::name(self.world, *object) == wanted);
        let problem = match found {
            Some((_, cloth)) if cloth.len() > 1 => {
                "each of its materials is a cloth of its own; give all of them the same properties".to_owned()
            }
            Some(_) if node.parts.is_empty() => {
                let refused = "cloth_proxy does nothing where there is no mesh; write it on an object that has one";
                return self.report.warn(&node.subject, refused);
            }
            Some((_, cloth)) => {
                let fine = if let [part] = &node.parts[..] { part.entity } else { node.entity };
                let proxy = ClothProxy::new(cloth[0]);
                self.world.entity_mut(fine).insert(proxy);
                self.world.entity_mut(cloth[0]).insert(Visibility::Hidden);
                return;
            }
            None => {
                let names = cloths.iter().map(|(object, _)| node::name(self.world, *object));
                match nearest(wanted, names) {
                    Some(name) => format!("no object of that name is cloth; did you mean {name}?"),
                    None => "no object of that name is cloth; write `cloth` on it".to_owned(),
                }
            }
        };
        self.report.warn(&node.subject, format_args!("cloth_proxy is {wanted}: {problem}"));
    }
}
