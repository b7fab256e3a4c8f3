//! Whose clothes a cloth is: it meets that body, and passes through those of others.

use bevy::{ecs::system::SystemParam, prelude::*};

use crate::{
    skin::ClothSkin,
    state::Skinning,
    surroundings::body::{ClothBody, ClothBodyPart},
};

/// Bodies, and where in the hierarchy they are.
#[derive(SystemParam)]
pub(crate) struct OwnBodies<'w, 's> {
    bodies: Query<'w, 's, (), With<ClothBody>>,
    parents: Query<'w, 's, &'static ChildOf>,
    children: Query<'w, 's, &'static Children>,
    parts: Query<'w, 's, &'static ClothBodyPart>,
    skins: Query<'w, 's, &'static ClothSkin>,
}

impl OwnBodies<'_, '_> {
    /// The only body whose parts a cloth meets; none where it meets all.
    pub fn of(&self, cloth: Entity, skinning: &Skinning) -> Option<Entity> {
        if self.bodies.is_empty() || self.skins.get(cloth).is_ok_and(|skin| skin.meets_others) {
            return None;
        }
        let at_or_above = |entity: Entity| {
            let mut line = core::iter::once(entity).chain(self.parents.iter_ancestors(entity));
            line.find(|&entity| self.bodies.contains(entity))
        };
        // Clothes and body may be side by side, on the same joints.
        let joints = || skinning.0.iter().flat_map(|bound| bound.joints.iter().copied());
        let of_parts = || {
            let mut parts = joints().filter_map(|joint| self.children.get(joint).ok()).flatten();
            parts.find_map(|&part| self.parts.get(part).ok().map(|part| part.body))
        };
        at_or_above(cloth).or_else(|| at_or_above(skinning.carrier(cloth))).or_else(of_parts)
    }
}
