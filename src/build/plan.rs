//! What all cloths of one shape have in common, worked out once: a hundred flags share one topology.

use core::hash::{BuildHasher, Hash, Hasher};
use std::sync::{Arc, Weak};

use bevy::{
    math::Mat3A,
    mesh::MeshVertexAttributeId,
    platform::{collections::HashMap, hash::FixedHasher},
    prelude::*,
};

use super::source_of;
use crate::{
    draw::Binding,
    error::ClothError,
    mesh_input::Jobs,
    solver::{self, SourceMesh, Tethers, Topology, tethers},
    state::{BuildKey, TetherKey},
};

/// Corners of the triangles of a mesh that is built at once, at most. A grid of 70 x 70 vertices has so many and takes
/// some 10 ms, an irregular mesh twice that: the longest that a frame can spare.
const MOST_AT_ONCE: usize = 30_000;

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

/// The plans that are in use, and what tasks work on for large meshes. Plans go by what a mesh contains: a handle says
/// nothing of when its mesh has changed.
#[derive(Resource, Debug, Default)]
pub(crate) struct PlanCache {
    known: KnownPlans,
    /// Plans by their mesh, and the bits of the rotation and scale that it stands in.
    plans: Jobs<(AssetId<Mesh>, [u32; 9]), Made>,
    tethers: Jobs<TetherKey, Tethers>,
}

/// The plans that are in use.
#[derive(Clone, Debug, Default)]
struct KnownPlans(HashMap<PlanKey, (Weak<Topology>, Weak<Binding>)>);

/// A mesh as it was when its plan was begun, and the plan.
#[derive(Debug)]
struct Made {
    mesh: Mesh,
    plan: Result<Plan, ClothError>,
}

impl PlanCache {
    /// Drops what nobody uses or waits for any more and what is made from a mesh that `has_changed`, and looks for what
    /// is done.
    pub(super) fn update(&mut self, has_changed: impl Fn(AssetId<Mesh>) -> bool) {
        self.known.0.retain(|_, (topology, _)| topology.strong_count() > 0);
        self.plans.update(|&(mesh, _)| has_changed(mesh));
        self.tethers.update(|_| false);
    }

    /// Whether anything is being worked on that a cloth waits for. What is done already is kept for it.
    pub(super) fn is_working_on(&mut self, id: AssetId<Mesh>, pending: &BuildKey) -> bool {
        let plan = self.plans.is_running(&(id, bits(pending.to_world)));
        let tethers = pending.tethers.as_ref().is_some_and(|key| self.tethers.is_running(key));
        plan || tethers
    }

    /// The plan for `mesh`, whose asset is `id`, with `to_world` as its rotation and scale. None for a large mesh while
    /// it is being made: ask for it in each frame, or nobody goes on with it.
    pub(super) fn plan(&mut self, id: AssetId<Mesh>, mesh: &Mesh, to_world: Mat3A) -> Option<Result<Plan, ClothError>> {
        let plan = if is_large(mesh) {
            let key = (id, bits(to_world));
            let made = self.plans.get_or_begin(key, || {
                let (mesh, known) = (mesh.clone(), self.known.clone());
                async move {
                    let plan = Plan::make(&mesh, to_world, &known);
                    Made { mesh, plan }
                }
            })?;
            // A change of the mesh is announced a frame late.
            if !has_same_contents(&made.mesh, mesh) {
                self.plans.forget(&key);
                return None;
            }
            made.plan.clone()
        } else {
            Plan::make(mesh, to_world, &self.known)
        };
        Some(plan.map(|plan| self.known.share(plan)))
    }

    /// The tethers to some pins. None while they are being made, as in [`plan`](Self::plan).
    pub(super) fn tethers(&mut self, key: &TetherKey) -> Option<Tethers> {
        let work = || {
            let key = key.clone();
            async move { tethers(&key.topology, &key.pins) }
        };
        self.tethers.get_or_begin(key.clone(), work).cloned()
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
    fn make(mesh: &Mesh, to_world: Mat3A, known: &KnownPlans) -> Result<Self, ClothError> {
        let source = source_of(mesh)?;
        let positions = source.positions.iter().map(Vec3::to_array).collect();
        let key = (hash(&source), bits(to_world));
        if let Some((topology, binding)) = known.get(&key) {
            return Ok(Self { topology, binding, positions, key });
        }
        let (welded, topology) = solver::build(&source, to_world)?;
        Ok(Self { topology: Arc::new(topology), binding: Arc::new(Binding::new(&source, &welded)), positions, key })
    }
}

/// Whether a mesh is too large to be built within a frame.
pub(super) fn is_large(mesh: &Mesh) -> bool {
    let vertices = || mesh.try_attribute(Mesh::ATTRIBUTE_POSITION).map_or(0, |positions| positions.len());
    mesh.try_indices().map_or_else(|_| vertices(), |indices| indices.len()) > MOST_AT_ONCE
}

/// Whether two meshes have the same attributes and triangles, bit for bit: not even a NaN differs from itself.
fn has_same_contents<'a>(one: &'a Mesh, other: &'a Mesh) -> bool {
    let contents = |mesh: &'a Mesh| -> Option<Vec<(MeshVertexAttributeId, &[u8])>> {
        Some(mesh.try_attributes().ok()?.map(|(attribute, values)| (attribute.id, values.get_bytes())).collect())
    };
    one.primitive_topology() == other.primitive_topology()
        && one.try_indices().ok() == other.try_indices().ok()
        && contents(one) == contents(other)
}

/// A rotation and scale, to be compared as it is: 0 isn't -0.
fn bits(to_world: Mat3A) -> [u32; 9] {
    to_world.to_cols_array().map(f32::to_bits)
}

fn hash(source: &SourceMesh) -> u64 {
    let SourceMesh { positions, triangles, normals, uvs, warp, tangents } = source;
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
    add(&mut warp.iter().flatten().flat_map(Vec3::to_array));
    add(&mut tangents.iter().flatten().flat_map(Vec4::to_array));
    hasher.finish()
}
