//! What was there before anything was edited, and the way back to it.

use bevy::prelude::*;

use super::{
    ClothPanel,
    beside::{Beside, BesideRef},
    memory::Memory,
};
use crate::{
    cloth::Cloth,
    fabric::{Fabric, handle::FabricHandle},
    pins::Pins,
    simulate::budget::ClothBudget,
    state::ClothStatus,
    surroundings::{ClothGravity, wind::Wind},
};

/// A cloth as it was once it was ready.
#[derive(Component, Clone, Debug)]
#[component(clone_behavior = Ignore)]
pub(super) struct LoadedCloth {
    cloth: Cloth,
    fabric: Fabric,
    beside: Beside,
    pins: Pins,
    /// Whether it kept its fabric apart from the asset that it has a handle of.
    is_detached: bool,
}

/// A wind as it was at first.
#[derive(Component, Clone, Debug)]
#[component(clone_behavior = Ignore)]
pub(super) struct LoadedWind(Wind);

/// Keeps all that is new.
pub(super) fn remember(
    mut commands: Commands,
    cloths: Query<
        (Entity, &Cloth, &Fabric, BesideRef, &Pins, Option<&FabricHandle>, &ClothStatus),
        Without<LoadedCloth>,
    >,
    winds: Query<(Entity, &Wind), Without<LoadedWind>>,
    (gravity, budget): (Option<Res<ClothGravity>>, Option<Res<ClothBudget>>),
    mut panel: ResMut<ClothPanel>,
) {
    for (entity, cloth, fabric, beside, pins, follower, status) in &cloths {
        if status.is_running() {
            commands.entity(entity).try_insert(LoadedCloth {
                cloth: cloth.clone(),
                fabric: fabric.clone(),
                beside: beside.cloned(),
                pins: pins.clone(),
                is_detached: follower.is_some_and(|follower| follower.detached),
            });
        }
    }
    for (entity, wind) in &winds {
        commands.entity(entity).try_insert(LoadedWind(wind.clone()));
    }
    let memory = &mut panel.bypass_change_detection().memory;
    memory.gravity = memory.gravity.or(gravity.map(|gravity| gravity.0));
    memory.budget = memory.budget.or(budget.map(|budget| *budget));
}

/// Gives a cloth back what it had. It follows its fabric's asset again.
pub(super) fn revert_cloth(world: &mut World, cloth: Entity) {
    let Some(loaded) = world.get::<LoadedCloth>(cloth).cloned() else { return };
    if let Some(mut own) = world.get_mut::<Cloth>(cloth) {
        own.set_if_neq(loaded.cloth);
    }
    if let Some(mut own) = world.get_mut::<Fabric>(cloth) {
        own.set_if_neq(loaded.fabric);
    }
    if let Some(mut own) = world.get_mut::<Pins>(cloth) {
        own.set_if_neq(loaded.pins);
    }
    loaded.beside.restore(world, cloth);
    // Written in any case: it has the asset's values copied again, which may have come later than the cloth was ready.
    if let Some(mut follower) = world.get_mut::<FabricHandle>(cloth) {
        follower.detached = loaded.is_detached;
    }
}

/// Gives gravity, the budget and all winds back what they had. Winds that the panel has added go.
pub(super) fn revert_surroundings(world: &mut World, memory: &mut Memory) {
    for wind in memory.added_winds.drain(..) {
        world.commands().entity(wind).try_despawn();
    }
    memory.aim = None;
    let mut winds = world.query::<(&mut Wind, &LoadedWind)>();
    for (mut wind, loaded) in winds.iter_mut(world) {
        wind.set_if_neq(loaded.0.clone());
    }
    if let (Some(loaded), Some(mut gravity)) = (memory.gravity, world.get_resource_mut::<ClothGravity>()) {
        gravity.set_if_neq(ClothGravity(loaded));
    }
    if let (Some(loaded), Some(mut budget)) = (memory.budget, world.get_resource_mut::<ClothBudget>()) {
        budget.set_if_neq(loaded);
    }
}
