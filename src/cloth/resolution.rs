//! Whether a cloth's mesh is fine enough for the folds of its fabric.

use bevy::prelude::*;

use crate::{
    fabric::{ClothSprings, Fabric},
    solver::{SpringKind, Topology},
    state::{ClothState, Warned},
};

/// By how many times a mesh has to be coarser for its fabric than when it was told of, to be told of again: a slider that is
/// moved to and fro has no more to say.
const AGAIN: f32 = 2.0;

/// Says so once where a cloth's mesh is too coarse for its fabric. Plain springs are what they are on any mesh.
pub(crate) fn warn_if_coarse(
    entity: Entity,
    fabric: &Fabric,
    springs: Option<&ClothSprings>,
    state: &ClothState,
    warned: &mut Warned,
) {
    let (has, needs) = (mean_edge(&state.topology), fabric.max_edge_length());
    let coarseness = has / needs;
    let is_news = coarseness > f32::max(1.0, AGAIN * warned.coarseness);
    if springs.is_none() && needs > 0.0 && is_news {
        warned.coarseness = coarseness;
        warn!(
            "cloth {entity} has edges of {:.1} mm in the mean, and its fabric needs them to be {:.1} mm at most, or folds \
             come out wider than they are: make its mesh finer, or its Fabric::bending_rigidity greater",
            has * 1e3,
            needs * 1e3
        );
    }
}

/// Mean length of a mesh's edges, m.
fn mean_edge(topology: &Topology) -> f32 {
    let (sum, count) =
        topology.springs_of(SpringKind::Structural).fold((0.0, 0_u32), |(sum, count), s| (sum + s.rest, count + 1));
    sum / count.max(1) as f32
}
