//! Cloths and winds to choose from, and what those that are chosen have in common.

use bevy::{
    ecs::query::QueryFilter,
    prelude::*,
    reflect::{Typed, structs::Struct},
};

use super::fields;
use crate::{
    cloth::Cloth,
    fabric::{ClothSprings, Fabric},
    skin::{ClothInertia, ClothSkin, ClothTeleport},
    state::ClothStatus,
};

/// All entities that match, with their names, by name.
pub(super) fn named<F: QueryFilter>(world: &mut World, otherwise: &str) -> Vec<(Entity, String)> {
    let mut query = world.query_filtered::<(Entity, Option<&Name>), F>();
    let name = |(entity, name): (Entity, Option<&Name>)| {
        (entity, name.map_or_else(|| format!("{otherwise} {entity}"), |name| name.to_string()))
    };
    let mut found: Vec<_> = query.iter(world).map(name).collect();
    found.sort_unstable_by(|a, b| (&a.1, a.0).cmp(&(&b.1, b.0)));
    tell_apart(&mut found);
    found
}

/// Adds the entity to names that are there more than once.
fn tell_apart(found: &mut [(Entity, String)]) {
    let names: Vec<String> = found.iter().map(|(_, name)| name.clone()).collect();
    for (i, (entity, name)) in found.iter_mut().enumerate() {
        if (i > 0 && names[i - 1] == names[i]) || names.get(i + 1) == Some(&names[i]) {
            *name = format!("{name} ({entity})");
        }
    }
}

/// Why a chosen cloth doesn't run.
pub(super) fn trouble(world: &World, chosen: &[Entity]) -> Option<(&'static str, String)> {
    chosen.iter().find_map(|&cloth| match world.get::<ClothStatus>(cloth)? {
        ClothStatus::Waiting => {
            Some(("Waits for its mesh", "It is built once its Mesh3d, or those below it, have loaded.".into()))
        }
        ClothStatus::Building => Some(("Is being built", "Its mesh is large: that takes some frames.".into())),
        ClothStatus::Failed(error) => Some(("Can't be built", error.to_string())),
        ClothStatus::Ready | ClothStatus::Asleep => None,
    })
}

/// Names of the fields in which cloths differ from the first.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Differing {
    pub cloth: Vec<&'static str>,
    pub fabric: Vec<&'static str>,
    pub springs: Vec<&'static str>,
    pub skin: Vec<&'static str>,
    pub inertia: Vec<&'static str>,
    pub teleport: Vec<&'static str>,
}

impl Differing {
    pub fn find(world: &World, chosen: &[Entity]) -> Self {
        Self {
            cloth: differing_in::<Cloth>(world, chosen),
            fabric: differing_in::<Fabric>(world, chosen),
            springs: differing_in::<ClothSprings>(world, chosen),
            skin: differing_in::<ClothSkin>(world, chosen),
            inertia: differing_in::<ClothInertia>(world, chosen),
            teleport: differing_in::<ClothTeleport>(world, chosen),
        }
    }
}

fn differing_in<T>(world: &World, chosen: &[Entity]) -> Vec<&'static str>
where
    T: Component + Struct + Typed,
{
    let mut components = chosen.iter().filter_map(|&cloth| world.get::<T>(cloth));
    let Some(first) = components.next() else { return Vec::new() };
    let names = T::type_info().as_struct().map(|info| info.field_names()).unwrap_or_default();
    let mut found: Vec<_> = components.flat_map(|other| fields::differing(first, other)).collect();
    found.sort_unstable();
    found.dedup();
    found.into_iter().filter_map(|i| names.get(i).copied()).collect()
}
