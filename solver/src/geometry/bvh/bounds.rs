//! Where the triangles of a surface and its patches are, and which way they face.

use bevy_math::Vec3A;

use crate::geometry::bvh::TriangleBvh;

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

    /// Whether the straight way between two places leads through it: there is no axis along which it passes by.
    #[inline]
    pub fn is_met_by(&self, [from, to]: [Vec3A; 2]) -> bool {
        let (half, size) = ((to - from) * 0.5, (self.high - self.low) * 0.5);
        let (off, along) = ((from + to - self.low - self.high) * 0.5, half.abs());
        let turned = off.cross(half).abs();
        let across = Vec3A::new(
            size.y * along.z + size.z * along.y,
            size.z * along.x + size.x * along.z,
            size.x * along.y + size.y * along.x,
        );
        (off.abs().cmple(size + along) & turned.cmple(across)).all()
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
pub struct BvhBounds {
    /// Box around each triangle.
    pub of_triangles: Vec<Bounds>,
    /// Box around each node; of the first, which isn't used, nothing.
    pub of_nodes: Vec<Bounds>,
    /// Directions that all triangles of each node face.
    pub facing: Vec<u32>,
}

impl BvhBounds {
    /// Follows the surface, whose triangles are in `bounds` of their number. `corners` tells where a triangle's corners
    /// are, if it matters which way patches face.
    pub fn follow(
        &mut self,
        surface: &TriangleBvh,
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
