//! The outlines of solids, each drawn once for what a cloth needs.

use crate::{
    contact::{feature::sink, mesh},
    input::{Obstacle, StepContext},
    shape::{
        Solid,
        sharp_features::{FeatureTolerance, SharpFeatures},
    },
};

/// Outlines of the solids among each cloth's obstacles, with what they were drawn for.
#[derive(Clone, Debug, Default)]
pub struct SharpFeatureCache {
    drawn: Vec<Vec<Option<(Solid, FeatureTolerance, SharpFeatures)>>>,
    /// What others have.
    nothing: SharpFeatures,
}

impl SharpFeatureCache {
    /// Draws that of obstacle `i` of a cloth, where it isn't drawn yet for what the cloth `needs`.
    pub fn draw(&mut self, cloth: usize, i: usize, solid: &Solid, needs: FeatureTolerance) -> &SharpFeatures {
        let Self { drawn, .. } = self;
        drawn.resize_with(drawn.len().max(cloth + 1), Vec::new);
        let some = &mut drawn[cloth];
        some.resize_with(some.len().max(i + 1), || None);
        let known = some[i].take().filter(|(known, met, _)| known == solid && *met == needs);
        &some[i].insert(known.unwrap_or_else(|| (*solid, needs, SharpFeatures::of(solid, needs)))).2
    }

    /// That of obstacle `i` of a cloth: of one that hasn't been drawn, nothing.
    pub fn of(&self, cloth: usize, i: usize) -> &SharpFeatures {
        let outline = self.drawn.get(cloth).and_then(|some| some.get(i)?.as_ref());
        outline.map_or(&self.nothing, |(_, _, outline)| outline)
    }
}

/// Distance that a cloth keeps from an obstacle with its triangles and edges, m.
pub fn distance_to(obstacle: &Obstacle, ctx: &StepContext) -> f32 {
    ctx.contact_distance().max(mesh::LEAST) + obstacle.rounding
}

/// How tightly a cloth, whose longest edge is of length `edge` (m), lies on an obstacle.
pub fn tightness(obstacle: &Obstacle, edge: f32, ctx: &StepContext) -> FeatureTolerance {
    // Nothing is thin to a cloth without edges.
    let edge = if obstacle.is_rough { 0.0 } else { edge };
    FeatureTolerance { edge, distance: distance_to(obstacle, ctx), sink: sink(ctx) }
}
