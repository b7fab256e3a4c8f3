//! The edges of a triangle mesh and what lies on their sides.

use super::grouped::Grouped;

/// A side of a triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct HalfEdge {
    /// The end with the lower index.
    pub a: u32,
    /// The end with the higher index.
    pub b: u32,
    /// The triangle.
    pub triangle: u32,
    /// The triangle's third vertex.
    pub opposite: u32,
}

/// All sides of all triangles, sorted, so that the sides of one edge stand together and the order is always the same.
#[derive(Clone, Debug, Default)]
pub(crate) struct Edges {
    half_edges: Grouped<HalfEdge>,
}

impl Edges {
    /// Collects the edges of `triangles` among `count` particles.
    pub fn new(count: usize, triangles: &[[u32; 3]]) -> Self {
        let sides = (0..).zip(triangles).flat_map(|(triangle, &[i, j, k])| {
            [(i, j, k), (j, k, i), (k, i, j)].map(|(p, q, opposite)| {
                let (a, b) = (p.min(q), p.max(q));
                (a, HalfEdge { a, b, triangle, opposite })
            })
        });
        let mut half_edges = Grouped::new(count, sides);
        half_edges.iter_mut().for_each(<[HalfEdge]>::sort_unstable);
        Self { half_edges }
    }

    /// The edges, each as the sides that it has: one at a border, two inside, more where sheets meet.
    pub fn iter(&self) -> impl Iterator<Item = &[HalfEdge]> {
        self.half_edges.items().chunk_by(|p, q| (p.a, p.b) == (q.a, q.b))
    }
}
