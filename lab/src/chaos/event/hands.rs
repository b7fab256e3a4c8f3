//! Hands, forces and blows.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use super::super::{settings, stage::Stage};

pub fn grab(stage: &mut Stage) {
    let Some(cloth) = stage.some_cloth() else { return };
    let grip = settings::grip(&mut stage.dice);
    let near = stage.dice.vector(1.0);
    let world = stage.app.world_mut();
    let mut cloths = world.query::<(&ClothState, &mut ClothGrabs)>();
    let Ok((state, mut grabs)) = cloths.get_mut(world, cloth) else { return };
    let Some(point) = state.nearest_point(near) else { return };
    if let Some(grab) = grabs.grab(state, point, grip) {
        stage.diary.note(format_args!("cloth {cloth} is grabbed at {point:?} with {grip:?}"));
        stage.grabs.push((cloth, grab));
    }
}

pub fn lead(stage: &mut Stage) {
    let Some((cloth, grab)) = stage.dice.any(&stage.grabs) else { return };
    let farthest = stage.dice.spread(0.05, 100.0);
    let target = if stage.dice.wild(0.1) { Vec3::splat(stage.dice.anything()) } else { stage.dice.vector(farthest) };
    stage.diary.note(format_args!("cloth {cloth} is led to {target} by {grab:?}"));
    stage.change(cloth, |grabs: &mut ClothGrabs| {
        grabs.move_grab(grab, target);
    });
}

pub fn release(stage: &mut Stage) {
    let Some((cloth, grab)) = stage.grabs.pop() else { return };
    stage.diary.note(format_args!("cloth {cloth} is let go by {grab:?}"));
    stage.change(cloth, |grabs: &mut ClothGrabs| {
        grabs.release(grab);
    });
}

/// A force on a particle, or around it.
pub fn push(stage: &mut Stage) {
    let Some((cloth, particle, place)) = some_particle(stage) else { return };
    let strength = stage.dice.setting(0.01, 100.0);
    let force = stage.dice.direction() * strength;
    let radius = stage.dice.chance(0.5).then(|| stage.dice.setting(0.01, 2.0));
    stage.diary.note(format_args!("cloth {cloth} is pushed at {particle} by {force} within {radius:?}"));
    stage.change(cloth, |state: &mut ClothState| match radius {
        Some(radius) => state.add_force_in_radius(place, radius, force),
        None => state.add_force(particle, force),
    });
}

/// The same with an impulse.
pub fn strike(stage: &mut Stage) {
    let Some((cloth, particle, place)) = some_particle(stage) else { return };
    let strength = stage.dice.setting(1e-4, 1.0);
    let impulse = stage.dice.direction() * strength;
    let radius = stage.dice.chance(0.5).then(|| stage.dice.setting(0.01, 2.0));
    stage.diary.note(format_args!("cloth {cloth} is struck at {particle} by {impulse} within {radius:?}"));
    stage.change(cloth, |state: &mut ClothState| match radius {
        Some(radius) => state.add_impulse_in_radius(place, radius, impulse),
        None => state.add_impulse(particle, impulse),
    });
}

/// A particle of some cloth, and where it is.
fn some_particle(stage: &mut Stage) -> Option<(Entity, usize, Vec3)> {
    let cloth = stage.some_cloth()?;
    let state = stage.app.world().get::<ClothState>(cloth)?;
    let last = state.particle_count().checked_sub(1)?;
    let particle = stage.dice.count(0..=last as u32) as usize;
    Some((cloth, particle, state.position(particle)?))
}
