//! Where the triangles of a surface and its patches are, and which way they face.

use core::f32::consts::FRAC_1_SQRT_2;

use bevy_math::{Vec3A, Vec4};

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

/// 1/√3, no unit.
const FRAC_1_SQRT_3: f32 = 0.577_350_3;

/// Cosine of the largest angle between a patch's normals and the direction that it is said to face: a patch that
/// is no steeper has room to fold before it touches itself.
const FACING: f32 = 0.5;

/// The directions that a normal of any length faces, one a bit: those to the sides, edges and corners of a cube.
fn facing(normal: Vec3A) -> u32 {
    let [x, y, z] = normal.to_array();
    // How far it goes along each, and in the upper half of the bits against it.
    let along = [
        Vec4::new(x, y, z, 0.0),
        Vec4::new(x + y, x - y, x + z, x - z) * FRAC_1_SQRT_2,
        Vec4::new(y + z, y - z, 0.0, 0.0) * FRAC_1_SQRT_2,
        Vec4::new(x + y + z, x + y - z, x - y + z, x - y - z) * FRAC_1_SQRT_3,
    ];
    let least = Vec4::splat(FACING * normal.length());
    along.into_iter().enumerate().fold(0, |bits, (i, along)| {
        bits | along.cmpgt(least).bitmask() << (4 * i) | (-along).cmpgt(least).bitmask() << (16 + 4 * i)
    })
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
