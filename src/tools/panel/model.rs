//! What the panel shows: read from the world, edited by the controls, and written back where it differs.

use bevy::prelude::*;

use super::{
    ClothChoice,
    advice::Advice,
    list::{self, Differing},
    loaded,
    memory::{Memory, Readings},
    settings::{self, Settings},
};
use crate::{
    cloth::Cloth,
    commands::ClothCommands,
    fabric::{Fabric, handle::FabricHandle},
    pins::Pins,
    surroundings::wind::Wind,
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
    pub differing: Differing,
    /// Some of the chosen cloths follow a fabric's asset.
    pub follows_asset: bool,
    pub readings: Readings,
    /// What to change, and for which cloth.
    pub advice: Vec<(Entity, Advice)>,
    /// What buttons have asked for.
    pub asks: Vec<Ask>,
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
        let cloths = list::named::<With<Cloth>>(world, "Cloth");
        let winds = list::named::<With<Wind>>(world, "Wind");
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
            trouble: list::trouble(world, &chosen),
            differing: Differing::find(world, &chosen),
            follows_asset: chosen.iter().any(follows),
            settings: Settings::read(world, &chosen, memory),
            readings: memory.readings.clone(),
            advice: memory.advice.clone(),
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
                settings::detach(world, cloth);
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
