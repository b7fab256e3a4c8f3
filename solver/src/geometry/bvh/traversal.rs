//! Ways down the trees of surfaces.

use crate::geometry::bvh::{
    TriangleBvh,
    bounds::{Bounds, BvhBounds},
};

/// Pairs of leaves, and leaves, whose boxes meet.
#[derive(Clone, Debug, Default)]
pub struct Traversal {
    left: Vec<(u32, u32)>,
    folded: Vec<u32>,
}

impl Traversal {
    /// Visits the pairs of leaves of two surfaces whose boxes meet.
    pub fn between(
        &mut self,
        (a, at): (&TriangleBvh, &BvhBounds),
        (b, bt): (&TriangleBvh, &BvhBounds),
        mut visit: impl FnMut(u32, u32),
    ) {
        self.left.clear();
        self.left.push((1, 1));
        self.down((a, at), (b, bt), None, &mut visit);
    }

    /// Visits those of them that the other surface has something sharper than `sharpness` in.
    pub fn between_sharp(
        &mut self,
        (a, at): (&TriangleBvh, &BvhBounds),
        (b, bt): (&TriangleBvh, &BvhBounds),
        sharpness: f32,
        mut visit: impl FnMut(u32, u32),
    ) {
        self.left.clear();
        self.left.push((1, 1));
        self.down((a, at), (b, bt), Some(sharpness), &mut visit);
    }

    /// Visits the pairs of leaves of one surface that may touch each other, and leaves that may touch themselves as a pair
    /// of the same. Patches that face one way are left out.
    pub fn within(&mut self, surface: &TriangleBvh, places: &BvhBounds, mut visit: impl FnMut(u32, u32)) {
        self.folded.clear();
        self.folded.push(1);
        while let Some(node) = self.folded.pop() {
            if places.facing[node as usize] != 0 && surface.is_patch(node) {
                continue;
            }
            if surface.is_leaf(node) {
                visit(node, node);
                continue;
            }
            let (first, other) = (2 * node, 2 * node + 1);
            self.left.clear();
            self.left.push((first, other));
            // Two leaves beside each other that face one way are a patch too.
            let mut visit_folded = |p: u32, q: u32| {
                if places.facing[p as usize] & places.facing[q as usize] == 0 || !surface.are_beside(p, q) {
                    visit(p, q);
                }
            };
            self.down((surface, places), (surface, places), None, &mut visit_folded);
            self.folded.extend([other, first]);
        }
    }

    /// Visits the pairs of leaves below what is left whose boxes meet.
    fn down(
        &mut self,
        (a, at): (&TriangleBvh, &BvhBounds),
        (b, bt): (&TriangleBvh, &BvhBounds),
        sharper_than: Option<f32>,
        visit: &mut impl FnMut(u32, u32),
    ) {
        while let Some((p, q)) = self.left.pop() {
            if sharper_than.is_some_and(|least| b.sharpest[q as usize] <= least) {
                continue;
            }
            if !at.of_nodes[p as usize].meets(&bt.of_nodes[q as usize]) {
                continue;
            }
            match (a.is_leaf(p), b.is_leaf(q)) {
                (true, true) => visit(p, q),
                (false, true) => self.left.extend([(2 * p + 1, q), (2 * p, q)]),
                (true, false) => self.left.extend([(p, 2 * q + 1), (p, 2 * q)]),
                (false, false) => {
                    self.left.extend([(2 * p + 1, 2 * q + 1), (2 * p + 1, 2 * q), (2 * p, 2 * q + 1), (2 * p, 2 * q)])
                }
            }
        }
    }
}

impl TriangleBvh {
    /// The leaf at the end of the way down that takes the second branch wherever `takes_second` of the numbers of both.
    pub fn leaf_by(&self, takes_second: impl Fn(usize, usize) -> bool) -> u32 {
        let mut node = 1;
        while !self.is_leaf(node) {
            let [first, second] = [2 * node, 2 * node + 1];
            node = if takes_second(first as usize, second as usize) { second } else { first };
        }
        node
    }

    /// Visits the triangles of the leaves whose boxes, and those of all patches that they are in, are near.
    #[inline(always)]
    pub fn for_each_near(&self, places: &BvhBounds, is_near: impl Fn(&Bounds) -> bool, mut visit: impl FnMut(usize)) {
        // Down to the next leaf, then on to the next branch: without a list of what is left.
        let last = self.node_count() as u32;
        let mut node = 1;
        loop {
            let goes_in = is_near(&places.of_nodes[node as usize]);
            if goes_in && self.is_leaf(node) {
                self.of_leaf(node).for_each(&mut visit);
            }
            if goes_in && !self.is_leaf(node) {
                node *= 2;
                continue;
            }
            // Up from every second branch.
            while node % 2 == 1 && node > 1 {
                node /= 2;
            }
            if node <= 1 || node >= last {
                return;
            }
            node += 1;
        }
    }
}
