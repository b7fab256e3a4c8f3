//! The search for pairs of a cloth and one obstacle.

use core::ops::Range;

use bevy_math::{Isometry3d, Vec3A};

use crate::{
    contact::feature::{
        ClothInStep,
        narrow_phase::{self, Candidate, ContactSide, Displacements, QueryMargin},
        obstacle_geometry::{DeformedMesh, ObstacleGeometry},
        pair::{FeatureContact, Features},
        sharp_feature_cache::{SharpFeatureCache, distance_to, tightness},
        sink,
        triangle_pack::FeatureMask,
    },
    geometry::{
        bvh::{
            bounds::{Bounds, BvhBounds},
            traversal::Traversal,
        },
        inside,
    },
    input::StepContext,
    shape::{MeshShape, Shape, Solid, sharp_features::SharpFeatures},
};

/// A cloth on its way.
pub(crate) struct ClothMotion<'a, C> {
    pub cloth: &'a C,
    /// Its number among those that are stepped together.
    pub number: usize,
    /// Number of its first particle, and of all particles.
    pub first: u32,
    pub total: usize,
    pub ways: Displacements<'a>,
    /// By how much particles may come off their ways, m.
    pub slack: f32,
    /// The part of the step that the search is for.
    pub span: Range<f32>,
    /// Duration of the step, s.
    pub dt: f32,
}

impl<C: ClothInStep> ClothMotion<'_, C> {
    /// Poses of obstacle `i` now, and when the search ends.
    fn poses(&self, i: usize) -> [Isometry3d; 2] {
        self.cloth.bodies().poses_ahead(self.cloth.ctx(), i, self.span.clone(), self.dt)
    }

    /// By how much the cloth and obstacle `i` may come off their ways together, m.
    fn slack(&self, i: usize) -> f32 {
        if self.cloth.ctx().obstacles[i].body.is_some() { 2.0 * self.slack } else { self.slack }
    }
}

/// A point of an obstacle.
#[derive(Clone, Copy, Debug)]
pub struct ObstaclePoint {
    /// Number of the cloth, and of the obstacle among those of that cloth.
    pub cloth: u32,
    pub obstacle: u32,
    pub point: u32,
}

/// What it takes to search at one obstacle after the other.
#[derive(Clone, Debug, Default)]
pub struct ObstacleSearch {
    /// The cloth in the obstacle's frame.
    position: Vec<Vec3A>,
    way: Vec<Vec3A>,
    places: BvhBounds,
    leaves: Vec<(u32, u32)>,
    found: Vec<Candidate>,
    /// Whether each particle is inside of a closed mesh, of those that it matters of.
    is_inside: Vec<Option<bool>>,
    /// Number of each of the obstacle's points among all.
    number: Vec<u32>,
    deformed: DeformedMesh,
    /// Sharp corners and the triangles of the cloth that they have come through.
    pierced: Vec<(u32, usize)>,
    outlines: SharpFeatureCache,
}

impl ObstacleSearch {
    /// Whether triangles and edges of a cloth, number `number` of those that are stepped together, may meet anything that its
    /// particles don't.
    pub fn is_needed(&mut self, number: usize, cloth: &impl ClothInStep) -> bool {
        let mut is_needed = false;
        for (i, obstacle) in cloth.ctx().obstacles.iter().enumerate() {
            is_needed |= match &obstacle.shape {
                Shape::Solid(solid) => {
                    let tightness = tightness(obstacle, cloth.longest_edge(), cloth.ctx());
                    !self.outlines.draw(number, i, solid, tightness).points.is_empty()
                }
                Shape::Mesh(MeshShape { mesh, .. }) => mesh.surface.has_sharper_than(sharpness(cloth)),
            };
        }
        is_needed
    }

    /// The outline that a point is of.
    pub fn outline(&self, fixed: &ObstaclePoint) -> &SharpFeatures {
        self.outlines.of(fixed.cloth as usize, fixed.obstacle as usize)
    }

