//! Which faces the particles of a block may come to meet.

use bevy_math::{Isometry3d, Vec3A};
use fearless_simd::prelude::*;

use crate::{
    contact::mesh::{BlockCache, MeshDistanceQuery, lane_of, set_lane},
    geometry::{
        bvh::{
            TriangleBvh,
            bounds::{Bounds, BvhBounds},
        },
        closest_point, inside,
    },
    layout::simd::{LANES, Lane, Vec3x8},
    particles::lanes::Run,
    shape::TriangleMesh,
};

/// By how much particles may come off their ways before their block looks anew, m: this much, and a share of their ways. The
/// less, the fewer faces they have to keep an eye on.
const SLACK: f32 = 0.0005;
const SLACK_OF_WAY: f32 = 0.25;

/// Share of the fall that is taken to happen: nobody knows what is held up.
const FALL: f32 = 0.5;

/// How far blocks look ahead at most, in lengths of the mesh's edges: the farther, the more they see that never comes near.
const EDGES_AHEAD: f32 = 1.0;

/// How far around what has no faces it is looked that there are none, in sizes of the region that a particle stays in: what is
/// beside it is then known too.
const CLEAR: f32 = 32.0;

/// Width of the grid that regions are rounded to, m: what rests stays in one region from step to step, and needs no new look.
const GRID: f32 = 0.002;

/// Added and taken away again, it leaves whole numbers: floats of this size have no room for more.
const WHOLE: f32 = (3 << 22) as f32;

/// By how much farther what has no faces is taken to be, m: its square is no number any more.
const FAR: f32 = 1e30;

/// Boxes around the ways of triangles whose points go from one place to another.
pub(crate) fn follow(places: &mut BvhBounds, surface: &TriangleBvh, from: &[Vec3A], to: &[Vec3A]) {
    let bounds =
        |triangle: [u32; 3]| Bounds::around(triangle.into_iter().flat_map(|i| [from[i as usize], to[i as usize]]));
    places.follow(surface, bounds, None::<fn(_) -> _>);
}

/// The region that a particle stays in, in the frame of the mesh, m.
#[derive(Clone, Copy, Debug, PartialEq)]
struct ParticleBounds {
    centre: Vec3A,
    radius: f32,
}

impl ParticleBounds {
    /// One of the grid that it lies in.
    fn rounded(self) -> Self {
        let centre = (self.centre / GRID + WHOLE - WHOLE) * GRID;
        let radius = (self.radius + self.centre.distance(centre)) / GRID + 0.5;
        Self { centre, radius: (radius + WHOLE - WHOLE) * GRID }
    }
}

/// What a block has looked for: the regions of those of its particles that are free, and how far around them, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CacheKey {
    regions: [Option<ParticleBounds>; LANES],
    distance: f32,
}

/// A ball that no face comes into, in the frame of the mesh.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct EmptyBall {
    centre: Vec3A,
    /// m
    radius: f32,
    /// Whether it is inside of the mesh.
    is_inside: bool,
}

/// Boxes around the regions of all particles.
struct BlockBounds<S: Simd> {
    low: Vec3x8<S>,
    high: Vec3x8<S>,
}

impl<S: Simd> BlockBounds<S> {
    /// Which of them meet another box, a bit each.
    #[inline(always)]
    fn meet(&self, Bounds { low: from, high: to }: &Bounds) -> u64 {
        let Self { low, high } = self;
        let is_below = low.x.simd_le(to.x) & low.y.simd_le(to.y) & low.z.simd_le(to.z);
        let is_above = high.x.simd_ge(from.x) & high.y.simd_ge(from.y) & high.z.simd_ge(from.z);
        (is_below & is_above).to_bitmask()
    }
}

