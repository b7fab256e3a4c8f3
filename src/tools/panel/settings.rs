//! All that can be edited, as it is in the world.

use bevy::prelude::*;

use super::{aim::Aim, beside::Beside, code, fields, memory::Memory};
use crate::{
    cloth::Cloth,
    fabric::{Fabric, handle::FabricHandle},
    parameter::Parameter,
    simulate::budget::ClothBudget,
    surroundings::{ClothGravity, wind::Wind},
};

/// All that can be edited.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Settings {
    /// Of the first chosen cloth.
    pub cloth: Option<(Cloth, Fabric)>,
    /// Of the first chosen cloth.
    pub beside: Beside,
    pub gravity: Option<Vec3>,
    pub budget: Option<ClothBudget>,
    pub wind: Option<(Entity, Wind, Aim)>,
    pub clock: Option<Clock>,
    #[cfg(feature = "debug")]
    pub debug: super::debug::Switches,
}

/// The game's clock.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
pub(super) struct Clock {
    pub is_paused: bool,
    /// Speed of the whole game's clock, not of cloth alone: 1 is real time, 0.1 slow motion. 0.05 to 2.
    #[reflect(@Parameter::positive("×", (0.02, 2.0)).logarithmic(0.02).entered((0.001, 10.0)).titled("Game speed"))]
    pub speed: f32,
}

impl Settings {
    pub fn read(world: &World, chosen: &[Entity], memory: &Memory) -> Self {
        let cloth = chosen
            .first()
            .and_then(|&cloth| Some((world.get::<Cloth>(cloth)?.clone(), world.get::<Fabric>(cloth)?.clone())));
        let wind = memory.wind.and_then(|entity| {
            let wind = world.get::<Wind>(entity)?.clone();
            // A calm has no direction: the one that was set here is kept.
            let kept = memory.aim.filter(|&(of, velocity, _)| of == entity && velocity == wind.velocity);
            let aim = kept.map_or_else(|| Aim::of(wind.velocity), |(_, _, aim)| aim);
            Some((entity, wind, aim))
        });
        Self {
            cloth,
            beside: chosen.first().map(|&cloth| Beside::read(world, cloth)).unwrap_or_default(),
            budget: world.get_resource().copied(),
            wind,
            gravity: world.get_resource::<ClothGravity>().map(|gravity| gravity.0),
            clock: world
                .get_resource::<Time<Virtual>>()
                .map(|time| Clock { is_paused: time.is_paused(), speed: time.relative_speed() }),
            #[cfg(feature = "debug")]
            debug: super::debug::Switches::read(world, chosen),
        }
    }

    /// Writes what differs from `before`.
    pub fn write(&self, world: &mut World, before: &Self, chosen: &[Entity], memory: &mut Memory) {
        if let (Some(before), Some(after)) = (&before.cloth, &self.cloth) {
            for &cloth in chosen {
                fields::write(world, cloth, &before.0, &after.0);
                // What fits the first cloth needn't fit the others.
                if fields::write_good(world, cloth, &before.1, &after.1, |fabric| fabric.material().is_ok()) {
                    detach(world, cloth);
                }
            }
        }
        self.beside.write(world, &before.beside, chosen);
        if let (Some((_, old, old_aim)), Some((entity, wind, aim))) = (&before.wind, &self.wind) {
            let mut wind = wind.clone();
            if aim != old_aim {
                wind.velocity = aim.velocity();
                memory.aim = Some((*entity, wind.velocity, *aim));
            }
            fields::write(world, *entity, old, &wind);
        }
        if let Some(gravity) = self.gravity.filter(|_| self.gravity != before.gravity)
            && let Some(mut own) = world.get_resource_mut::<ClothGravity>()
        {
            own.0 = gravity;
        }
        if let (Some(before), Some(after)) = (&before.budget, &self.budget)
            && fields::differing(before, after).next().is_some()
            && let Some(mut own) = world.get_resource_mut::<ClothBudget>()
        {
            *own = *after;
        }
        if let Some(clock) = self.clock.filter(|_| self.clock != before.clock)
            && let Some(mut time) = world.get_resource_mut::<Time<Virtual>>()
        {
            time.set_relative_speed(clock.speed);
            if clock.is_paused { time.pause() } else { time.unpause() }
        }
        #[cfg(feature = "debug")]
        self.debug.write(world, &before.debug, chosen);
    }

    /// The chosen cloth as Rust code.
    pub fn cloth_code(&self) -> Option<String> {
        let (cloth, fabric) = self.cloth.as_ref()?;
        let parts = [code::component(cloth), code::component(fabric)].into_iter().chain(self.beside.code());
        Some(parts.map(|part| part + ",\n").collect())
    }

    /// The chosen wind as Rust code.
    pub fn wind_code(&self) -> Option<String> {
        self.wind.as_ref().map(|(_, wind, _)| format!("{},\n", code::component(wind)))
    }
}

/// Keeps a cloth's fabric as it is edited here.
pub(super) fn detach(world: &mut World, cloth: Entity) {
    if let Some(mut follower) = world.get_mut::<FabricHandle>(cloth).filter(|follower| !follower.detached) {
        follower.detached = true;
    }
}
