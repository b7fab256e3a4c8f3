//! What all cloths of one shape have in common, worked out once: a hundred flags share one topology.

use core::hash::{BuildHasher, Hash, Hasher};
use std::sync::{Arc, Weak};

use bevy::{
    math::Mat3A,
    platform::{collections::HashMap, hash::FixedHasher},
    prelude::*,
};

use super::{
    job::{Jobs, is_large},
    particles_of,
    source::SourceMesh,
};
use crate::{draw::binding::Binding, error::ClothError, solver::Topology};

/// What all cloths of one mesh in one rotation and scale have in common.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    pub topology: Arc<Topology>,
    pub binding: Arc<Binding>,
    /// Positions of the mesh's vertices.
    pub positions: Vec<[f32; 3]>,
    key: PlanKey,
}

/// Hash of a mesh's geometry, and the bits of the rotation and scale that it stands in.
type PlanKey = (u64, [u32; 9]);

/// The plans that are in use, and those that are being made. They go by what a mesh contains: a handle says nothing of
/// when its mesh has changed.
#[derive(Resource, Debug, Default)]
pub(crate) struct PlanCache {
    known: KnownPlans,
    pub(super) jobs: Jobs,
}

/// The plans that are in use.
#[derive(Clone, Debug, Default)]
pub(super) struct KnownPlans(HashMap<PlanKey, (Weak<Topology>, Weak<Binding>)>);

impl PlanCache {
    /// Drops the plans that nobody uses any more.
    pub(super) fn forget_unused(&mut self) {
        self.known.0.retain(|_, (topology, _)| topology.strong_count() > 0);
    }

    /// The plan for `mesh`, whose asset is `id`, with `to_world` as its rotation and scale. None for a large mesh while
    /// it is being made: ask for it in each frame, or nobody goes on with it.
    pub(super) fn plan(&mut self, id: AssetId<Mesh>, mesh: &Mesh, to_world: Mat3A) -> Option<Result<Plan, ClothError>> {
        let plan = if is_large(mesh) {
            self.jobs.ask(id, mesh, to_world, &self.known)?
        } else {
            Plan::make(mesh, to_world, &self.known)
        };
        Some(plan.map(|plan| self.known.share(plan)))
    }
}

impl KnownPlans {
    /// The parts of a plan that is in use.
    fn get(&self, key: &PlanKey) -> Option<(Arc<Topology>, Arc<Binding>)> {
        let (topology, binding) = self.0.get(key)?;
        Some((topology.upgrade()?, binding.upgrade()?))
    }

    /// The same plan, with the parts of the one that is in use, if one is.
    fn share(&mut self, plan: Plan) -> Plan {
        if let Some((topology, binding)) = self.get(&plan.key) {
            return Plan { topology, binding, ..plan };
        }
        self.0.insert(plan.key, (Arc::downgrade(&plan.topology), Arc::downgrade(&plan.binding)));
        plan
    }
}

impl Plan {
    /// Makes the plan for `mesh`, of parts that are `known` where they are.
    pub fn make(mesh: &Mesh, to_world: Mat3A, known: &KnownPlans) -> Result<Self, ClothError> {
        let source = SourceMesh::read(mesh)?;
        let positions = source.positions.iter().map(Vec3::to_array).collect();
        let key = (hash(&source), bits(to_world));
        if let Some((topology, binding)) = known.get(&key) {
            return Ok(Self { topology, binding, positions, key });
        }
        let (welded, topology) = particles_of(&source, to_world)?;
        Ok(Self { topology: Arc::new(topology), binding: Arc::new(Binding::new(&source, &welded)), positions, key })
    }
}

/// A rotation and scale, to be compared as it is: 0 isn't -0.
pub(super) fn bits(to_world: Mat3A) -> [u32; 9] {
    to_world.to_cols_array().map(f32::to_bits)
}

fn hash(source: &SourceMesh) -> u64 {
    let SourceMesh { positions, triangles, normals, uvs, tangents } = source;
    let mut hasher = FixedHasher.build_hasher();
    triangles.hash(&mut hasher);
    let mut add = |values: &mut dyn Iterator<Item = f32>| {
        for value in &mut *values {
            value.to_bits().hash(&mut hasher);
        }
        // Where one list ends belongs to what is hashed.
        u32::MAX.hash(&mut hasher);
    };
    add(&mut positions.iter().flat_map(Vec3::to_array));
    add(&mut normals.iter().flatten().flat_map(Vec3::to_array));
    add(&mut uvs.iter().flatten().flat_map(Vec2::to_array));
    add(&mut tangents.iter().flatten().flat_map(Vec4::to_array));
    hasher.finish()
}
