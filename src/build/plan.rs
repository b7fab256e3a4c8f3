//! What all cloths of one shape have in common, worked out once: a hundred flags share one topology.

use core::hash::{BuildHasher, Hash, Hasher};
use std::sync::{Arc, Weak};

use bevy::{
    math::Mat3A,
    platform::{collections::HashMap, hash::FixedHasher},
    prelude::*,
};

use super::{particles_of, source::SourceMesh};
use crate::{draw::binding::Binding, error::ClothError, solver::Topology};

/// What all cloths of one mesh in one rotation and scale have in common.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    pub topology: Arc<Topology>,
    pub binding: Arc<Binding>,
    /// Positions of the mesh's vertices.
    pub positions: Vec<[f32; 3]>,
}

/// Hash of a mesh's geometry, and the bits of the rotation and scale that it stands in.
type PlanKey = (u64, [u32; 9]);

/// The plans that are in use. They go by what a mesh contains: a handle says nothing of when its mesh has changed.
#[derive(Resource, Debug, Default)]
pub(crate) struct PlanCache {
    plans: HashMap<PlanKey, (Weak<Topology>, Weak<Binding>)>,
}

impl PlanCache {
    /// Drops the plans that nobody uses any more.
    pub(super) fn forget_unused(&mut self) {
        self.plans.retain(|_, (topology, _)| topology.strong_count() > 0);
    }

    /// The plan for `mesh` with `to_world` as its rotation and scale.
    pub(super) fn plan(&mut self, mesh: &Mesh, to_world: Mat3A) -> Result<Plan, ClothError> {
        let source = SourceMesh::read(mesh)?;
        let positions = source.positions.iter().map(Vec3::to_array).collect();
        let key = (hash(&source), to_world.to_cols_array().map(f32::to_bits));
        if let Some((topology, binding)) = self.plans.get(&key)
            && let (Some(topology), Some(binding)) = (topology.upgrade(), binding.upgrade())
        {
            return Ok(Plan { topology, binding, positions });
        }
        let (welded, topology) = particles_of(&source, to_world)?;
        let topology = Arc::new(topology);
        let binding = Arc::new(Binding::new(&source, &welded));
        self.plans.insert(key, (Arc::downgrade(&topology), Arc::downgrade(&binding)));
        Ok(Plan { topology, binding, positions })
    }
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
