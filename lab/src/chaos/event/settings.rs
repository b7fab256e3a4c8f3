//! Settings and pins that change while a cloth runs.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use super::super::{pins as pinning, settings, stage::Stage};

pub fn cloth(stage: &mut Stage) {
    let Some(cloth) = stage.some_cloth() else { return };
    let new = settings::cloth(&mut stage.dice);
    stage.diary.note(format_args!("cloth {cloth} gets {new:?}"));
    stage.change(cloth, |own: &mut Cloth| *own = new);
}

pub fn fabric(stage: &mut Stage) {
    let Some(cloth) = stage.some_cloth() else { return };
    let new = settings::fabric(&mut stage.dice);
    stage.diary.note(format_args!("cloth {cloth} gets {new:?}"));
    stage.change(cloth, |own: &mut Fabric| *own = new);
}

pub fn springs(stage: &mut Stage) {
    let Some(cloth) = stage.some_cloth() else { return };
    if stage.dice.chance(0.4) {
        stage.diary.note(format_args!("cloth {cloth} has no plain springs"));
        stage.with(cloth, |cloth| {
            cloth.remove::<ClothSprings>();
        });
        return;
    }
    let new = settings::springs(&mut stage.dice);
    stage.diary.note(format_args!("cloth {cloth} gets {new:?}"));
    stage.with(cloth, |cloth| {
        cloth.insert(new);
    });
}

pub fn pins(stage: &mut Stage) {
    let Some((cloth, new)) = pins_for_some(stage) else { return };
    stage.diary.note(format_args!("cloth {cloth} gets {new:?}"));
    stage.change(cloth, |own: &mut Pins| *own = new);
}

pub fn more_pins(stage: &mut Stage) {
    let Some((cloth, new)) = pins_for_some(stage) else { return };
    stage.diary.note(format_args!("cloth {cloth} is pinned by {new:?}"));
    stage.command(cloth, |cloth| {
        cloth.pin_cloth(new);
    });
}

pub fn fewer_pins(stage: &mut Stage) {
    let Some((cloth, new)) = pins_for_some(stage) else { return };
    stage.diary.note(format_args!("cloth {cloth} is unpinned by {new:?}"));
    stage.command(cloth, |cloth| {
        cloth.unpin_cloth(new);
    });
}

/// Some cloth, and pins for its mesh.
fn pins_for_some(stage: &mut Stage) -> Option<(Entity, Pins)> {
    let cloth = stage.some_cloth()?;
    let world = stage.app.world();
    let mesh = world.get::<Mesh3d>(cloth).and_then(|mesh| world.resource::<Assets<Mesh>>().get(&mesh.0))?;
    let vertices = mesh.count_vertices();
    let targets: Vec<Entity> = stage.movers.iter().map(|mover| mover.entity).collect();
    Some((cloth, pinning::roll(&mut stage.dice, vertices, &targets)))
}
