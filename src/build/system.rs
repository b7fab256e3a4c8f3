//! Waits for meshes, makes cloth of them, and says how it went.

use std::sync::Arc;

use bevy::{
    asset::{LoadState, RenderAssetUsages},
    ecs::query::QueryData,
    math::Vec3A,
    platform::collections::{HashMap, HashSet},
    prelude::*,
};

use super::plan::PlanCache;
use crate::{
    anchor::{self, Poses},
    cloth::{Cloth, ClothFailed, ClothReady, ClothReset, ClothStatus, ResetCause},
    draw::{
        binding::Binding,
        mesh::{self, ClothMesh, Drawn},
    },
    error::ClothError,
    fabric::Fabric,
    pins::{Pins, targets_by_particle},
    solver::Particles,
    state::ClothState,
};

/// All that building a cloth looks at.
#[derive(QueryData)]
#[query_data(mutable)]
pub(crate) struct Candidate {
    entity: Entity,
    mesh: &'static mut Mesh3d,
    cloth: Ref<'static, Cloth>,
    fabric: Ref<'static, Fabric>,
    pins: Ref<'static, Pins>,
    transform: Ref<'static, GlobalTransform>,
    status: &'static mut ClothStatus,
    state: &'static mut ClothState,
    own_mesh: Option<&'static ClothMesh>,
}

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
    poses: Poses,
) {
    let news = MeshNews::read(&mut mesh_events);
    cache.forget_unused();
    // The user's mesh of each copy that is drawn, also where another cloth was given that copy.
    let sources: HashMap<_, _> =
        candidates.iter().filter_map(|c| c.own_mesh).map(|own| (own.drawn.id(), own.source.clone())).collect();
    for mut candidate in &mut candidates {
        let source = sources.get(&candidate.mesh.id()).unwrap_or(&candidate.mesh.0).clone();
        let Some(cause) = candidate.cause(&source, &news) else { continue };
        let built = match meshes.get(&source) {
            Some(mesh) => candidate.build(mesh, &mut cache, &poses),
            None => match assets.as_ref().map(|assets| assets.load_state(&source)) {
                Some(LoadState::Failed(error)) => Err(ClothError::NotLoaded { reason: error.to_string() }),
                _ => {
                    candidate.wait();
                    continue;
                }
            },
        };
        match built {
            Ok(built) => candidate.accept(built, cause, source, &mut meshes, &mut commands),
            Err(error) => candidate.reject(error, &mut commands),
        }
    }
}

/// What has become of mesh assets since the last frame.
#[derive(Debug, Default)]
struct MeshNews {
    added: HashSet<AssetId<Mesh>>,
    changed: HashSet<AssetId<Mesh>>,
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

/// Why a cloth is built.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Cause {
    First,
    Again(ResetCause),
}

/// A cloth that is ready to take its place.
struct Built {
    state: ClothState,
    binding: Arc<Binding>,
    mesh: Mesh,
    positions: Vec<[f32; 3]>,
}

impl CandidateItem<'_, '_> {
    /// Why the cloth has to be built now, if it has to.
    fn cause(&self, source: &Handle<Mesh>, news: &MeshNews) -> Option<Cause> {
        let changed = news.changed.contains(&source.id());
        let added = news.added.contains(&source.id());
        let touched = self.cloth.is_changed()
            || self.fabric.is_changed()
            || self.pins.is_changed()
            || self.transform.is_changed()
            || self.mesh.is_changed();
        let reset = self.state.requests.reset;
        match &*self.status {
            ClothStatus::Waiting => Some(Cause::First),
            ClothStatus::Failed(_) => (touched || changed || added || reset).then_some(Cause::First),
            ClothStatus::Ready if reset => Some(Cause::Again(ResetCause::Requested)),
            ClothStatus::Ready => match self.own_mesh {
                // Only its status has come from elsewhere, as from a scene.
                None => Some(Cause::First),
                // `Mesh3d` was replaced, be it by the mesh that the cloth was made from.
                Some(own) if own.drawn != self.mesh.0 => Some(Cause::Again(ResetCause::Rebuilt)),
                Some(_) => changed.then_some(Cause::Again(ResetCause::Rebuilt)),
            },
        }
    }

    /// The mesh isn't there yet: it is looked for again in the next frame.
    fn wait(&mut self) {
        if matches!(*self.status, ClothStatus::Failed(_)) {
            *self.status = ClothStatus::Waiting;
        }
    }

