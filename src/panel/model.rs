//! What the panel shows: read from the world, edited by the controls, and written back where it differs.

use bevy::prelude::*;

use super::{
    ClothChoice,
    aim::Aim,
    code, fields, loaded,
    memory::{Memory, Readings},
};
use crate::{
    cloth::{Cloth, ClothGravity, ClothStatus},
    commands::ClothCommands,
    fabric::{Fabric, handle::FabricHandle},
    pins::Pins,
    wind::Wind,
};

/// All that the controls see.
pub(super) struct Model {
    /// Cloths to choose from, and their names.
    pub cloths: Vec<(Entity, String)>,
    pub choice: ClothChoice,
    /// Those that are chosen.
    pub chosen: Vec<Entity>,
    /// Why a chosen cloth doesn't run: briefly and in full.
    pub trouble: Option<(&'static str, String)>,
    /// Winds to choose from, and their names.
    pub winds: Vec<(Entity, String)>,
    pub settings: Settings,
    /// Names of the fields in which the chosen cloths differ.
    pub differing: Vec<&'static str>,
    /// Some of the chosen cloths follow a fabric's asset.
    pub follows_asset: bool,
    pub readings: Readings,
    /// What buttons have asked for.
    pub asks: Vec<Ask>,
}

/// All that can be edited.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Settings {
    /// Of the first chosen cloth.
    pub cloth: Option<(Cloth, Fabric)>,
    pub gravity: Option<Vec3>,
    pub wind: Option<(Entity, Wind, Aim)>,
    pub clock: Option<Clock>,
    #[cfg(feature = "debug")]
    pub debug: super::debug::Switches,
}

/// The game's clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Clock {
    pub is_paused: bool,
    /// Of the real one's speed.
    pub speed: f32,
}

/// What a button asks for.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Ask {
    Step,
    Reset,
    Pin(Pins),
    UnpinAll,
    Preset(Fabric),
    AddWind,
    ChooseWind(Entity),
    RevertCloth,
    RevertSurroundings,
}

impl Model {
    pub fn read(world: &mut World, choice: ClothChoice, memory: &mut Memory) -> Self {
        let mut cloths = named::<With<Cloth>>(world, "Cloth");
        let mut winds = named::<With<Wind>>(world, "Wind");
        tell_apart(&mut cloths);
        tell_apart(&mut winds);
        let choice = match choice {
            ClothChoice::One(cloth) if cloths.iter().all(|&(entity, _)| entity != cloth) => ClothChoice::First,
            choice => choice,
        };
        let chosen: Vec<Entity> = match choice {
            ClothChoice::First => cloths.iter().map(|&(entity, _)| entity).take(1).collect(),
            ClothChoice::One(cloth) => vec![cloth],
            ClothChoice::All => cloths.iter().map(|&(entity, _)| entity).collect(),
        };
        let is_there = |&wind: &Entity| winds.iter().any(|&(entity, _)| entity == wind);
        memory.wind = memory.wind.filter(is_there).or(winds.first().map(|&(entity, _)| entity));
        let follows = |&cloth: &Entity| world.get::<FabricHandle>(cloth).is_some_and(|follower| !follower.detached);
        Self {
            trouble: trouble(world, &chosen),
            differing: differing(world, &chosen),
            follows_asset: chosen.iter().any(follows),
            settings: Settings::read(world, &chosen, memory),
            readings: memory.readings.clone(),
            cloths,
            choice,
            chosen,
            winds,
            asks: Vec::new(),
        }
    }

    /// Writes what the controls have changed since `before`, and does what buttons have asked for.
    pub fn write(self, world: &mut World, before: &Settings, memory: &mut Memory) {
        self.settings.write(world, before, &self.chosen, memory);
        for ask in self.asks {
            answer(world, ask, &self.chosen, memory);
        }
        world.flush();
    }
}

