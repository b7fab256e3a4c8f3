//! Triangles, their corners and edges, and a tree to find them in.
//!
//! The tree belongs to the rest shape and stays; only the boxes of its nodes follow the cloth. What is near along the
//! cloth stays together in it, so most nodes are patches, and a patch that faces one way all over can't touch itself
//! (Volino and Magnenat-Thalmann, "Efficient Self-Collision Detection on Smoothly Discretized Surface Animations Using
//! Geometrical Shape Regularity", 1994).

use core::ops::Range;

use bevy_math::Vec3;
use bevy_platform::collections::HashSet;

pub(crate) mod bounds;
mod patch;
pub(crate) mod traversal;

/// Triangles to a leaf, about.
const LEAF: usize = 4;

/// Features of a triangle, of which each belongs to one triangle only, so that no pair is found twice (Curtis et al.,
/// "Fast Collision Detection for Deformable Models using Representative-Triangles", 2008).
///
/// With each goes how sharp it is, 0..=1: by which share of the distance to a neighbour it stands out of what it joins.
/// Those of cloth count as sharp; 0 is for those of another triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Representative {
    /// Its three corners.
    pub corners: [f32; 3],
    /// Its three edges; edge k is between its corners k and k + 1.
    pub edges: [f32; 3],
}

/// Triangles in the order of their tree.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleBvh {
    /// Corners of each triangle, leaf after leaf.
    pub triangles: Vec<[u32; 3]>,
    /// What belongs to each triangle.
    pub owned: Vec<Representative>,
    /// Mean length of the edges at rest, m.
    pub mean_edge: f32,
    /// Length of the longest edge at rest, m.
    pub longest_edge: f32,
    /// How sharp the sharpest feature within each node is.
    sharpest: Vec<f32>,
    /// Whether each node is a patch.
    is_patch: Vec<bool>,
    /// Leaves that make up a patch with each leaf, in their order, leaf after leaf; and where those of each end.
    beside: Vec<u32>,
    beside_end: Vec<u32>,
    /// Number of leaves, a power of two. Node 1 is the root, and nodes 2 k and 2 k + 1 are within node k.
    leaves: usize,
}

impl TriangleBvh {
    /// Sorts `triangles` between points at `rest` (m).
    pub fn new(rest: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        let mut triangles = triangles.to_vec();
        let leaves = triangles.len().div_ceil(LEAF).max(1).next_power_of_two();
        let middle = |triangle: &[u32; 3]| triangle.iter().map(|&i| rest[i as usize]).sum::<Vec3>();
        sort(&mut triangles, leaves, &middle);
        let mut seen_corners = vec![false; rest.len()];
        let mut seen_edges = HashSet::new();
        let own = |triangle: &[u32; 3]| {
            let mine = |is_new: bool| if is_new { 1.0 } else { 0.0 };
            let corners = triangle.map(|i| mine(!core::mem::replace(&mut seen_corners[i as usize], true)));
            let [a, b, c] = *triangle;
            let edges = [(a, b), (b, c), (c, a)].map(|(p, q)| mine(p != q && seen_edges.insert((p.min(q), p.max(q)))));
            Representative { corners, edges }
        };
        let owned = triangles.iter().map(own).collect();
        let mut surface = Self { triangles, owned, leaves, ..Self::default() };
        surface.find_neighbours();
        let lengths = || surface.edges().map(|[a, b]| rest[a as usize].distance(rest[b as usize]));
        let (sum, longest, count) = lengths()
            .fold((0.0, 0.0_f32, 0), |(sum, longest, count), length| (sum + length, longest.max(length), count + 1));
        (surface.mean_edge, surface.longest_edge) = (sum / count.max(1) as f32, longest);
        surface.note_sharpest();
        surface
    }

    /// Makes what belongs to each triangle as sharp as `sharpness` says.
    pub fn blunt(&mut self, sharpness: &[Representative]) {
        for (owned, sharp) in self.owned.iter_mut().zip(sharpness) {
            for i in 0..3 {
                owned.corners[i] *= sharp.corners[i];
                owned.edges[i] *= sharp.edges[i];
            }
        }
        self.note_sharpest();
    }

    fn note_sharpest(&mut self) {
        self.sharpest.clear();
        self.sharpest.resize(self.node_count(), 0.0);
        for leaf in self.leaves..2 * self.leaves {
            let owned = self.owned[self.of_leaf(leaf as u32)].iter();
            let sharpness = owned.flat_map(|owned| owned.corners.into_iter().chain(owned.edges));
            self.sharpest[leaf] = sharpness.fold(0.0, f32::max);
        }
        for node in (1..self.leaves).rev() {
            self.sharpest[node] = self.sharpest[2 * node].max(self.sharpest[2 * node + 1]);
        }
    }