    /// Adds the pairs of features of a cloth and of obstacle `i` of it that may touch.
    pub fn search(
        &mut self,
        at: &ClothMotion<impl ClothInStep>,
        i: usize,
        traversal: &mut Traversal,
        (fixed, pairs): (&mut Vec<ObstaclePoint>, &mut Vec<FeatureContact>),
    ) {
        let (cloth, obstacle) = (at.cloth, &at.cloth.ctx().obstacles[i]);
        let surface = cloth.surface();
        let distance = distance_to(obstacle, cloth.ctx());
        let Self { position, way, places, leaves, found, is_inside, number, deformed, outlines, pierced } = self;
        let Some(target) = ObstacleGeometry::of(obstacle, &at.span, deformed, || outlines.of(at.number, i)) else {
            return;
        };
        // In the obstacle's own frame it stays, and the cloth's way is that past it.
        let (poses, slack) = (at.poses(i), at.slack(i));
        let reached = distance + slack;
        let bounds = to_frame(at, poses, position, way).grown(reached);
        if !bounds.meets(&target.places.whole()) {
            return;
        }
        let ways = Displacements { position, way, slack: &[] };
        places.follow(surface, |triangle| ways.bounds(triangle).grown(reached), None::<fn(_) -> _>);
        let a = ContactSide {
            surface,
            places,
            margin: reached,
            ways,
            first: at.first,
            sharper_than: 0.0,
            has_faces: true,
            radii: &[],
        };
        let b = ContactSide {
            surface: target.surface,
            places: target.places,
            margin: 0.0,
            ways: Displacements { position: target.points, way: target.way.unwrap_or(&[]), slack: &[] },
            first: 0,
            sharper_than: if target.is_of_mesh { sharpness(cloth) } else { 0.0 },
            has_faces: false,
            radii: target.radii,
        };
        let friction = cloth.ctx().material.friction * obstacle.friction;
        let reach =
            QueryMargin { distance, edge_distance: distance, slack, goes_straight: false, friction, rest: None };
        found.clear();
        find_at_edges(&a, &b, &reach, (traversal, leaves), found, pierced);
        is_inside.clear();
        is_inside.resize(if target.is_closed { position.len() } else { 0 }, None);
        let mut is_inside = |particle: u32| {
            let Some(known) = is_inside.get_mut(particle as usize) else { return false };
            let place = position[particle as usize];
            *known.get_or_insert_with(|| inside::is_inside(place, target.surface, target.places, target.points))
        };
        number.clear();
        number.resize(target.points.len(), u32::MAX);
        let mut numbered = |point: u32| {
            let number = &mut number[point as usize];
            if *number == u32::MAX {
                *number = (at.total + fixed.len()) as u32;
                fixed.push(ObstaclePoint { cloth: at.number as u32, obstacle: i as u32, point });
            }
            *number
        };
        for one in &*found {
            let mut pair = one.pair;
            if let Shape::Solid(solid) = &obstacle.shape
                && !pierced.contains(&(pair.points[0], one.face))
            {
                let depth = depth_of(one, solid, position, at.first);
                if depth > 2.0 * sink(cloth.ctx()) + thickness(&pair, target.radii, position, at.first) {
                    // Its particles find the way out.
                    continue;
                }
                if depth > 0.0 && is_pressed_over(one, target.radii, cloth.ctx()) {
                    // It belongs on the other side.
                    (pair.normal, pair.gap) = (-pair.normal, -pair.gap);
                }
            }
            // The cloth's features come first but where a corner of the obstacle meets a face.
            let of_obstacle = if pair.features == Features::PointFace { 0..1 } else { 2..4 };
            let of_cloth = (0..4).filter(|k| !of_obstacle.contains(k));
            if of_cloth.into_iter().any(|k| is_inside(pair.points[k] - at.first)) {
                // It is on its way out.
                continue;
            }
            for k in of_obstacle {
                pair.points[k] = numbered(pair.points[k]);
            }
            pair.normal = poses[0].rotation * pair.normal;
            pairs.push(pair);
        }
    }
}

/// How sharp corners and edges of a mesh have to be that the triangles of a cloth sink in too deep at them.
fn sharpness(cloth: &impl ClothInStep) -> f32 {
    2.0 * sink(cloth.ctx()) / cloth.surface().longest_edge
}

/// Takes the cloth's ways into the obstacle's frame, and returns the box around them.
fn to_frame(
    at: &ClothMotion<impl ClothInStep>,
    poses: [Isometry3d; 2],
    position: &mut Vec<Vec3A>,
    way: &mut Vec<Vec3A>,
) -> Bounds {
    let [now, end] = poses.map(|pose| pose.inverse());
    position.clear();
    way.clear();
    let mut bounds = Bounds::NOTHING;
    for (&start, &far) in at.ways.position.iter().zip(at.ways.way) {
        let start = start - at.cloth.offset();
        let (from, to) = (now.transform_point(start), end.transform_point(start + far));
        position.push(from);
        way.push(to - from);
        bounds = bounds.union(Bounds { low: from.min(to), high: from.max(to) });
    }
    bounds
}

