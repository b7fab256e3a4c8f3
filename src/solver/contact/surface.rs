//! Triangles, their corners and edges, and a tree to find them in.
//!
//! The tree belongs to the rest shape and stays; only the boxes of its nodes follow the cloth. What is near along the
//! cloth stays together in it, so a node is a patch, and a patch that faces one way all over can't touch itself
//! (Volino and Magnenat-Thalmann, "Efficient Self-Collision Detection on Smoothly Discretized Surface Animations Using
//! Geometrical Shape Regularity", 1994).

use core::ops::Range;

use bevy::{
    math::{Vec3, Vec3A},
    platform::collections::HashSet,
};

/// Triangles to a leaf, about.
const LEAF: usize = 4;

/// Features of a triangle, of which each belongs to one triangle only, so that no pair is found twice (Curtis et al.,
/// "Fast Collision Detection for Deformable Models using Representative-Triangles", 2008).
///
/// With each goes how sharp it is, 0..=1: by which share of the distance to a neighbour it stands out of what it joins.
/// Those of cloth count as sharp; 0 is for those of another triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Owned {
    /// Its three corners.
    pub corners: [f32; 3],
    /// Its three edges; edge k is between its corners k and k + 1.
    pub edges: [f32; 3],
}

/// Triangles in the order of their tree.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// Corners of each triangle, leaf after leaf.
    pub triangles: Vec<[u32; 3]>,
    /// What belongs to each triangle.
    pub owned: Vec<Owned>,
    /// Mean length of the edges at rest, m.
    pub mean_edge: f32,
    /// Length of the longest edge at rest, m.
    pub longest_edge: f32,
    /// How sharp the sharpest feature within each node is.
    sharpest: Vec<f32>,
    /// Points that belong to the triangles of each leaf, leaf after leaf; and where those of each end.
    points: Vec<u32>,
    points_end: Vec<u32>,
    /// Leaves that share a corner with each leaf, in their order, leaf after leaf; and where those of each end.
    beside: Vec<u32>,
    beside_end: Vec<u32>,
    /// Number of leaves, a power of two. Node 1 is the root, and nodes 2 k and 2 k + 1 are within node k.
    leaves: usize,
}

