//! Who is on when a scene begins, and who comes later.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use super::{
    mesh,
    movement::{Mover, Way},
    obstacle, pins, place, settings,
    stage::Stage,
};

/// Particles of a cloth at most, about.
const MOST_PARTICLES: u32 = 250;

/// Fills a stage.
pub fn enter(stage: &mut Stage) {
    let dice = &mut stage.dice;
    let (cloths, obstacles, winds) =
        (dice.one_of([1, 1, 1, 2, 3]), dice.one_of([0, 0, 1, 1, 2, 3]), dice.one_of([0, 0, 1, 2]));
    if dice.chance(0.3) {
        let gravity = settings::gravity(dice);
        stage.diary.note(format_args!("{gravity:?}"));
        stage.app.insert_resource(gravity);
    }
    (0..obstacles).for_each(|_| spawn_obstacle(stage));
    (0..winds).for_each(|_| spawn_wind(stage));
    (0..cloths).for_each(|_| spawn_cloth(stage, MOST_PARTICLES / cloths));
}

pub fn spawn_cloth(stage: &mut Stage, most: u32) {
    let dice = &mut stage.dice;
    let most = dice.count(4..=most);
    let (told, mesh) = mesh::roll(dice, most);
    let cloth = if dice.chance(0.2) { Cloth::default() } else { settings::cloth(dice) };
    let fabric = settings::fabric(dice);
    let springs = dice.chance(0.25).then(|| settings::springs(dice));
    let targets: Vec<Entity> = stage.movers.iter().map(|mover| mover.entity).collect();
    let pins = pins::roll(dice, mesh.count_vertices(), &targets);
    let place = place::beginning(dice, 0.5);
    let way = if dice.chance(0.3) { Way::roll(dice) } else { Way::Still };
    let parent = dice.chance(0.1).then(|| dice.any(&targets)).flatten();

    let mesh = Mesh3d(stage.app.world_mut().resource_mut::<Assets<Mesh>>().add(mesh));
    let entity = stage.app.world_mut().spawn((mesh, cloth.clone(), fabric.clone(), pins.clone(), place)).id();
    stage.diary.note(format_args!("cloth {entity} is {told}, {place:?}, {way:?}, {pins:?}, {cloth:?}, {fabric:?}"));
    if let Some(springs) = springs {
        stage.diary.note(format_args!("cloth {entity} has {springs:?}"));
        stage.with(entity, |cloth| {
            cloth.insert(springs);
        });
    }
    if let Some(parent) = parent {
        stage.diary.note(format_args!("cloth {entity} is a child of {parent}"));
        stage.with(entity, |cloth| {
            cloth.insert(ChildOf(parent));
        });
    }
    stage.cloths.push(entity);
    stage.movers.push(Mover::new(entity, way, place));
}

pub fn spawn_obstacle(stage: &mut Stage) {
    let dice = &mut stage.dice;
    let world = stage.app.world_mut();
    let (collider, own) = obstacle::collider(dice, &mut world.resource_mut::<Assets<Mesh>>());
    let place = place::beginning(dice, 0.8);
    let way = Way::roll(dice);
    let entity = world.spawn((collider.clone(), place)).id();
    if let Some(own) = own {
        stage.with(entity, |obstacle| {
            obstacle.insert(Mesh3d(own));
        });
    }
    stage.diary.note(format_args!("obstacle {entity} is {collider:?}, {place:?}, {way:?}"));
    stage.obstacles.push(entity);
    stage.movers.push(Mover::new(entity, way, place));
}

pub fn spawn_wind(stage: &mut Stage) {
    let wind = settings::wind(&mut stage.dice);
    let place = place::beginning(&mut stage.dice, 1.0);
    let way = Way::roll(&mut stage.dice);
    let entity = stage.app.world_mut().spawn((wind.clone(), place)).id();
    stage.diary.note(format_args!("wind {entity} is {wind:?}, {place:?}, {way:?}"));
    stage.winds.push(entity);
    stage.movers.push(Mover::new(entity, way, place));
}