impl MeshDistanceQuery<'_> {
    /// Finds out which way the particles of the block are on, and what they may come to meet there.
    #[cold]
    #[inline(never)]
    pub(crate) fn look_around<S: Simd>(&mut self, simd: S, run: &Run) {
        let is_free = run.inverse_mass[self.block].map(|w| w > 0.0);
        let regions = self.expect(run, is_free);
        let sought = CacheKey { regions, distance: self.sweep.distance };
        let known = &mut self.blocks[self.block];
        let last = known.sought.replace(sought).filter(|last| !self.is_deformed && last.distance == sought.distance);
        let is_new: [bool; LANES] = core::array::from_fn(|i| last.is_none_or(|last| last.regions[i] != regions[i]));
        if is_new == [false; LANES] {
            return;
        }
        // What the others have found still holds.
        let mut new_regions = regions;
        for (i, (found, region)) in known.found.iter_mut().zip(&mut new_regions).enumerate() {
            if is_new[i] {
                found.clear();
            } else {
                *region = None;
            }
        }
        simd.vectorize(
            #[inline(always)]
            || self.find(simd, &new_regions),
        );
        self.find_inside(&new_regions);
        self.know();
        simd.vectorize(
            #[inline(always)]
            || self.survey(simd),
        );
    }

    /// Notes on which ways the particles are, and returns the regions of those that are free.
    fn expect(&mut self, run: &Run, is_free: [bool; LANES]) -> [Option<ParticleBounds>; LANES] {
        let (block, span, known) = (self.block, &self.span, &mut self.blocks[self.block]);
        let left = (1.0 - span.start) * self.dt;
        let [start, now, end] = [self.sweep.start, self.sweep.end, self.end].map(|pose: Isometry3d| pose.inverse());
        let fall = self.gravity * (0.5 * FALL * left * left);
        let mut longest: f32 = 0.0;
        for i in (0..LANES).filter(|&i| is_free[i]) {
            let before = lane_of(&run.previous[block], i);
            let from = start.transform_point(before);
            let to = end.transform_point(before + lane_of(&run.velocity[block], i) * left + fall);
            set_lane(&mut known.start, i, from);
            set_lane(&mut known.way, i, (to - from) / (1.0 - span.start));
            longest = longest.max(from.distance_squared(to));
        }
        let longest = longest.sqrt();
        let share = (EDGES_AHEAD * self.mesh.surface.mean_edge / longest.max(f32::MIN_POSITIVE)).min(1.0);
        let until = (span.start + share * (1.0 - span.start)).max(span.end);
        known.span = span.start..until;
        let over = until - span.start;
        known.slack = SLACK + (SLACK_OF_WAY * longest + FALL * fall.length()) * over / (1.0 - span.start);
        core::array::from_fn(|i| {
            is_free[i].then(|| {
                let (from, half) = (lane_of(&known.start, i), lane_of(&known.way, i) * (0.5 * over));
                let centre = from + half;
                let place = now.transform_point(lane_of(&run.position[block], i));
                ParticleBounds { centre, radius: half.length().max(place.distance(centre)) + known.slack }.rounded()
            })
        })
    }

    /// Finds the faces that come near to regions.
    #[inline(always)]
    fn find<S: Simd>(&mut self, simd: S, regions: &[Option<ParticleBounds>; LANES]) {
        let Self { mesh: TriangleMesh { surface, .. }, points: [points, now], places, blocks, .. } = self;
        let BlockCache { span: known, found, .. } = &mut blocks[self.block];
        let left = (known.end - known.start) / (self.span.end - self.span.start);
        // How far a face goes, of a mesh that moves within its frame.
        let is_deformed = self.is_deformed;
        let way_of = |face: usize| {
            let ways =
                surface.triangles[face].into_iter().map(|i| points[i as usize].distance_squared(now[i as usize]));
            if is_deformed { ways.fold(0.0, f32::max).sqrt() * left } else { 0.0 }
        };
        let mut farthest: f32 = 0.0;
        let distance = self.sweep.distance;
        let (mut low, mut high) = ([[f32::INFINITY; LANES]; 3], [[f32::NEG_INFINITY; LANES]; 3]);
        for (i, region) in regions.iter().enumerate() {
            if let Some(ParticleBounds { centre, radius }) = region {
                set_lane(&mut low, i, *centre - *radius - distance);
                set_lane(&mut high, i, *centre + *radius + distance);
            }
        }
        let boxes = BlockBounds { low: Vec3x8::load(simd, &low), high: Vec3x8::load(simd, &high) };
        surface.for_each_near(
            places,
            #[inline(always)]
            |bounds| boxes.meet(bounds) != 0,
            #[inline(always)]
            |face| {
                let mut lanes = boxes.meet(&places.of_triangles[face]);
                while lanes != 0 {
                    let i = lanes.trailing_zeros() as usize;
                    lanes &= lanes - 1;
                    let Some(ParticleBounds { centre, radius }) = regions[i] else { continue };
                    let corners = surface.triangles[face].map(|k| points[k as usize]);
                    let length = centre.distance(closest_point::place_on_triangle(centre, corners));
                    let way = way_of(face);
                    if length <= distance + radius + way {
                        farthest = farthest.max(way);
                        found[i].push((length, face as u32));
                    }
                }
            },
        );
        // What is so much farther than the nearest one never gets to be the nearest.
        for (found, region) in found.iter_mut().zip(regions) {
            let Some(ParticleBounds { radius, .. }) = region else { continue };
            let least = found.iter().map(|&(length, _)| length).fold(f32::INFINITY, f32::min);
            found.retain(|&(length, _)| length <= least + 2.0 * (radius + farthest));
        }
    }

    /// Finds the nearest face of particles that are deep inside of a closed mesh: those of a cloth that began there.
    fn find_inside(&mut self, regions: &[Option<ParticleBounds>; LANES]) {
        let Self { blocks, mesh, points: [points, _], places, .. } = self;
        if !mesh.is_closed {
            return;
        }
        let TriangleMesh { surface, .. } = mesh;
        let BlockCache { clear, found, .. } = &mut blocks[self.block];
        if self.is_deformed {
            *clear = [EmptyBall::default(); LANES];
        }
        for (i, (found, region)) in found.iter_mut().zip(regions).enumerate() {
            let Some(ParticleBounds { centre, radius }) = *region else { continue };
            if !found.is_empty() || !places.whole().meets(&Bounds::around([centre])) {
                continue;
            }
            let known = clear.iter().find(|clear| centre.distance(clear.centre) < clear.radius);
            clear[i] = known.copied().unwrap_or_else(|| {
                let farthest = CLEAR * (radius + self.sweep.distance);
                let nearest = inside::nearest(centre, farthest, surface, places, points);
                let is_inside = inside::is_inside(centre, surface, places, points);
                EmptyBall { centre, radius: nearest.map_or(farthest, |(_, length)| length), is_inside }
            });
            if clear[i].is_inside {
                let nearest = inside::nearest(centre, f32::INFINITY, surface, places, points);
                found.extend(nearest.map(|(face, length)| (length, face as u32)));
            }
        }
    }

    /// Keeps what has been found, side by side.
    fn know(&mut self) {
        let BlockCache { found, faces, beyond, .. } = &mut self.blocks[self.block];
        let most = found.iter().map(Vec::len).max().unwrap_or(0);
        *beyond = Lane::default();
        for (beyond, _) in beyond.iter_mut().zip(&*found).filter(|(_, found)| found.is_empty()) {
            *beyond = FAR;
        }
        faces.clear();
        faces.extend(
            (0..most)
                .map(|k| core::array::from_fn(|i| found[i].get(k).or(found[i].first()).map_or(0, |&(_, face)| face))),
        );
        self.follow();
    }
}