impl Settings {
    fn read(world: &World, chosen: &[Entity], memory: &Memory) -> Self {
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
            wind,
            gravity: world.get_resource::<ClothGravity>().map(|gravity| gravity.0),
            clock: world
                .get_resource::<Time<Virtual>>()
                .map(|time| Clock { is_paused: time.is_paused(), speed: time.relative_speed() }),
            #[cfg(feature = "debug")]
            debug: super::debug::Switches::read(world, chosen),
        }
    }

    fn write(&self, world: &mut World, before: &Self, chosen: &[Entity], memory: &mut Memory) {
        if let (Some(before), Some(after)) = (&before.cloth, &self.cloth) {
            for &cloth in chosen {
                fields::write(world, cloth, &before.0, &after.0);
                if fields::write(world, cloth, &before.1, &after.1) {
                    detach(world, cloth);
                }
            }
        }
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
        Some(format!("{},\n{},\n", code::component(cloth), code::component(fabric)))
    }

    /// The chosen wind as Rust code.
    pub fn wind_code(&self) -> Option<String> {
        self.wind.as_ref().map(|(_, wind, _)| format!("{},\n", code::component(wind)))
    }
}

fn answer(world: &mut World, ask: Ask, chosen: &[Entity], memory: &mut Memory) {
    match ask {
        Ask::Step => memory.is_step_asked = true,
        Ask::Reset => chosen.iter().for_each(|&cloth| {
            world.commands().entity(cloth).reset_cloth();
        }),
        Ask::Pin(pins) => chosen.iter().for_each(|&cloth| {
            world.commands().entity(cloth).pin_cloth(pins.clone());
        }),
        Ask::UnpinAll => chosen.iter().for_each(|&cloth| {
            if let Some(mut pins) = world.get_mut::<Pins>(cloth) {
                pins.set_if_neq(Pins::none());
            }
        }),
        Ask::Preset(fabric) => chosen.iter().for_each(|&cloth| {
            if world.get_mut::<Fabric>(cloth).is_some_and(|mut own| own.set_if_neq(fabric.clone())) {
                detach(world, cloth);
            }
        }),
        Ask::AddWind => {
            let breeze = Wind { velocity: Vec3::Z * 2.0, ..default() };
            let wind = world.spawn((breeze, Name::new("Wind of the panel"))).id();
            memory.added_winds.push(wind);
            memory.wind = Some(wind);
        }
        Ask::ChooseWind(wind) => memory.wind = Some(wind),
        Ask::RevertCloth => chosen.iter().for_each(|&cloth| loaded::revert_cloth(world, cloth)),
        Ask::RevertSurroundings => loaded::revert_surroundings(world, memory),
    }
}

/// Keeps a cloth's fabric as it is edited here.
fn detach(world: &mut World, cloth: Entity) {
    if let Some(mut follower) = world.get_mut::<FabricHandle>(cloth).filter(|follower| !follower.detached) {
        follower.detached = true;
    }
}

/// All entities that match, with their names, by name.
fn named<F: bevy::ecs::query::QueryFilter>(world: &mut World, otherwise: &str) -> Vec<(Entity, String)> {
    let mut query = world.query_filtered::<(Entity, Option<&Name>), F>();
    let name = |(entity, name): (Entity, Option<&Name>)| {
        (entity, name.map_or_else(|| format!("{otherwise} {entity}"), |name| name.to_string()))
    };
    let mut found: Vec<_> = query.iter(world).map(name).collect();
    found.sort_unstable_by(|a, b| (&a.1, a.0).cmp(&(&b.1, b.0)));
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
fn trouble(world: &World, chosen: &[Entity]) -> Option<(&'static str, String)> {
    chosen.iter().find_map(|&cloth| match world.get::<ClothStatus>(cloth)? {
        ClothStatus::Waiting => Some(("Waits for its mesh", "It is built once its Mesh3d has loaded.".into())),
        ClothStatus::Failed(error) => Some(("Can't be built", error.to_string())),
        ClothStatus::Ready => None,
    })
}

/// Names of the fields in which cloths differ from the first.
fn differing(world: &World, chosen: &[Entity]) -> Vec<&'static str> {
    let Some((first, others)) = chosen.split_first() else { return Vec::new() };
    let mut names = Vec::new();
    for other in others {
        names.extend(differing_in::<Cloth>(world, *first, *other));
        names.extend(differing_in::<Fabric>(world, *first, *other));
    }
    names.sort_unstable();
    names.dedup();
    names
}

fn differing_in<T>(world: &World, one: Entity, other: Entity) -> Vec<&'static str>
where
    T: Component + bevy::reflect::structs::Struct + bevy::reflect::Typed,
{
    let (Some(a), Some(b)) = (world.get::<T>(one), world.get::<T>(other)) else { return Vec::new() };
    let names = T::type_info().as_struct().map(|info| info.field_names()).unwrap_or_default();
    fields::differing(a, b).filter_map(|i| names.get(i).copied()).collect()
}