/// Finds pairs of the cloth's faces and edges with what is sharp.
fn find_at_edges(
    a: &ContactSide,
    b: &ContactSide,
    reach: &QueryMargin,
    (traversal, leaves): (&mut Traversal, &mut Vec<(u32, u32)>),
    found: &mut Vec<Candidate>,
    pierced: &mut Vec<(u32, usize)>,
) {
    leaves.clear();
    pierced.clear();
    traversal.between_sharp((a.surface, a.places), (b.surface, b.places), b.sharper_than, |p, q| leaves.push((p, q)));
    for &(p, q) in &*leaves {
        for s in a.surface.of_leaf(p) {
            for t in b.surface.of_leaf(q) {
                if a.places.of_triangles[s].meets(&b.places.of_triangles[t]) {
                    narrow_phase::pairs_between((a, s), (b, t), FeatureMask::ALL, reach, |one| found.push(one));
                    pierced.extend(narrow_phase::tips_through((a, s), (b, t)).map(|tip| (tip, s)));
                }
            }
        }
    }
    if pierced.is_empty() {
        return;
    }
    // Those are to go back.
    pierced.sort_unstable();
    pierced.dedup();
    found.retain(|one| one.is_first_of_a || !pierced.contains(&(one.pair.points[0], one.face)));
    found.extend(pierced.iter().map(|&(tip, face)| narrow_phase::back_through((a, face), (b, tip), reach)));
}

/// Radius (m) of an obstacle's feature that fits through a cell of the cloth, stretched as this is: no particle is in its way,
/// and triangles alone catch it, however deep they are in it. Zero of what doesn't fit.
fn thickness(pair: &FeatureContact, radii: &[f32], position: &[Vec3A], first: u32) -> f32 {
    let [a, b, c, d] = pair.points;
    let radius = |point: u32| radii.get(point as usize).copied().unwrap_or(0.0);
    let place = |point: u32| position[(point - first) as usize];
    let (radius, [p, q, r]) = match pair.features {
        Features::PointFace => (radius(a), [b, c, d].map(place)),
        Features::EdgeEdge => (radius(c).max(radius(d)), [a, b, b].map(place)),
    };
    let longest = p.distance_squared(q).max(q.distance_squared(r)).max(r.distance_squared(p));
    if 4.0 * radius * radius < longest { radius } else { 0.0 }
}

/// Whether the cloth of a pair that is inside of a solid has come over the solid's edge there, or onto its corner, because obstacles
/// close on each other: the last one that particles are pushed out of has its way, and presses them into the others.
///
/// Where all obstacles stay, nothing is pressed in: what is inside has been so from the start, and its particles find the way out.
fn is_pressed_over(found: &Candidate, radii: &[f32], ctx: &StepContext) -> bool {
    let Candidate { pair, nearest, .. } = found;
    let of_obstacle = if pair.features == Features::PointFace { 0..1 } else { 2..4 };
    let is_sharp =
        of_obstacle.into_iter().all(|k| radii.get(pair.points[k] as usize).is_none_or(|&radius| radius == 0.0));
    // Where the nearest place is at an end, the cloth ends there, and comes over nothing.
    let crosses = nearest.weights.iter().all(|weight| weight.abs() > CROSSING);
    let is_near = pair.gap < pair.distance + sink(ctx);
    let moves = || ctx.obstacles.iter().any(|other| other.start != other.end || other.body.is_some());
    is_sharp && crosses && is_near && moves()
}

/// The least weight of each of two features' points, in the place where they are nearest, of features that cross there.
const CROSSING: f32 = 1e-3;

/// How deep the cloth's place of a pair is inside of a solid, m.
fn depth_of(found: &Candidate, solid: &Solid, position: &[Vec3A], first: u32) -> f32 {
    let Candidate { pair, nearest, is_first_of_a, .. } = found;
    let of_cloth = if *is_first_of_a { 1.0 } else { -1.0 };
    let weights = nearest.weights.map(|weight| (weight * of_cloth).max(0.0));
    let places = pair.points.into_iter().zip(weights).filter(|&(_, weight)| weight > 0.0);
    let place = places.map(|(point, weight)| position[(point - first) as usize] * weight).sum();
    -solid.surface(place).distance
}
