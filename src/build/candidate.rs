//! A cloth that may have to be built: whether it has, and what is said where it can't be.

use bevy::{ecs::query::QueryData, mesh::skinning::SkinnedMesh, platform::collections::HashMap, prelude::*};

use super::system::MeshNews;
use crate::{
    cloth::{Cloth, InForce},
    draw::ClothMesh,
    error::ClothError,
    fabric::{ClothSprings, Fabric},
    garment::Garment,
    pins::Pins,
    skin::ClothSkin,
    state::{
        ClothAttachments, ClothFailed, ClothGrabs, ClothReport, ClothState, ClothStatus, PendingBuild, Requests,
        ResetCause, Skinning, Sleep, StepInput, Warned,
    },
};

/// All that building a cloth looks at.
#[derive(QueryData)]
#[query_data(mutable)]
pub(crate) struct Candidate {
    pub(super) entity: Entity,
    pub mesh: Option<&'static mut Mesh3d>,
    pub(super) garment: Option<Ref<'static, Garment>>,
    pub(super) cloth: Ref<'static, Cloth>,
    pub(super) fabric: Ref<'static, Fabric>,
    pub(super) springs: Option<Ref<'static, ClothSprings>>,
    pub(super) pins: Ref<'static, Pins>,
    pub(super) skin: Option<Ref<'static, ClothSkin>>,
    pub(super) skeleton: Option<Ref<'static, SkinnedMesh>>,
    pub(super) skinning: &'static mut Skinning,
    pub(super) transform: Ref<'static, GlobalTransform>,
    pub(super) status: &'static mut ClothStatus,
    pub(super) state: &'static mut ClothState,
    pub(super) attachments: &'static mut ClothAttachments,
    pub(super) grabs: &'static mut ClothGrabs,
    pub(super) report: &'static mut ClothReport,
    pub(super) in_force: &'static mut InForce,
    pub(super) input: &'static mut StepInput,
    pub(super) sleep: &'static mut Sleep,
    pub(super) pending: &'static mut PendingBuild,
    pub(super) requests: &'static mut Requests,
    pub(super) warned: &'static mut Warned,
    pub own_mesh: Option<&'static ClothMesh>,
}

/// Why a cloth is built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cause {
    First,
    Again(ResetCause),
}

impl CandidateReadOnlyItem<'_, '_> {
    /// Whether its `Mesh3d` isn't its own mesh: the cloth isn't built yet, or was given another.
    pub(super) fn has_foreign_mesh(&self) -> bool {
        self.mesh.is_some_and(|mesh| self.own_mesh.is_none_or(|own| own.drawn_with(mesh.id()).is_none()))
    }
}

impl CandidateItem<'_, '_> {
    /// The mesh that it is to be made of: the user's, or the one of all parts of a garment. None while there is none; of copies that are
    /// drawn, `sources` are what they were made of.
    pub(super) fn source(
        &self,
        sources: &HashMap<AssetId<Mesh>, Handle<Mesh>>,
    ) -> Option<Result<Handle<Mesh>, ClothError>> {
        let Some(mesh) = &self.mesh else { return self.garment.as_ref()?.joined.clone() };
        let own = self.own_mesh.and_then(|own| own.drawn_with(mesh.id()));
        let source = own.map(|drawn| &drawn.source).or_else(|| sources.get(&mesh.id()));
        Some(Ok(source.unwrap_or(&mesh.0).clone()))
    }

    /// Why the cloth has to be built now, if it has to.
    pub(super) fn cause(&self, source: AssetId<Mesh>, news: &MeshNews) -> Option<Cause> {
        let changed = news.changed.contains(&source) || self.pending.0.is_some();
        let added = news.added.contains(&source);
        let touched = self.cloth.is_changed()
            || self.fabric.is_changed()
            || self.springs.as_ref().is_some_and(DetectChanges::is_changed)
            || self.pins.is_changed()
            || self.skin.as_ref().is_some_and(DetectChanges::is_changed)
            || self.skeleton.as_ref().is_some_and(DetectChanges::is_changed)
            || self.transform.is_changed()
            || self.mesh.as_ref().is_some_and(DetectChanges::is_changed)
            || self.garment.as_ref().is_some_and(DetectChanges::is_changed);
        let reset = self.requests.reset;
        match &*self.status {
            ClothStatus::Waiting | ClothStatus::Building => Some(Cause::First),
            ClothStatus::Failed(_) => (touched || changed || added || reset).then_some(Cause::First),
            ClothStatus::Ready | ClothStatus::Asleep if reset => Some(Cause::Again(ResetCause::Requested)),
            ClothStatus::Ready | ClothStatus::Asleep => match self.own_mesh {
                // Only its status has come from elsewhere, as from a scene.
                None => Some(Cause::First),
                // `Mesh3d` was replaced, be it by the mesh that the cloth was made from, or the parts of a garment were.
                Some(own) if !self.is_drawn_by(own, source) => Some(Cause::Again(ResetCause::Rebuilt)),
                // Another skeleton, or one for the first time.
                Some(_) => (changed || self.has_new_skeleton()).then_some(Cause::Again(ResetCause::Rebuilt)),
            },
        }
    }

    /// Whether what is drawn of it is what was made of its mesh, which is `source`.
    fn is_drawn_by(&self, own: &ClothMesh, source: AssetId<Mesh>) -> bool {
        match &self.mesh {
            Some(mesh) => own.drawn_with(mesh.id()).is_some(),
            None => own.source.id() == source,
        }
    }

    /// The skeleton of its mesh, or of all its parts.
    pub(super) fn skeleton(&self) -> Option<&SkinnedMesh> {
        let of_parts = || self.garment.as_ref()?.parts.first()?.skeleton.as_ref();
        match &self.mesh {
            Some(_) => self.skeleton.as_deref(),
            None => of_parts(),
        }
    }

    /// Whether its skeleton isn't the one that it was bound to.
    fn has_new_skeleton(&self) -> bool {
        let bound = self.skinning.0.as_ref();
        let is_other = |skeleton: &Ref<SkinnedMesh>| bound.is_none_or(|bound| bound.joints != skeleton.joints);
        self.skeleton.as_ref().is_some_and(|skeleton| skeleton.is_changed() && is_other(skeleton))
    }

    /// The mesh isn't there yet: it is looked for again in the next frame.
    pub(super) fn wait_for_mesh(&mut self) {
        if matches!(*self.status, ClothStatus::Failed(_) | ClothStatus::Building) {
            *self.status = ClothStatus::Waiting;
        }
    }

    /// A task works on the mesh: what it has come to is asked again in the next frame. What runs goes on till then, and
    /// what failed has failed until it is known to be better.
    pub(super) fn wait_for_plan(&mut self, cause: Cause) {
        if cause == Cause::First && !matches!(*self.status, ClothStatus::Failed(_)) {
            self.status.set_if_neq(ClothStatus::Building);
        }
    }

    /// Says why there is no cloth.
    pub(super) fn reject(&mut self, error: ClothError, commands: &mut Commands) {
        self.requests.reset = false;
        self.pending.0 = None;
        // By its words: an error that carries a NaN doesn't equal itself.
        if matches!(&*self.status, ClothStatus::Failed(known) if known.to_string() == error.to_string()) {
            return;
        }
        warn!("cloth {} can't be built: {error}", self.entity);
        *self.status = ClothStatus::Failed(error.clone());
        commands.trigger(ClothFailed { entity: self.entity, error });
    }
}
