//! Whether, and how, cloth collides with cloth.

use bevy_reflect::{Reflect, std_traits::ReflectDefault};

use crate::topology::Topology;

/// Distance between balls at the particles that nothing gets through, as a share of the mean edge: of a square cell, a corner is
/// 0.71 of its side from the middle, and the mean edge, diagonals too, is 1.14 of it.
const BALL: f32 = 0.65;

/// The largest distance between parts of a cloth, as a multiple of the mean edge.
const MOST_EDGES: f32 = 4.0;

/// How a cloth collides with itself and with other cloths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Reflect)]
#[reflect(Default, Debug, Clone, PartialEq)]
pub enum SelfCollision {
    /// Nothing: it passes through itself.
    #[default]
    Off,
    /// Its particles, as balls: fast, and good enough where nothing thin or quick comes between them.
    Particles,
    /// Its triangles and edges: folds, layers and knots stay apart.
    Robust,
}

impl SelfCollision {
    /// Distance that parts of a cloth keep from each other, m, where that of the settings is `distance`: balls at its
    /// particles are larger, so that nothing gets through between them. No distance is more than some edges long: everything
    /// would be near everything.
    pub fn distance_on(self, topology: &Topology, distance: f32) -> f32 {
        let edge = topology.surface().mean_edge;
        let least = match self {
            Self::Particles => BALL * edge,
            Self::Robust | Self::Off => 0.0,
        };
        distance.min(MOST_EDGES * edge).max(least)
    }
}

/// Which others something collides with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CollisionFilter {
    /// Layers that it is in, one a bit.
    pub layers: u32,
    /// Layers of the others that it meets, one a bit.
    pub mask: u32,
}

impl CollisionFilter {
    /// Whether two cloths meet: each is in a layer of the other's mask.
    pub const fn meets(self, other: Self) -> bool {
        self.selects(other.layers) && other.selects(self.layers)
    }

    /// Whether something in these `layers` that has no mask of its own is met, such as an obstacle.
    pub const fn selects(self, layers: u32) -> bool {
        self.mask & layers != 0
    }
}

impl Default for CollisionFilter {
    /// In the first layer, and meets all.
    fn default() -> Self {
        Self { layers: 1, mask: u32::MAX }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_meet_where_each_is_in_the_mask_of_the_other() {
        let [all, first, second] = [u32::MAX, 1, 2].map(|mask| CollisionFilter { layers: 1, mask });
        assert!(all.meets(all) && all.meets(first) && first.meets(all));
        assert!(!all.meets(second) && !second.meets(all) && !second.meets(second));
        assert!(second.selects(3) && !second.selects(1) && !all.selects(0));
    }
}
