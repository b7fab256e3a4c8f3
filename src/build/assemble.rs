//! A candidate becomes cloth: its plan, its tethers, its state at rest, and the place of what was there before.

use std::sync::Arc;

use bevy::{
    asset::RenderAssetUsages,
    math::{Affine3A, Mat3A, Vec3A},
    prelude::*,
};

use super::{
    candidate::{CandidateItem, Cause},
    copies::{Wanted, make_copies, show_copies},
    plan::{Plan, PlanCache, is_large},
    skin::{at_scale_of, wear},
};
use crate::{
    attach,
    cloth::{InForce, margin, resolution},
    draw::{Binding, ClothMesh, Drawn, Lost, copy_with_skin, copy_without_skin},
    error::ClothError,
    frame::{Jump, Skeletons, is_invertible},
    mesh_input::is_skinned,
    pins::{PinTarget, targets_by_particle},
    solver::{Material, Particles, Tethers},
    state::{
        self, BuildKey, ClothAttachments, ClothGrabs, ClothReady, ClothReport, ClothReset, ClothState, ClothStatus,
        Requests, RestScale, Skinning, StepInput, TetherKey, width_at_rest,
    },
};

/// A cloth that is ready to take its place.
pub(super) struct Built {
    state: ClothState,
    attachments: ClothAttachments,
    input: StepInput,
    skinning: Skinning,
    binding: Arc<Binding>,
    positions: Vec<[f32; 3]>,
}

impl CandidateItem<'_, '_> {
    /// The cloth that the entity's components and `mesh`, whose asset is `id`, make. None while tasks work on it.
    pub(super) fn build(
        &mut self,
        id: AssetId<Mesh>,
        mesh: &Mesh,
        cache: &mut PlanCache,
        skeletons: &Skeletons,
    ) -> Result<Option<Built>, ClothError> {
        let skeleton = self.skeleton().filter(|_| is_skinned(mesh)).cloned();
        let bindposes = match skeleton.as_ref().map(|skeleton| skeletons.bindposes(skeleton)) {
            Some(None) => {
                // Asked again until they are there.
                self.pending.0.get_or_insert(BuildKey { to_world: Mat3A::IDENTITY, tethers: None });
                return Ok(None);
            }
            bindposes => bindposes.flatten(),
        };
        let worn = skeleton.as_ref().zip(bindposes);
        let pose = match worn {
            // The mesh as it was modelled: of its skeleton's transform only the scale counts.
            Some((skeleton, bindposes)) => at_scale_of(skeleton, bindposes, skeletons)?,
            None => skeletons.pose(self.entity).filter(is_invertible).ok_or(ClothError::FlatTransform)?,
        };
        let pending = self.pending(pose.matrix3);
        // Settings count as they are when all is done.
        if cache.is_working_on(id, &pending) {
            return Ok(None);
        }
        self.cloth.validate()?;
        let material = self.fabric.material_with(self.springs.as_deref())?;
        // What is drawn is a copy: it would leave for the render world with the first frame, and couldn't be written.
        if !mesh.asset_usage.contains(RenderAssetUsages::MAIN_WORLD) {
            return Err(ClothError::NotInMainWorld);
        }
        let Some(plan) = cache.plan(id, mesh, pending.to_world) else { return Ok(None) };
        let plan = plan?;
        let mut targets = self.targets(mesh, &plan)?;
        let skinning = match worn {
            Some((skeleton, bindposes)) => {
                let bound = self.bind(mesh, &plan, (&skeleton.joints, bindposes), &mut targets, skeletons)?;
                Skinning(Some(Box::new(bound)))
            }
            None => Skinning(None),
        };
        let to_world = pending.to_world;
        let mut tethered = None;
        if is_large(mesh) {
            tethered = self.tethers(pending, &plan, &targets, cache);
            if tethered.is_none() {
                return Ok(None);
            }
        }
        let mut state = self.state_at_rest(&plan, to_world, pose, material);
        let (mut attachments, mut input) = (ClothAttachments::default(), StepInput::default());
        let mut skinning = skinning;
        if let Some(bound) = &mut skinning.0 {
            wear(&mut state, bound);
        }
        attach::pins::hold(
            &mut state,
            &mut attachments,
            &mut input,
            &targets,
            (self.entity, &skinning),
            &skeletons.poses,
        );
        if let Some((key, mut tethers)) = tethered {
            if key.pins == pinned(&targets) {
                attachments.tether_build = None;
            } else {
                // Its pins have changed meanwhile: tethers to new ones are worked out while it runs.
                tethers.keep(|pin| targets[pin as usize] != PinTarget::Free);
            }
            attachments.set_tethers(&mut state, tethers);
        }
        Ok(Some(Built { state, attachments, input, skinning, binding: plan.binding, positions: plan.positions }))
    }

    /// What is built of the cloth, with `to_world` as its rotation and scale by now.
    ///
    /// A cloth that turns without an end is made as it stood at first: by the time that it is done, it has turned on.
    fn pending(&mut self, to_world: Mat3A) -> BuildKey {
        if let Some(pending) = &self.pending.0
            && is_turned(pending.to_world, to_world)
        {
            return pending.clone();
        }
        let pending = BuildKey { to_world, tethers: None };
        self.pending.0 = Some(pending.clone());
        pending
    }

    fn targets(&self, mesh: &Mesh, plan: &Plan) -> Result<Vec<PinTarget>, ClothError> {
        let (targets, refused) =
            targets_by_particle(&self.pins, mesh, &plan.binding.particle_of_vertex, &plan.topology);
        match refused.into_iter().next() {
            Some((_, error)) => Err(error),
            None => Ok(targets),
        }
    }

