//! Gives bodies their capsules, once their meshes are there and whenever these change.

use bevy::{
    ecs::{entity_disabling::Disabled, system::SystemParam},
    mesh::skinning::SkinnedMesh,
    platform::collections::HashSet,
    prelude::*,
};

use super::{
    ClothBody, ClothBodyPart, despawn_parts,
    error::BodyError,
    fit::Fit,
    memory::BodyMemory,
    shares::{Joint, capsules},
    sources::{Anatomy, Found},
};
use crate::{cloth::Cloth, frame::PATIENCE, garment::ClothPartOf, surroundings::collider::ClothCollider};

/// What has happened since the last frame that may give bodies other meshes.
#[derive(SystemParam)]
pub(crate) struct News<'w, 's> {
    changed: Query<
        'w,
        's,
        (),
        (With<SkinnedMesh>, Or<(Changed<Mesh3d>, Changed<SkinnedMesh>, Added<Cloth>, Changed<ClothPartOf>)>),
    >,
    moved: Query<'w, 's, (), Changed<ChildOf>>,
    gone: (
        RemovedComponents<'w, 's, Mesh3d>,
        RemovedComponents<'w, 's, SkinnedMesh>,
        RemovedComponents<'w, 's, Cloth>,
        RemovedComponents<'w, 's, ClothPartOf>,
        RemovedComponents<'w, 's, ChildOf>,
    ),
    meshes: MessageReader<'w, 's, AssetEvent<Mesh>>,
}

impl News<'_, '_> {
    /// Whether bodies may have other meshes.
    fn are_any(&mut self) -> bool {
        let (meshes, skeletons, cloths, parts, places) = &mut self.gone;
        let (meshes, skeletons) = (meshes.read().count(), skeletons.read().count());
        let gone = [meshes, skeletons, cloths.read().count(), parts.read().count(), places.read().count()];
        gone.iter().any(|&count| count > 0) || !self.changed.is_empty() || !self.moved.is_empty()
    }

    /// Meshes that aren't what they were.
    fn modified(&mut self) -> HashSet<AssetId<Mesh>> {
        let modified = self.meshes.read().filter_map(|event| match event {
            AssetEvent::Modified { id } => Some(*id),
            _ => None,
        });
        modified.collect()
    }
}

/// Makes the capsules of bodies that are new or have changed.
pub(crate) fn make_bodies(
    mut commands: Commands,
    mut bodies: Query<(Entity, Ref<ClothBody>, &mut BodyMemory)>,
    parts: Query<(Entity, &ClothBodyPart), Allow<Disabled>>,
    mut news: News,
    anatomy: Anatomy,
    time: Res<Time>,
) {
    let (are_any, modified) = (news.are_any(), news.modified());
    for (entity, body, mut memory) in &mut bodies {
        let is_modified = memory.made_of.iter().flatten().any(|source| modified.contains(&source.mesh));
        let is_new = body.is_changed() || is_modified;
        if !(is_new || are_any || memory.made_of.is_none()) {
            continue;
        }
        if let Err(error) = body.validate() {
            memory.tell(entity, &BodyError::Settings(error));
            continue;
        }
        let sources = anatomy.sources(entity, &body);
        if !is_new && memory.made_of.as_ref() == Some(&sources) {
            continue;
        }
        memory.made_of = None;
        if sources.is_empty() {
            despawn_parts(entity, parts.iter(), &mut commands);
            memory.waited += time.delta_secs();
            if memory.waited > PATIENCE {
                memory.tell(entity, &BodyError::NoSkin);
            }
            continue;
        }
        memory.waited = 0.0;
        let Found { joints, error } = match anatomy.joints(&sources, &body) {
            Ok(Some(found)) => found,
            // Meanwhile there is what there was.
            Ok(None) => continue,
            Err(error) => Found { joints: Vec::new(), error: Some(error) },
        };
        memory.made_of = Some(sources);
        despawn_parts(entity, parts.iter(), &mut commands);
        let made = spawn_parts(entity, joints, &body, &anatomy, &mut commands);
        match error.or((made == 0).then_some(BodyError::NoCapsules)) {
            Some(error) => memory.tell(entity, &error),
            None => memory.forget_warning(),
        }
    }
}

/// Spawns the capsules of joints, and returns how many there are.
fn spawn_parts(
    body: Entity,
    joints: Vec<(Entity, Joint)>,
    settings: &ClothBody,
    anatomy: &Anatomy,
    commands: &mut Commands,
) -> usize {
    let (entities, joints): (Vec<Entity>, Vec<Joint>) = joints.into_iter().unzip();
    let capsules = capsules(joints, settings);
    for &(number, Fit { capsule, centre, axis }) in &capsules {
        let joint = entities[number];
        let name = anatomy.name(joint).map_or_else(|| joint.to_string(), ToString::to_string);
        let part = (
            Name::new(format!("cloth body {name}")),
            ClothBodyPart { body },
            ClothCollider::from(capsule),
            Transform::from_translation(centre.into()).with_rotation(Quat::from_rotation_arc(Vec3::Y, axis.into())),
            ChildOf(joint),
        );
        // Either may be gone by then, and nothing would take the part with it.
        commands.queue(move |world: &mut World| {
            if world.get_entity(joint).is_ok() && world.get::<ClothBody>(body).is_some() {
                world.spawn(part);
            }
        });
    }
    capsules.len()
}