    fn build(&self, mesh: &Mesh, cache: &mut PlanCache, poses: &Poses) -> Result<Built, ClothError> {
        self.cloth.validate()?;
        let material = self.fabric.material()?;
        let pose = poses
            .compute_global_transform(self.entity)
            .map(|global| global.affine())
            .ok()
            .filter(anchor::is_invertible)
            .ok_or(ClothError::FlatTransform)?;
        // What is drawn is a copy: it would leave for the render world with the first frame, and couldn't be written.
        if !mesh.asset_usage.contains(RenderAssetUsages::MAIN_WORLD) {
            return Err(ClothError::NotInMainWorld);
        }
        let plan = cache.plan(mesh, pose.matrix3)?;
        let (targets, refused) =
            targets_by_particle(&self.pins, mesh, &plan.binding.particle_of_vertex, &plan.topology);
        if let Some((_, error)) = refused.into_iter().next() {
            return Err(error);
        }
        let rest: Vec<Vec3A> = plan.topology.rest.iter().copied().map(Vec3A::from).collect();
        let mut state = ClothState {
            step_start: rest.clone(),
            particles: Particles::at_rest(rest, &plan.topology, &material),
            origin: pose.translation.into(),
            particle_of_vertex: plan.binding.particle_of_vertex.clone(),
            effort: self.cloth.effort(&plan.topology),
            topology: plan.topology,
            settings: Cloth::clone(&self.cloth),
            material: Some(material),
            pose,
            said: self.state.said,
            // Goes on counting, so that what is drawn of the new cloth isn't taken for the old one's.
            steps: self.state.steps + 1,
            ..default()
        };
        anchor::hold(&mut state, &targets, self.entity, poses);
        Ok(Built { state, binding: plan.binding, mesh: self.copy_of(mesh), positions: plan.positions })
    }

    /// The mesh that is drawn. Its particles are in their place already: no skin may deform it once more.
    fn copy_of(&self, mesh: &Mesh) -> Mesh {
        let mut copy = mesh.clone();
        let skin = [Mesh::ATTRIBUTE_JOINT_INDEX, Mesh::ATTRIBUTE_JOINT_WEIGHT];
        if skin.map(|attribute| copy.try_remove_attribute(attribute).is_ok()).contains(&true) {
            warn!("cloth {} is simulated from its bind pose: its skin isn't followed yet", self.entity);
        }
        copy
    }

    fn accept(
        &mut self,
        built: Built,
        cause: Cause,
        source: Handle<Mesh>,
        meshes: &mut Assets<Mesh>,
        commands: &mut Commands,
    ) {
        let entity = self.entity;
        let drawn = match self.own_mesh {
            // A rebuilt cloth keeps its own mesh, with new contents; that of a copied entity is another's.
            Some(own) if cause != Cause::First && meshes.insert(own.drawn.id(), built.mesh.clone()).is_ok() => {
                own.drawn.clone()
            }
            _ => meshes.add(built.mesh),
        };
        self.state.release_all();
        let grabs = core::mem::take(&mut self.state.grabs);
        *self.state = ClothState { grabs, ..built.state };
        *self.status = ClothStatus::Ready;
        if self.mesh.0 != drawn {
            self.mesh.0 = drawn.clone();
        }
        let shape = Drawn::new(built.positions);
        let own_mesh = ClothMesh { source, drawn, binding: built.binding, shape };
        commands.entity(entity).try_insert(own_mesh);
        match cause {
            Cause::First => commands.trigger(ClothReady { entity }),
            Cause::Again(cause) => commands.trigger(ClothReset { entity, cause }),
        }
    }

    fn reject(&mut self, error: ClothError, commands: &mut Commands) {
        self.state.requests.reset = false;
        // By its words: an error that carries a NaN doesn't equal itself.
        if matches!(&*self.status, ClothStatus::Failed(known) if known.to_string() == error.to_string()) {
            return;
        }
        warn!("cloth {} can't be built: {error}", self.entity);
        *self.status = ClothStatus::Failed(error.clone());
        commands.trigger(ClothFailed { entity: self.entity, error });
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
        mesh::release(&cloth.drawn, &mut meshes);
    }
    commands.entity(removed.entity).try_remove::<(ClothMesh, ClothState, ClothStatus)>();
}