    /// The tethers of a large cloth to its pins, as these were when the plan was done. None while they are being made.
    fn tethers(
        &mut self,
        pending: BuildKey,
        plan: &Plan,
        targets: &[PinTarget],
        cache: &mut PlanCache,
    ) -> Option<(TetherKey, Tethers)> {
        let begun = pending.tethers.filter(|key| Arc::ptr_eq(&key.topology, &plan.topology));
        let key = begun.unwrap_or_else(|| TetherKey { topology: plan.topology.clone(), pins: pinned(targets) });
        let tethers = if key.pins.is_empty() { Some(Tethers::default()) } else { cache.tethers(&key) };
        if tethers.is_none() {
            self.pending.0 = Some(BuildKey { tethers: Some(key.clone()), ..pending });
        }
        tethers.map(|tethers| (key, tethers))
    }

    /// The state of the cloth at rest at `pose`, whose plan was made for the rotation and scale `to_world`.
    fn state_at_rest(&self, plan: &Plan, to_world: Mat3A, pose: Affine3A, material: Material) -> ClothState {
        let rest: Vec<Vec3A> = plan.topology.rest.iter().copied().map(Vec3A::from).collect();
        let mut state = ClothState {
            step_start: rest.clone(),
            particles: Particles::at_rest(rest, &plan.topology, &material),
            origin: pose.translation.into(),
            particle_of_vertex: plan.binding.particle_of_vertex.clone(),
            width: width_at_rest(&plan.topology.rest, to_world),
            topology: plan.topology.clone(),
            material: Some(material),
            rest_scale: RestScale::new(to_world),
            pose: Affine3A { matrix3: to_world, ..pose },
            // Goes on counting, so that what is drawn of the new cloth isn't taken for the old one's.
            steps: self.state.steps + 1,
            ..default()
        };
        if let Some(turn) = Jump::between(state.pose, pose).filter(|_| to_world != pose.matrix3) {
            state::carry(&mut state, &mut ClothAttachments::default(), &mut ClothGrabs::default(), &turn);
            state.pose = pose;
        }
        state
    }

    /// Copies the user's mesh to be drawn. Warns once of morph targets, which aren't followed, and of a skin without a skeleton.
    fn copy_of(&mut self, mesh: &Mesh, is_worn: bool) -> Mesh {
        let warned = &mut *self.warned;
        let (copy, Lost { skin, morph_targets }) = if is_worn { copy_with_skin(mesh) } else { copy_without_skin(mesh) };
        if skin && !core::mem::replace(&mut warned.skin, true) {
            warn!(
                "cloth {} is simulated and drawn from its bind pose: its mesh has a skin, and the entity no SkinnedMesh; \
                 insert one to have its skeleton followed",
                self.entity
            );
        }
        if morph_targets && !core::mem::replace(&mut warned.morph_targets, true) {
            warn!("cloth {} is simulated and drawn without its morph targets: they aren't followed yet", self.entity);
        }
        copy
    }

    /// Lets what was built take its place.
    pub(super) fn accept(
        &mut self,
        built: Built,
        cause: Cause,
        source: Handle<Mesh>,
        meshes: &mut Assets<Mesh>,
        commands: &mut Commands,
    ) {
        let entity = self.entity;
        let garment = self.garment.as_deref().filter(|_| self.mesh.is_none());
        let wanted = Wanted::of(entity, &source, built.positions.len(), garment);
        // A rebuilt cloth keeps its own meshes, with new contents; those of a copied entity are another's.
        let own = self.own_mesh.filter(|_| cause != Cause::First);
        let is_worn = built.skinning.0.is_some();
        let drawn = make_copies(wanted, own, meshes, |mesh| self.copy_of(mesh, is_worn));
        self.grabs.release_all(&self.state);
        let reset_from = (cause != Cause::First).then_some(self.state.pose);
        *self.requests = Requests { reset_from, ..default() };
        *self.in_force = InForce::new(&self.cloth, &built.state);
        *self.report = ClothReport::default();
        self.pending.0 = None;
        *self.state = built.state;
        *self.attachments = built.attachments;
        *self.input = built.input;
        *self.skinning = built.skinning;
        self.sleep.start_over();
        *self.status = ClothStatus::Ready;
        resolution::warn_if_coarse(entity, &self.fabric, self.springs.as_deref(), &self.state, &mut self.warned);
        margin::warn_if_too_large(entity, &self.state, &self.in_force, &mut self.warned);
        show_copies(&drawn, self.mesh.as_deref_mut(), commands);
        let shape = Drawn::new(built.positions);
        let own_mesh = ClothMesh { source, drawn, binding: built.binding, shape };
        commands.entity(entity).try_insert(own_mesh);
        match cause {
            Cause::First => commands.trigger(ClothReady { entity }),
            Cause::Again(cause) => commands.trigger(ClothReset { entity, cause }),
        }
    }
}

/// The particles that are fixed to something.
fn pinned(targets: &[PinTarget]) -> Arc<[u32]> {
    let targets = (0..).zip(targets);
    targets.filter(|(_, target)| **target != PinTarget::Free).map(|(particle, _)| particle).collect()
}

/// Whether two rotations and scales differ by a rotation at most.
fn is_turned(one: Mat3A, other: Mat3A) -> bool {
    // Much more than the rounding along a long chain of parents, and less than any change that shows.
    const ROUNDING: f32 = 1e-4;
    let turn = other * one.inverse();
    turn.determinant() > 0.0 && (turn.transpose() * turn).abs_diff_eq(Mat3A::IDENTITY, ROUNDING)
}
