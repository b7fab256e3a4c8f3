//! Eight triangles side by side, to tell fast which of their features may touch those of another triangle.

use bevy_math::Vec3A;
use fearless_simd::{dispatch, f32x8, prelude::*};

use crate::{
    contact::feature::narrow_phase::Displacements,
    geometry::bvh::{TriangleBvh, bounds::Bounds},
    layout::{
        points::Block,
        simd::{LANES, Lane, SimdLevel, Vec3x8, lane},
    },
};

/// Some of a pack's triangles, one a bit.
type LaneBits = u8;

/// The triangles of a leaf when a search is made, and on their ways.
#[derive(Clone, Copy, Debug)]
pub struct TrianglePack {
    /// Corners at the start and the end of their ways, m.
    starts: [Block; 3],
    ends: [Block; 3],
    /// By how much each corner may come off its way, m.
    slack: [Lane; 3],
    /// The planes at the start: their unit normals, and where they are along those, m.
    normal: Block,
    height: Lane,
    /// Where the lowest and the highest corner are along the normal in the end, m.
    low_end: Lane,
    high_end: Lane,
    /// The largest slack of the corners, m.
    plane_slack: Lane,
    /// Boxes around the ways.
    low: Block,
    high: Block,
    /// Triangles that each corner and edge belongs to.
    owned_corners: [LaneBits; 3],
    owned_edges: [LaneBits; 3],
    /// How many triangles there are.
    count: usize,
}

/// The packs of a surface's leaves, made when they are first asked for.
#[derive(Clone, Debug, Default)]
pub struct LeafPacks {
    packs: Vec<TrianglePack>,
    /// Number of each leaf's pack, or [`u32::MAX`].
    of_leaf: Vec<u32>,
}

impl LeafPacks {
    /// Forgets the packs of the search before.
    pub fn clear(&mut self, surface: &TriangleBvh) {
        self.packs.clear();
        self.of_leaf.clear();
        self.of_leaf.resize(surface.leaves().len(), u32::MAX);
    }

    /// Makes the pack of a leaf, whose triangles are in `bounds` of their number.
    pub fn make(&mut self, surface: &TriangleBvh, leaf: u32, ways: &Displacements, bounds: &[Bounds]) {
        let number = &mut self.of_leaf[surface.leaf_number(leaf)];
        if *number == u32::MAX {
            *number = self.packs.len() as u32;
            self.packs.push(TrianglePack::new(surface, leaf, ways, bounds));
        }
    }

    /// The pack of a leaf that one was made of.
    pub fn of_leaf(&self, surface: &TriangleBvh, leaf: u32) -> &TrianglePack {
        &self.packs[self.of_leaf[surface.leaf_number(leaf)] as usize]
    }
}

/// Features of two triangles that may touch: each a bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FeatureMask {
    /// Corners and edges of the first triangle, by their numbers.
    pub corners: u8,
    pub edges: u8,
    /// Those of the other.
    pub other_corners: u8,
    pub other_edges: u8,
    /// Whether an edge of one may pierce the other.
    pub may_pierce: bool,
}

impl FeatureMask {
    /// All of them.
    pub const ALL: Self = Self { corners: 7, edges: 7, other_corners: 7, other_edges: 7, may_pierce: true };
}

/// Features of one triangle and of those of a pack that may touch.
#[derive(Clone, Copy, Debug, Default)]
struct FeatureBits {
    corners: [LaneBits; 3],
    edges: [LaneBits; 3],
    other_corners: [LaneBits; 3],
    other_edges: [LaneBits; 3],
    pierced: LaneBits,
}

impl FeatureBits {
    /// Triangles of the pack that have any.
    fn any(&self) -> LaneBits {
        let any = |bits: [LaneBits; 3]| bits[0] | bits[1] | bits[2];
        any(self.corners) | any(self.other_corners) | any(self.edges) & any(self.other_edges) | self.pierced
    }

    fn of_lane(&self, lane: usize) -> FeatureMask {
        let bits = |of: [LaneBits; 3]| (0..3).fold(0, |bits, k| bits | (of[k] >> lane & 1) << k);
        FeatureMask {
            corners: bits(self.corners),
            edges: bits(self.edges),
            other_corners: bits(self.other_corners),
            other_edges: bits(self.other_edges),
            may_pierce: self.pierced >> lane & 1 == 1,
        }
    }
}

impl TrianglePack {
    const NOTHING: Self = Self {
        starts: [[[0.0; LANES]; 3]; 3],
        ends: [[[0.0; LANES]; 3]; 3],
        slack: [[0.0; LANES]; 3],
        normal: [[0.0; LANES]; 3],
        height: [0.0; LANES],
        low_end: [0.0; LANES],
        high_end: [0.0; LANES],
        plane_slack: [0.0; LANES],
        low: [[f32::INFINITY; LANES]; 3],
        high: [[f32::NEG_INFINITY; LANES]; 3],
        owned_corners: [0; 3],
        owned_edges: [0; 3],
        count: 0,
    };

