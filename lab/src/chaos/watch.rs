//! Looks for what isn't finite, for cloths that were put back, and for long steps.

use core::hash::BuildHasher;

use bevy::{
    ecs::entity_disabling::Disabled,
    mesh::{MeshVertexAttribute, VertexAttributeValues},
    platform::hash::FixedHasher,
    prelude::*,
};
use bevy_drape::prelude::*;

use super::{
    outcome::Outcome,
    stage::{Heard, Stage},
};

/// Looks at a scene after a frame.
pub fn look(stage: &mut Stage, outcome: &mut Outcome) {
    let frame = stage.diary.frame();
    let heard = core::mem::take(stage.app.world_mut().resource_mut::<Heard>().into_inner());
    for (cloth, error) in heard.failed {
        stage.diary.note(format_args!("cloth {cloth} has failed: {error}"));
    }
    for (cloth, cause) in heard.reset {
        if cause == ResetCause::NotFinite {
            stage.diary.note(format_args!("cloth {cloth} was put back to its last finite pose"));
            outcome.put_back += 1;
            outcome.first_put_back.get_or_insert_with(|| {
                let solver = stage.app.world().get::<Cloth>(cloth).map(|cloth| cloth.solver);
                format!("cloth {cloth} in frame {frame}, {solver:?}")
            });
        }
    }
    let mut found: Option<String> = None;
    let (mut step, mut particles) = (0.0, 0);
    for &cloth in &stage.cloths {
        let world = stage.app.world();
        let (Some(state), Some(status)) = (world.get::<ClothState>(cloth), world.get::<ClothStatus>(cloth)) else {
            continue;
        };
        if !status.is_running() {
            continue;
        }
        outcome.has_run = true;
        step += world.get::<ClothReport>(cloth).map_or(0.0, |report| report.step_time().as_secs_f64());
        particles += state.particle_count();
        if let Some(what) = what_is_not_finite(world, cloth, state) {
            stage.diary.note(format_args!("cloth {cloth}: {what}"));
            found.get_or_insert_with(|| format!("{what} in frame {frame}"));
        }
    }
    if found.is_some() {
        outcome.not_finite += 1;
        outcome.first_not_finite = outcome.first_not_finite.take().or(found);
    }
    outcome.longest_step = outcome.longest_step.max(step);
    outcome.longest_per_particle = outcome.longest_per_particle.max(step * 1e6 / particles.max(1) as f64);
}

/// Of the positions of all cloths: the same for the same scene.
pub fn fingerprint(stage: &Stage) -> u64 {
    let states = stage.cloths.iter().filter_map(|&cloth| stage.app.world().get::<ClothState>(cloth));
    let numbers = states.flat_map(ClothState::positions).flat_map(|place| place.to_array());
    FixedHasher.hash_one(numbers.map(f32::to_bits).collect::<Vec<_>>())
}

/// What of a running cloth isn't finite, in words.
fn what_is_not_finite(world: &World, cloth: Entity, state: &ClothState) -> Option<String> {
    if let Some(particle) = state.positions().position(|place| !place.is_finite()) {
        return Some(format!("the position of particle {particle} isn't finite"));
    }
    if let Some(particle) = state.velocities().position(|velocity| !velocity.is_finite()) {
        return Some(format!("the velocity of particle {particle} isn't finite"));
    }
    if world.get::<Disabled>(cloth).is_some() {
        // A mesh that it was given meanwhile is drawn as it is.
        return None;
    }
    let drawn = world.get::<Mesh3d>(cloth).and_then(|mesh| world.resource::<Assets<Mesh>>().get(&mesh.0))?;
    let attributes = [Mesh::ATTRIBUTE_POSITION, Mesh::ATTRIBUTE_NORMAL, Mesh::ATTRIBUTE_TANGENT];
    let attribute = attributes.into_iter().find(|attribute| !is_finite(drawn, *attribute));
    if let Some(attribute) = attribute {
        return Some(format!("{} of the drawn mesh isn't finite", attribute.name));
    }
    let bounds = drawn.final_aabb.filter(|bounds| !(bounds.min.is_finite() && bounds.max.is_finite()));
    bounds.map(|_| "the bounds of the drawn mesh aren't finite".into())
}

fn is_finite(mesh: &Mesh, attribute: MeshVertexAttribute) -> bool {
    match mesh.attribute(attribute) {
        Some(VertexAttributeValues::Float32x3(values)) => values.as_flattened().iter().all(|value| value.is_finite()),
        Some(VertexAttributeValues::Float32x4(values)) => values.as_flattened().iter().all(|value| value.is_finite()),
        _ => true,
    }
}
