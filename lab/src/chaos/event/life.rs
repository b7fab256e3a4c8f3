//! What becomes of a cloth as a whole: its place, its mesh, its being there.

use bevy::{ecs::entity_disabling::Disabled, prelude::*};
use bevy_drape::prelude::*;

use super::super::{cast, mesh, place, stage::Stage};

/// Particles of a cloth that comes later, at most.
const MOST_PARTICLES: u32 = 60;

pub fn reset(stage: &mut Stage) {
    let Some(cloth) = stage.some_cloth() else { return };
    stage.diary.note(format_args!("cloth {cloth} is reset"));
    stage.command(cloth, |cloth| {
        cloth.reset_cloth();
    });
}

pub fn teleport(stage: &mut Stage) {
    let Some(cloth) = stage.some_cloth() else { return };
    let to = place::elsewhere(&mut stage.dice);
    stage.diary.note(format_args!("cloth {cloth} is teleported, {to:?}"));
    stage.command(cloth, |cloth| {
        cloth.teleport_cloth(to);
    });
}

/// Moves it as if it were no cloth.
pub fn displace(stage: &mut Stage) {
    let Some(cloth) = stage.some_cloth() else { return };
    let to = place::elsewhere(&mut stage.dice);
    stage.diary.note(format_args!("cloth {cloth} is put elsewhere, {to:?}"));
    stage.change(cloth, |place: &mut Transform| *place = to);
}

pub fn scale(stage: &mut Stage) {
    let Some(cloth) = stage.some_cloth() else { return };
    let scale = place::scale(&mut stage.dice);
    stage.diary.note(format_args!("cloth {cloth} is scaled by {scale}"));
    stage.change(cloth, |place: &mut Transform| place.scale = scale);
}

/// In and out, by chance.
pub fn disable(stage: &mut Stage) {
    let Some(cloth) = stage.some_cloth() else { return };
    toggle(stage, cloth);
}

/// Disables what is enabled, and the other way around.
pub fn toggle(stage: &mut Stage, entity: Entity) {
    let is_disabled = stage.app.world().get::<Disabled>(entity).is_some();
    stage.diary.note(format_args!("{entity} is {}", if is_disabled { "enabled" } else { "disabled" }));
    stage.with(entity, |entity| {
        if is_disabled {
            entity.remove::<Disabled>();
        } else {
            entity.insert(Disabled);
        }
    });
}

/// Gives it another mesh.
pub fn remesh(stage: &mut Stage) {
    let Some(cloth) = stage.some_cloth() else { return };
    let (told, mesh) = mesh::roll(&mut stage.dice, MOST_PARTICLES);
    stage.diary.note(format_args!("cloth {cloth} gets another mesh, {told}"));
    let mesh = stage.app.world_mut().resource_mut::<Assets<Mesh>>().add(mesh);
    stage.with(cloth, |cloth| {
        cloth.insert(Mesh3d(mesh));
    });
}

/// Changes meshes, be they those that cloths were made from or those of obstacles. What cloths draw is theirs.
pub fn reshape(stage: &mut Stage) {
    let (told, mesh) = mesh::roll(&mut stage.dice, MOST_PARTICLES);
    let drawn = stage.cloths.iter().filter_map(|&cloth| stage.app.world().get::<Mesh3d>(cloth));
    let drawn: Vec<AssetId<Mesh>> = drawn.map(|mesh| mesh.id()).collect();
    let mut meshes = stage.app.world_mut().resource_mut::<Assets<Mesh>>();
    let mut ids: Vec<AssetId<Mesh>> = meshes.ids().filter(|id| !drawn.contains(id)).collect();
    ids.sort_unstable();
    let Some(id) = stage.dice.any(&ids) else { return };
    if let Some(mut asset) = meshes.get_mut(id) {
        *asset = mesh;
    }
    stage.diary.note(format_args!("a mesh becomes {told}"));
}

/// Gives it another parent, or none.
pub fn adopt(stage: &mut Stage) {
    let Some(cloth) = stage.some_cloth() else { return };
    let obstacles = stage.obstacles.iter().copied();
    let there: Vec<Entity> = obstacles.filter(|&obstacle| stage.is_there(obstacle)).collect();
    let parent = stage.dice.any(&there);
    stage.diary.note(format_args!("cloth {cloth} is a child of {parent:?}"));
    stage.with(cloth, |cloth| match parent {
        Some(parent) => {
            cloth.insert(ChildOf(parent));
        }
        None => {
            cloth.remove::<ChildOf>();
        }
    });
}

/// Cloth comes and goes: as an entity, as a copy, or as a component.
pub fn end_or_begin(stage: &mut Stage) {
    let Some(cloth) = stage.some_cloth() else { return cast::spawn_cloth(stage, MOST_PARTICLES) };
    match stage.dice.count(0..=4) {
        0 => {
            stage.diary.note(format_args!("cloth {cloth} is despawned"));
            stage.app.world_mut().despawn(cloth);
        }
        1 => cast::spawn_cloth(stage, MOST_PARTICLES),
        2 => {
            let mut copy = None;
            stage.with(cloth, |cloth| copy = Some(cloth.clone_and_spawn()));
            stage.diary.note(format_args!("cloth {cloth} has a copy {copy:?}"));
            stage.cloths.extend(copy);
        }
        3 => {
            stage.diary.note(format_args!("cloth {cloth} is no cloth any more"));
            stage.with(cloth, |cloth| {
                cloth.remove::<Cloth>();
            });
        }
        _ => {
            let all = stage.cloths.clone();
            stage.diary.note("what was a cloth is one again");
            for cloth in all {
                stage.with(cloth, |cloth| {
                    cloth.insert_if_new(Cloth::default());
                });
            }
        }
    }
}