    /// Finds which nodes are patches, and which leaves are a patch together.
    fn find_neighbours(&mut self) {
        let fans = patch::fans(&self.triangles);
        let mut parents = vec![0; fans.as_flattened().len()];
        self.is_patch.push(false);
        for node in 1..self.node_count() as u32 {
            self.is_patch.push(patch::are_connected(&fans[self.of_node(node)], &mut parents));
        }
        let mut leaves_at: Vec<Vec<u32>> = vec![Vec::new(); parents.len()];
        let leaves = self.leaves as u32..2 * self.leaves as u32;
        for leaf in leaves.clone().filter(|&leaf| self.is_patch(leaf)) {
            for &fan in fans[self.of_leaf(leaf)].as_flattened() {
                let at = &mut leaves_at[fan as usize];
                if at.last() != Some(&leaf) {
                    at.push(leaf);
                }
            }
        }
        for leaf in leaves {
            let own = if self.is_patch(leaf) { &fans[self.of_leaf(leaf)] } else { &[] };
            let of_fans = own.as_flattened().iter().flat_map(|&fan| leaves_at[fan as usize].iter().copied());
            let mut beside: Vec<u32> = of_fans.collect();
            beside.sort_unstable();
            beside.dedup();
            self.beside.extend(beside);
            self.beside_end.push(self.beside.len() as u32);
        }
    }

    /// Whether the triangles of a node are connected, and wound alike.
    fn is_patch(&self, node: u32) -> bool {
        self.is_patch[node as usize]
    }

    /// Whether two leaves are a patch together: they share a corner, of triangles that are connected around it.
    fn are_beside(&self, leaf: u32, other: u32) -> bool {
        self.part(&self.beside, &self.beside_end, leaf).binary_search(&other).is_ok()
    }

    /// The part of a list that belongs to a leaf.
    fn part<'a>(&self, list: &'a [u32], ends: &[u32], leaf: u32) -> &'a [u32] {
        let i = leaf as usize - self.leaves;
        let start = if i == 0 { 0 } else { ends[i - 1] as usize };
        &list[start..ends[i] as usize]
    }

    /// All edges, once each.
    pub fn edges(&self) -> impl Iterator<Item = [u32; 2]> {
        self.triangles.iter().zip(&self.owned).flat_map(|(&triangle, owned)| {
            edges_of(triangle).into_iter().zip(owned.edges).filter(|&(_, sharp)| sharp > 0.0).map(|(edge, _)| edge)
        })
    }

    /// Number of nodes and of the one that isn't used, 0.
    pub fn node_count(&self) -> usize {
        2 * self.leaves
    }

    /// Whether it has a corner or edge that is sharper than this.
    pub fn has_sharper_than(&self, sharpness: f32) -> bool {
        self.sharpest.get(1).is_some_and(|&sharpest| sharpest > sharpness)
    }

    /// Whether a node is a leaf.
    pub fn is_leaf(&self, node: u32) -> bool {
        node as usize >= self.leaves
    }

    /// The leaves, in their order.
    pub fn leaves(&self) -> Range<u32> {
        self.leaves as u32..2 * self.leaves as u32
    }

    /// Which of the leaves a node is, from 0 on.
    pub fn leaf_number(&self, node: u32) -> usize {
        node as usize - self.leaves
    }

    /// The triangles of a node.
    fn of_node(&self, node: u32) -> Range<usize> {
        let (mut first, mut last) = (node, node);
        while !self.is_leaf(first) {
            (first, last) = (2 * first, 2 * last + 1);
        }
        self.of_leaf(first).start..self.of_leaf(last).end
    }

    /// The triangles of a leaf.
    pub fn of_leaf(&self, node: u32) -> Range<usize> {
        let leaf = node as usize - self.leaves;
        leaf * self.triangles.len() / self.leaves..(leaf + 1) * self.triangles.len() / self.leaves
    }
}

/// The edges of a triangle.
pub fn edges_of([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// Puts triangles that are near to each other into the same one of `leaves`: halves them along the longest side of the
/// box around their middles, and again.
fn sort(triangles: &mut [[u32; 3]], leaves: usize, middle: &impl Fn(&[u32; 3]) -> Vec3) {
    // As `of_leaf` cuts the whole, wherever this is a part of it.
    fn halve(
        triangles: &mut [[u32; 3]],
        leaves: Range<usize>,
        cut: &impl Fn(usize) -> usize,
        middle: &impl Fn(&[u32; 3]) -> Vec3,
    ) {
        if leaves.len() < 2 || triangles.is_empty() {
            return;
        }
        let middles = || triangles.iter().map(middle);
        let low = middles().fold(Vec3::INFINITY, Vec3::min);
        let size = middles().fold(Vec3::NEG_INFINITY, Vec3::max) - low;
        let axis = size.max_position();
        let half = leaves.start + leaves.len() / 2;
        let (first, other) = {
            let at = cut(half) - cut(leaves.start);
            if at < triangles.len() {
                triangles.select_nth_unstable_by(at, |p, q| middle(p)[axis].total_cmp(&middle(q)[axis]));
            }
            triangles.split_at_mut(at)
        };
        halve(first, leaves.start..half, cut, middle);
        halve(other, half..leaves.end, cut, middle);
    }
    let count = triangles.len();
    halve(triangles, 0..leaves, &|leaf| leaf * count / leaves, middle);
}
