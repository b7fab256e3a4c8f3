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
    state::{
        ClothAttachments, ClothGrabs, ClothReport, ClothState, ClothStatus, PendingBuild, Requests, Skinning, Sleep,
        StepInput, Warned,
    },
};

/// Says so where `Cloth` is on an entity that has no mesh, as the root of a loaded scene has none.
pub(crate) fn warn_without_mesh(cloths: Query<Entity, (Added<Cloth>, Without<Mesh3d>)>) {
    for entity in &cloths {
        warn!(
            "cloth {entity} has no Mesh3d and waits for one; insert Cloth next to the Mesh3d, in a loaded scene on the \
             entity that carries it"
        );
    }
}

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
        let source = match candidate.own_mesh {
            Some(own) if own.drawn == candidate.mesh.0 => &own.source,
            _ => sources.get(&candidate.mesh.id()).unwrap_or(&candidate.mesh.0),
        };
        let Some(cause) = candidate.cause(source.id(), &news) else { continue };
        let source = source.clone();
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
    own_meshes.map(|own| (own.drawn.id(), own.source.clone())).collect()
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
        draw::release(&cloth.drawn, &mut meshes);
    }
    commands
        .entity(removed.entity)
        .try_remove::<(ClothMesh, ClothState, ClothAttachments, ClothGrabs, ClothReport, ClothStatus)>()
        .try_remove::<(InForce, PendingBuild, Requests, Skinning, Sleep, StepInput, Warned)>();
}

/// Has a cloth be built without its skeleton where that is removed. Till then its mesh has no joints: with them and without a skeleton
/// beside, it would be an error of the renderer that ends the app.
pub(crate) fn on_skeleton_removed(
    removed: On<Remove, SkinnedMesh>,
    mut cloths: Query<(&ClothMesh, &mut Skinning, &mut Requests)>,
    meshes: Option<ResMut<Assets<Mesh>>>,
) {
    let (Ok((cloth, mut skinning, mut requests)), Some(mut meshes)) = (cloths.get_mut(removed.entity), meshes) else {
        return;
    };
    if skinning.0.take().is_some() {
        requests.reset = true;
        if let Some(mesh) = meshes.get_mut(&cloth.drawn) {
            draw::take_skin_off(mesh.into_inner());
        }
    }
}
