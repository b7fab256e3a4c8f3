//! Components that a cloth may have beside it.

use bevy::{
    ecs::{component::Mutable, query::QueryData},
    prelude::*,
    reflect::structs::Struct,
};

use super::{code, fields};
use crate::{
    fabric::ClothSprings,
    skin::{ClothInertia, ClothSkin, ClothTeleport},
};

/// Components that a cloth may have beside it, as far as it has them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Beside {
    pub springs: Option<ClothSprings>,
    pub skin: Option<ClothSkin>,
    pub inertia: Option<ClothInertia>,
    pub teleport: Option<ClothTeleport>,
}

/// The same in a query.
#[derive(QueryData)]
pub(super) struct BesideRef {
    springs: Option<&'static ClothSprings>,
    skin: Option<&'static ClothSkin>,
    inertia: Option<&'static ClothInertia>,
    teleport: Option<&'static ClothTeleport>,
}

impl BesideRefItem<'_, '_> {
    pub fn cloned(&self) -> Beside {
        Beside {
            springs: self.springs.cloned(),
            skin: self.skin.cloned(),
            inertia: self.inertia.copied(),
            teleport: self.teleport.copied(),
        }
    }
}

impl Beside {
    pub fn read(world: &World, cloth: Entity) -> Self {
        Self {
            springs: world.get(cloth).cloned(),
            skin: world.get(cloth).cloned(),
            inertia: world.get(cloth).cloned(),
            teleport: world.get(cloth).cloned(),
        }
    }

    /// Writes what differs from `before` into those of the chosen cloths that have it.
    pub fn write(&self, world: &mut World, before: &Self, chosen: &[Entity]) {
        edit(world, &before.springs, &self.springs, chosen);
        edit(world, &before.skin, &self.skin, chosen);
        edit(world, &before.inertia, &self.inertia, chosen);
        edit(world, &before.teleport, &self.teleport, chosen);
    }

    /// Gives them back to a cloth: what has gone comes, and what has come goes.
    pub fn restore(self, world: &mut World, cloth: Entity) {
        restore(world, cloth, self.springs);
        restore(world, cloth, self.skin);
        restore(world, cloth, self.inertia);
        restore(world, cloth, self.teleport);
    }

    /// Each of them as Rust code.
    pub fn code(&self) -> impl Iterator<Item = String> {
        let Self { springs, skin, inertia, teleport } = self;
        let codes = [
            springs.as_ref().map(code::component),
            skin.as_ref().map(code::component),
            inertia.as_ref().map(code::component),
            teleport.as_ref().map(code::component),
        ];
        codes.into_iter().flatten()
    }
}

fn edit<C>(world: &mut World, before: &Option<C>, after: &Option<C>, chosen: &[Entity])
where
    C: Component<Mutability = Mutable> + Struct + Clone,
{
    if let (Some(before), Some(after)) = (before, after) {
        for &cloth in chosen {
            fields::write(world, cloth, before, after);
        }
    }
}

fn restore<C: Component + PartialEq>(world: &mut World, cloth: Entity, loaded: Option<C>) {
    let Ok(mut entity) = world.get_entity_mut(cloth) else { return };
    match loaded {
        Some(loaded) if entity.get() != Some(&loaded) => drop(entity.insert(loaded)),
        Some(_) => {}
        None => drop(entity.remove::<C>()),
    }
}