impl Surface {
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
            Owned { corners, edges }
        };
        let owned = triangles.iter().map(own).collect();
        let mut surface = Self { triangles, owned, leaves, ..Self::default() };
        surface.find_neighbours(rest.len());
        let lengths = || surface.edges().map(|[a, b]| rest[a as usize].distance(rest[b as usize]));
        let (sum, longest, count) = lengths()
            .fold((0.0, 0.0_f32, 0), |(sum, longest, count), length| (sum + length, longest.max(length), count + 1));
        (surface.mean_edge, surface.longest_edge) = (sum / count.max(1) as f32, longest);
        surface.note_sharpest();
        surface
    }

    /// Makes what belongs to each triangle as sharp as `sharpness` says.
    pub fn blunt(&mut self, sharpness: &[Owned]) {
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

    /// Finds which leaves share a corner, and which points belong to each.
    fn find_neighbours(&mut self, point_count: usize) {
        let mut leaves_at: Vec<Vec<u32>> = vec![Vec::new(); point_count];
        let leaves = self.leaves as u32..2 * self.leaves as u32;
        for leaf in leaves.clone() {
            for &corner in self.triangles[self.of_leaf(leaf)].as_flattened() {
                let at = &mut leaves_at[corner as usize];
                if at.last() != Some(&leaf) {
                    at.push(leaf);
                }
            }
        }
        for leaf in leaves {
            let corners = self.triangles[self.of_leaf(leaf)].as_flattened();
            let mut beside: Vec<u32> = corners.iter().flat_map(|&i| leaves_at[i as usize].iter().copied()).collect();
            beside.sort_unstable();
            beside.dedup();
            self.beside.extend(beside);
            self.beside_end.push(self.beside.len() as u32);
            for triangle in self.of_leaf(leaf) {
                let owned = self.triangles[triangle].into_iter().zip(self.owned[triangle].corners);
                self.points.extend(owned.filter(|&(_, sharp)| sharp > 0.0).map(|(corner, _)| corner));
            }
            self.points_end.push(self.points.len() as u32);
        }
    }

    /// Whether two leaves share a corner.
    fn are_beside(&self, leaf: u32, other: u32) -> bool {
        self.part(&self.beside, &self.beside_end, leaf).binary_search(&other).is_ok()
    }

    /// The points that belong to the triangles of a leaf.
    pub fn points_of_leaf(&self, leaf: u32) -> &[u32] {
        self.part(&self.points, &self.points_end, leaf)
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

    /// Whether a node is a leaf.
    pub fn is_leaf(&self, node: u32) -> bool {
        node as usize >= self.leaves
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

/// A box along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    pub low: Vec3A,
    pub high: Vec3A,
}

impl Bounds {
    /// Around nothing.
    pub const NOTHING: Self = Self { low: Vec3A::INFINITY, high: Vec3A::NEG_INFINITY };

    /// Around these points.
    #[inline]
    pub fn around(points: impl IntoIterator<Item = Vec3A>) -> Self {
        points.into_iter().fold(Self::NOTHING, |Self { low, high }, p| Self { low: low.min(p), high: high.max(p) })
    }

    /// Around both.
    #[inline]
    pub fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Larger by `margin` (m) on all sides.
    #[inline]
    pub fn grown(self, margin: f32) -> Self {
        Self { low: self.low - margin, high: self.high + margin }
    }

    /// Whether the two share a place.
    #[inline]
    pub fn meets(&self, other: &Self) -> bool {
        (self.low.cmple(other.high) & other.low.cmple(self.high)).all()
    }
}

/// The directions that patches may face, one a bit: to the sides, edges and corners of a cube.
const DIRECTIONS: [[f32; 3]; 13] = {
    const E: f32 = core::f32::consts::FRAC_1_SQRT_2;
    const C: f32 = 0.577_350_3;
    [
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [E, E, 0.0],
        [E, -E, 0.0],
        [E, 0.0, E],
        [E, 0.0, -E],
        [0.0, E, E],
        [0.0, E, -E],
        [C, C, C],
        [C, C, -C],
        [C, -C, C],
        [C, -C, -C],
    ]
};

/// Cosine of the largest angle between a patch's normals and the direction that it is said to face: a patch that
/// is no steeper has room to fold before it touches itself.
const FACING: f32 = 0.5;

/// The directions that a normal of any length faces.
fn facing(normal: Vec3A) -> u32 {
    let least = FACING * normal.length();
    let mut bits = 0;
    for (i, direction) in DIRECTIONS.iter().enumerate() {
        let along = normal.dot(Vec3A::from_array(*direction));
        bits |= u32::from(along > least) << (2 * i) | u32::from(-along > least) << (2 * i + 1);
    }
    bits
}

/// Where the triangles of a surface are, and its patches.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Places {
    /// Box around each triangle.
    pub of_triangles: Vec<Bounds>,
    /// Box around each node; of the first, which isn't used, nothing.
    pub of_nodes: Vec<Bounds>,
    /// Directions that all triangles of each node face.
    pub facing: Vec<u32>,
}

impl Places {
    /// Follows the surface, whose triangles are in `bounds` of their number. `corners` tells where a triangle's corners
    /// are, if it matters which way patches face.
    pub fn follow(
        &mut self,
        surface: &Surface,
        bounds: impl Fn([u32; 3]) -> Bounds,
        corners: Option<impl Fn([u32; 3]) -> [Vec3A; 3]>,
    ) {
        self.of_triangles.clear();
        self.of_triangles.extend(surface.triangles.iter().map(|&triangle| bounds(triangle)));
        self.of_nodes.clear();
        self.of_nodes.resize(surface.node_count(), Bounds::NOTHING);
        self.facing.clear();
        self.facing.resize(surface.node_count(), u32::MAX);
        for node in surface.leaves..2 * surface.leaves {
            let some = surface.of_leaf(node as u32);
            self.of_nodes[node] = self.of_triangles[some.clone()].iter().copied().fold(Bounds::NOTHING, Bounds::union);
            if let Some(corners) = &corners {
                let normal = |triangle: &[u32; 3]| {
                    let [a, b, c] = corners(*triangle);
                    (b - a).cross(c - a)
                };
                let directions = surface.triangles[some].iter().map(|triangle| facing(normal(triangle)));
                self.facing[node] = directions.fold(u32::MAX, |all, one| all & one);
            }
        }
        for node in (1..surface.leaves).rev() {
            self.of_nodes[node] = self.of_nodes[2 * node].union(self.of_nodes[2 * node + 1]);
            self.facing[node] = self.facing[2 * node] & self.facing[2 * node + 1];
        }
    }

    /// Box around all.
    pub fn whole(&self) -> Bounds {
        self.of_nodes.get(1).copied().unwrap_or(Bounds::NOTHING)
    }
}

/// Pairs of leaves, and leaves, whose boxes meet.
#[derive(Clone, Debug, Default)]
pub struct Walk {
    left: Vec<(u32, u32)>,
    folded: Vec<u32>,
}

impl Walk {
    /// Visits the pairs of leaves of two surfaces whose boxes meet.
    pub fn between(
        &mut self,
        (a, at): (&Surface, &Places),
        (b, bt): (&Surface, &Places),
        mut visit: impl FnMut(u32, u32),
    ) {
        self.left.clear();
        self.left.push((1, 1));
        self.down((a, at), (b, bt), None, &mut visit);
    }

    /// Visits those of them that the other surface has something sharper than `sharpness` in.
    pub fn between_sharp(
        &mut self,
        (a, at): (&Surface, &Places),
        (b, bt): (&Surface, &Places),
        sharpness: f32,
        mut visit: impl FnMut(u32, u32),
    ) {
        self.left.clear();
        self.left.push((1, 1));
        self.down((a, at), (b, bt), Some(sharpness), &mut visit);
    }

    /// Visits the pairs of leaves of one surface that may touch each other, and leaves that may touch themselves as a pair
    /// of the same. Patches that face one way are left out.
    pub fn within(&mut self, surface: &Surface, places: &Places, mut visit: impl FnMut(u32, u32)) {
        self.folded.clear();
        self.folded.push(1);
        while let Some(node) = self.folded.pop() {
            if places.facing[node as usize] != 0 {
                continue;
            }
            if surface.is_leaf(node) {
                visit(node, node);
                continue;
            }
            let (first, other) = (2 * node, 2 * node + 1);
            self.left.clear();
            self.left.push((first, other));
            // Two that share a corner and face one way are a patch too.
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
        (a, at): (&Surface, &Places),
        (b, bt): (&Surface, &Places),
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
