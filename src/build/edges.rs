//! The edges of a triangle mesh and what lies on their sides.

/// A side of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
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
    half_edges: Vec<HalfEdge>,
}

impl Edges {
    /// Collects the edges of `triangles`.
    pub fn new(triangles: &[[u32; 3]]) -> Self {
        let mut half_edges = Vec::with_capacity(3 * triangles.len());
        for (triangle, &[i, j, k]) in triangles.iter().enumerate() {
            for (p, q, opposite) in [(i, j, k), (j, k, i), (k, i, j)] {
                half_edges.push(HalfEdge { a: p.min(q), b: p.max(q), triangle: triangle as u32, opposite });
            }
        }
        half_edges.sort_unstable();
        Self { half_edges }
    }

    /// The edges, each as the sides that it has: one at a border, two inside, more where sheets meet.
    pub fn iter(&self) -> impl Iterator<Item = &[HalfEdge]> {
        self.half_edges.chunk_by(|p, q| (p.a, p.b) == (q.a, q.b))
    }
}
