//! What becomes of obstacles, winds and gravity.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use super::{
    super::{cast, obstacle as shapes, place, settings, stage::Stage},
    life,
};

/// No more than this come.
const MOST_OBSTACLES: usize = 4;

/// An obstacle comes, goes, or becomes another.
pub fn obstacle(stage: &mut Stage) {
    let one = some_obstacle(stage);
    let Some(obstacle) = one.filter(|_| stage.obstacles.len() > MOST_OBSTACLES || stage.dice.chance(0.6)) else {
        return cast::spawn_obstacle(stage);
    };
    match stage.dice.count(0..=2) {
        0 => {
            stage.diary.note(format_args!("obstacle {obstacle} is despawned"));
            stage.app.world_mut().despawn(obstacle);
        }
        1 => {
            stage.diary.note(format_args!("obstacle {obstacle} is none any more"));
            stage.with(obstacle, |obstacle| {
                obstacle.remove::<ClothCollider>();
            });
        }
        _ => {
            let mut meshes = stage.app.world_mut().resource_mut::<Assets<Mesh>>();
            let (collider, own) = shapes::collider(&mut stage.dice, &mut meshes);
            stage.diary.note(format_args!("obstacle {obstacle} becomes {collider:?}"));
            stage.with(obstacle, |obstacle| {
                obstacle.insert(collider);
                if let Some(own) = own {
                    obstacle.insert(Mesh3d(own));
                }
            });
        }
    }
}

/// Puts an obstacle elsewhere.
pub fn displace(stage: &mut Stage) {
    let Some(obstacle) = some_obstacle(stage) else { return };
    let to = place::elsewhere(&mut stage.dice);
    stage.diary.note(format_args!("obstacle {obstacle} is put elsewhere, {to:?}"));
    for mover in stage.movers.iter_mut().filter(|mover| mover.entity == obstacle) {
        mover.home = to;
    }
    stage.change(obstacle, |place: &mut Transform| *place = to);
}

/// An obstacle or a wind is disabled, or enabled again.
pub fn disable(stage: &mut Stage) {
    let all = [stage.obstacles.as_slice(), &stage.winds].concat();
    if let Some(entity) = stage.dice.any(&all) {
        life::toggle(stage, entity);
    }
}

/// A wind comes, goes or changes.
pub fn wind(stage: &mut Stage) {
    let wind = stage.dice.any(&stage.winds).filter(|&wind| stage.is_there(wind));
    let Some(wind) = wind else { return cast::spawn_wind(stage) };
    if stage.dice.chance(0.3) {
        stage.diary.note(format_args!("wind {wind} is despawned"));
        stage.app.world_mut().despawn(wind);
        return;
    }
    let new = settings::wind(&mut stage.dice);
    stage.diary.note(format_args!("wind {wind} becomes {new:?}"));
    stage.change(wind, |own: &mut Wind| *own = new);
}

pub fn gravity(stage: &mut Stage) {
    let gravity = settings::gravity(&mut stage.dice);
    stage.diary.note(format_args!("{gravity:?}"));
    stage.app.insert_resource(gravity);
}

fn some_obstacle(stage: &mut Stage) -> Option<Entity> {
    let there: Vec<Entity> = stage.obstacles.iter().copied().filter(|&entity| stage.is_there(entity)).collect();
    stage.dice.any(&there)
}
