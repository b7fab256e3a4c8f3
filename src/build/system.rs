//! Waits for meshes, makes cloth of them, and says how it went.

use bevy::{
    asset::LoadState,
    mesh::skinning::SkinnedMesh,
    platform::collections::{HashMap, HashSet},
    prelude::*,
};

use super::{candidate::Candidate, plan::PlanCache};
use crate::{
    cloth::{Cloth, InForce},
    draw::{self, ClothMesh},
    error::ClothError,
    frame::Skeletons,
    garment::{ClothPartOf, ClothParts, Garment},
    state::{
        ClothAttachments, ClothGrabs, ClothReport, ClothState, ClothStatus, PendingBuild, Requests, Skinning, Sleep,
        StepInput, Warned,
    },
};

/// Builds what waits, rebuilds what has changed, tries again what failed.
pub(crate) fn build_cloths(
    mut commands: Commands,
    mut candidates: Query<Candidate>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut mesh_events: MessageReader<AssetEvent<Mesh>>,
    assets: Option<Res<AssetServer>>,
    mut cache: ResMut<PlanCache>,
    skeletons: Skeletons,
) {
    let news = MeshNews::read(&mut mesh_events);
    cache.update(|mesh| news.changed.contains(&mesh));
    let sources = sources(&candidates);
    for mut candidate in &mut candidates {
        let Some(source) = candidate.source(&sources) else {
            candidate.wait_for_mesh();
            continue;
        };
        let source = match source {
            Ok(source) => source,
            Err(error) => {
                candidate.reject(error, &mut commands);
                continue;
            }
        };
        let Some(cause) = candidate.cause(source.id(), &news) else { continue };
        let built = match meshes.get(&source) {
            Some(mesh) => candidate.build(source.id(), mesh, &mut cache, &skeletons),
            None => match assets.as_ref().map(|assets| assets.load_state(&source)) {
                Some(LoadState::Failed(error)) => Err(ClothError::NotLoaded { reason: error.to_string() }),
                _ => {
                    candidate.wait_for_mesh();
                    continue;
                }
            },
        };
        match built {
            Ok(Some(built)) => candidate.accept(built, cause, source, &mut meshes, &mut commands),
            Ok(None) => candidate.wait_for_plan(cause),
            Err(error) => candidate.reject(error, &mut commands),
        }
    }
}

/// The user's mesh of each copy that is drawn, where a cloth could have been given the copy of another.
fn sources(candidates: &Query<Candidate>) -> HashMap<AssetId<Mesh>, Handle<Mesh>> {
    if !candidates.iter().any(|candidate| candidate.has_foreign_mesh()) {
        return HashMap::default();
    }
    let own_meshes = candidates.iter().filter_map(|candidate| candidate.own_mesh);
    own_meshes.flat_map(|own| &own.drawn).map(|drawn| (drawn.mesh.id(), drawn.source.clone())).collect()
}

/// What has become of mesh assets since the last frame.
#[derive(Debug, Default)]
pub(super) struct MeshNews {
    pub added: HashSet<AssetId<Mesh>>,
    pub changed: HashSet<AssetId<Mesh>>,
}

impl MeshNews {
    fn read(events: &mut MessageReader<AssetEvent<Mesh>>) -> Self {
        let mut news = Self::default();
        for event in events.read() {
            match event {
                AssetEvent::Added { id } => drop(news.added.insert(*id)),
                AssetEvent::Modified { id } => drop(news.changed.insert(*id)),
                _ => {}
            }
        }
        news
    }
}

/// Leaves a plain mesh behind where [`Cloth`] is removed: as it was drawn last, with bounds that are its own again.
pub(crate) fn on_cloth_removed(
    removed: On<Remove, Cloth>,
    mut commands: Commands,
    cloths: Query<&ClothMesh>,
    meshes: Option<ResMut<Assets<Mesh>>>,
) {
    if let (Ok(cloth), Some(mut meshes)) = (cloths.get(removed.entity), meshes) {
        cloth.drawn.iter().for_each(|drawn| draw::release(&drawn.mesh, &mut meshes));
    }
    commands
        .entity(removed.entity)
        .try_remove::<(ClothMesh, ClothState, ClothAttachments, ClothGrabs, ClothReport, ClothStatus)>()
        .try_remove::<(Garment, ClothParts)>()
        .try_remove::<(InForce, PendingBuild, Requests, Skinning, Sleep, StepInput, Warned)>();
}

/// Has a cloth be built without its skeleton where that is removed. Till then its mesh has no joints: with them and without a skeleton
/// beside, it would be an error of the renderer that ends the app.
pub(crate) fn on_skeleton_removed(
    removed: On<Remove, SkinnedMesh>,
    mut cloths: Query<(&ClothMesh, &mut Skinning, Option<&mut Requests>)>,
    parts: Query<&ClothPartOf>,
    meshes: Option<ResMut<Assets<Mesh>>>,
) {
    let entity = removed.entity;
    let cloth = parts.get(entity).map_or(entity, |part| part.0);
    let (Ok((cloth, mut skinning, requests)), Some(mut meshes)) = (cloths.get_mut(cloth), meshes) else {
        return;
    };
    if skinning.0.take().is_some()
        && let Some(mut requests) = requests
    {
        requests.reset = true;
    }
    if let Some(mesh) = cloth.drawn_by(entity).and_then(|drawn| meshes.get_mut(&drawn.mesh)) {
        draw::take_skin_off(mesh.into_inner());
    }
}

/// Leaves a plain mesh behind where it is no longer part of a garment.
pub(crate) fn on_part_removed(
    removed: On<Remove, ClothPartOf>,
    parts: Query<&ClothPartOf>,
    cloths: Query<&ClothMesh>,
    meshes: Option<ResMut<Assets<Mesh>>>,
) {
    let cloth = parts.get(removed.entity).and_then(|part| cloths.get(part.0));
    if let (Ok(cloth), Some(mut meshes)) = (cloth, meshes)
        && let Some(drawn) = cloth.drawn_by(removed.entity)
    {
        draw::release(&drawn.mesh, &mut meshes);
    }
}
