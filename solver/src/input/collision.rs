//! Which others something collides with.

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