    /// The triangles of a leaf, which are in `bounds` of their number.
    pub fn new(surface: &TriangleBvh, leaf: u32, ways: &Displacements, bounds: &[Bounds]) -> Self {
        let mut pack = Self::NOTHING;
        for (l, triangle) in surface.of_leaf(leaf).enumerate() {
            let corners = surface.triangles[triangle];
            let starts = corners.map(|i| ways.position[i as usize]);
            let ends = corners.map(|i| ways.position[i as usize] + ways.way(i as usize));
            let slack = corners.map(|i| ways.slack(i as usize));
            let normal = (starts[1] - starts[0]).cross(starts[2] - starts[0]).normalize_or_zero();
            let [p, q, r] = ends.map(|end| normal.dot(end));
            for k in 0..3 {
                put(&mut pack.starts[k], l, starts[k]);
                put(&mut pack.ends[k], l, ends[k]);
                pack.slack[k][l] = slack[k];
                let owned = &surface.owned[triangle];
                pack.owned_corners[k] |= LaneBits::from(owned.corners[k] > 0.0) << l;
                pack.owned_edges[k] |= LaneBits::from(owned.edges[k] > 0.0) << l;
            }
            put(&mut pack.normal, l, normal);
            pack.height[l] = normal.dot(starts[0]);
            (pack.low_end[l], pack.high_end[l]) = (p.min(q).min(r), p.max(q).max(r));
            pack.plane_slack[l] = slack[0].max(slack[1]).max(slack[2]);
            put(&mut pack.low, l, bounds[triangle].low);
            put(&mut pack.high, l, bounds[triangle].high);
            pack.count = l + 1;
        }
        pack
    }

    /// Shows the triangles of two packs of which features may come nearer than `distance`, edges nearer than `edge_distance` (m), with
    /// those features. Of a pack with itself, each two triangles once.
    pub fn near(
        &self,
        other: &Self,
        [distance, edge_distance]: [f32; 2],
        is_same: bool,
        simd_level: SimdLevel,
        mut found: impl FnMut(usize, usize, FeatureMask),
    ) {
        let mut all = [FeatureBits::default(); LANES];
        let count = self.count;
        dispatch!(simd_level.level(), simd => near_features(simd, self, other, [distance, edge_distance], &mut all));
        for (s, bits) in all.iter().enumerate().take(count) {
            let mut left = bits.any();
            if is_same {
                left &= !((2_u16 << s) - 1) as LaneBits;
            }
            while left != 0 {
                let t = left.trailing_zeros() as usize;
                left &= left - 1;
                found(s, t, bits.of_lane(t));
            }
        }
    }
}

fn put(block: &mut Block, l: usize, value: Vec3A) {
    (block[0][l], block[1][l], block[2][l]) = (value.x, value.y, value.z);
}

/// The plane of a triangle, or eight of them, and where its corners end before and behind it.
#[derive(Clone, Copy)]
struct Planes<S: Simd> {
    normal: Vec3x8<S>,
    height: f32x8<S>,
    low_end: f32x8<S>,
    high_end: f32x8<S>,
    slack: f32x8<S>,
}

/// The corners of a triangle, or of eight.
#[derive(Clone, Copy)]
struct Corners<S: Simd> {
    starts: [Vec3x8<S>; 3],
    ends: [Vec3x8<S>; 3],
    slack: [f32x8<S>; 3],
}

/// Which corners and edges of triangles may come near to planes, and whether the triangles are on both sides.
struct NearPlane {
    corners: [LaneBits; 3],
    edges: [LaneBits; 3],
    any: LaneBits,
    crossed: LaneBits,
}

impl<S: Simd> Planes<S> {
    /// Along a direction that stays, the distance between points that go straight on is least where they start or end.
    #[inline(always)]
    fn near(&self, simd: S, corners: &Corners<S>, distance: f32, edge_distance: f32) -> NearPlane {
        let (distance, edge_distance) = (f32x8::splat(simd, distance), f32x8::splat(simd, edge_distance));
        let zero = f32x8::splat(simd, 0.0);
        let mut above = [0; 3];
        let mut below = [0; 3];
        let mut edge_above = [0; 3];
        let mut edge_below = [0; 3];
        let mut positive = [0; 3];
        for k in 0..3 {
            let start = self.normal.dot(corners.starts[k]) - self.height;
            let end = self.normal.dot(corners.ends[k]);
            let slack = self.slack + corners.slack[k];
            let up = start.min(end - self.high_end) - slack;
            let down = zero - start.max(end - self.low_end) - slack;
            above[k] = up.simd_gt(distance).to_bitmask() as LaneBits;
            below[k] = down.simd_gt(distance).to_bitmask() as LaneBits;
            edge_above[k] = up.simd_gt(edge_distance).to_bitmask() as LaneBits;
            edge_below[k] = down.simd_gt(edge_distance).to_bitmask() as LaneBits;
            positive[k] = start.simd_gt(zero).to_bitmask() as LaneBits;
        }
        let all = |bits: [LaneBits; 3]| bits[0] & bits[1] & bits[2];
        NearPlane {
            corners: core::array::from_fn(|k| !(above[k] | below[k])),
            edges: core::array::from_fn(|k| {
                let next = (k + 1) % 3;
                !(edge_above[k] & edge_above[next] | edge_below[k] & edge_below[next])
            }),
            any: !(all(above) | all(below)),
            crossed: !(all(positive) | all(positive.map(|bits| !bits))),
        }
    }
}

