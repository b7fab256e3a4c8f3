//! Whether a mesh is fine enough for the folds of what it is made of.

use bevy::{math::ops, prelude::*};

use super::{ClothSprings, Fabric};
use crate::{
    solver::{SpringKind, Topology},
    state::ClothState,
};

/// Edges of a mesh may be so many times (B / (density g))^(1/3) long and still show a fabric's folds: a fold that hangs
/// under its weight is some six of them wide, and takes four edges.
const FOLD: f32 = 1.5;

/// Earth's gravity, m/s².
const GRAVITY: f32 = 9.81;

/// By how many times a mesh has to be coarser for its fabric than when it was told of, to be told of again: a slider that is
/// moved to and fro has no more to say.
const AGAIN: f32 = 2.0;

impl Fabric {
    /// (B / (density g))^(1/3), m: the length that decides how a fabric drapes. It hangs over an edge about twice as far until
    /// it points 41.5° down, which is how a laboratory measures it (ASTM D1388).
    pub fn bending_length(&self) -> f32 {
        ops::cbrt(self.bending_rigidity / (self.density * GRAVITY))
    }

    /// The longest that a mesh's edges may be if it is to show this fabric's folds, m. Zero where nothing resists bending:
    /// then no mesh shows them all.
    pub fn max_edge_length(&self) -> f32 {
        FOLD * self.bending_length()
    }
}

/// Says so once where a cloth's mesh is too coarse for its fabric. Plain springs are what they are on any mesh.
pub(crate) fn warn_if_coarse(entity: Entity, fabric: &Fabric, springs: Option<&ClothSprings>, state: &mut ClothState) {
    let (has, needs) = (mean_edge(&state.topology), fabric.max_edge_length());
    let coarseness = has / needs;
    let is_news = coarseness > f32::max(1.0, AGAIN * state.said.coarseness);
    if springs.is_none() && needs > 0.0 && is_news {
        state.said.coarseness = coarseness;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limp_and_heavy_fabrics_need_fine_meshes() {
        // (40e-6 / (0.324 · 9.81))^(1/3) = 23.3 mm, and (3e-6 / (0.09 · 9.81))^(1/3) = 15.0 mm.
        for (fabric, length) in [(Fabric::DENIM, 0.0233), (Fabric::SILK, 0.0150)] {
            assert!((fabric.max_edge_length() / (FOLD * length) - 1.0).abs() < 0.005, "{}", fabric.max_edge_length());
        }
        assert_eq!(Fabric { bending_rigidity: 0.0, ..Fabric::SILK }.max_edge_length(), 0.0);
    }
}