/// One of a block's points, eight times.
#[inline(always)]
fn splat_point<S: Simd>(simd: S, block: &Block, l: usize) -> Vec3x8<S> {
    Vec3x8 {
        x: f32x8::splat(simd, block[0][l]),
        y: f32x8::splat(simd, block[1][l]),
        z: f32x8::splat(simd, block[2][l]),
    }
}

#[inline(always)]
fn near_features<S: Simd>(
    simd: S,
    a: &TrianglePack,
    b: &TrianglePack,
    [distance, edge_distance]: [f32; 2],
    all: &mut [FeatureBits; LANES],
) {
    let (low, high) = (Vec3x8::load(simd, &b.low), Vec3x8::load(simd, &b.high));
    for (l, bits) in all.iter_mut().enumerate().take(a.count) {
        let own_low = splat_point(simd, &a.low, l);
        let own_high = splat_point(simd, &a.high, l);
        let meet = low.x.simd_le(own_high.x)
            & low.y.simd_le(own_high.y)
            & low.z.simd_le(own_high.z)
            & own_low.x.simd_le(high.x)
            & own_low.y.simd_le(high.y)
            & own_low.z.simd_le(high.z);
        let meet = meet.to_bitmask() as LaneBits;
        if meet == 0 {
            continue;
        }
        let plane = Planes {
            normal: splat_point(simd, &a.normal, l),
            height: f32x8::splat(simd, a.height[l]),
            low_end: f32x8::splat(simd, a.low_end[l]),
            high_end: f32x8::splat(simd, a.high_end[l]),
            slack: f32x8::splat(simd, a.plane_slack[l]),
        };
        let [p, q, r] = &b.starts;
        let [u, v, w] = &b.ends;
        let others = Corners {
            starts: [Vec3x8::load(simd, p), Vec3x8::load(simd, q), Vec3x8::load(simd, r)],
            ends: [Vec3x8::load(simd, u), Vec3x8::load(simd, v), Vec3x8::load(simd, w)],
            slack: [lane(simd, &b.slack[0]), lane(simd, &b.slack[1]), lane(simd, &b.slack[2])],
        };
        let of_others = plane.near(simd, &others, distance, edge_distance);
        if meet & of_others.any == 0 {
            continue;
        }
        let planes = Planes {
            normal: Vec3x8::load(simd, &b.normal),
            height: lane(simd, &b.height),
            low_end: lane(simd, &b.low_end),
            high_end: lane(simd, &b.high_end),
            slack: lane(simd, &b.plane_slack),
        };
        let [p, q, r] = &a.starts;
        let [u, v, w] = &a.ends;
        let own = Corners {
            starts: [splat_point(simd, p, l), splat_point(simd, q, l), splat_point(simd, r, l)],
            ends: [splat_point(simd, u, l), splat_point(simd, v, l), splat_point(simd, w, l)],
            slack: [
                f32x8::splat(simd, a.slack[0][l]),
                f32x8::splat(simd, a.slack[1][l]),
                f32x8::splat(simd, a.slack[2][l]),
            ],
        };
        let of_own = planes.near(simd, &own, distance, edge_distance);
        let near = meet & of_others.any & of_own.any;
        let is_owned = |owned: LaneBits| if owned >> l & 1 == 1 { LaneBits::MAX } else { 0 };
        let any_edge = |edges: [LaneBits; 3]| edges[0] | edges[1] | edges[2];
        let other_edges: [LaneBits; 3] = core::array::from_fn(|k| of_others.edges[k] & b.owned_edges[k] & near);
        let edges: [LaneBits; 3] = core::array::from_fn(|k| of_own.edges[k] & is_owned(a.owned_edges[k]) & near);
        let both = any_edge(edges) & any_edge(other_edges);
        *bits = FeatureBits {
            corners: core::array::from_fn(|k| of_own.corners[k] & is_owned(a.owned_corners[k]) & near),
            edges: edges.map(|edges| edges & both),
            other_corners: core::array::from_fn(|k| of_others.corners[k] & b.owned_corners[k] & near),
            other_edges: other_edges.map(|edges| edges & both),
            pierced: near & of_others.crossed & of_own.crossed,
        };
    }
}
