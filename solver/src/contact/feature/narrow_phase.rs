//! Finds the pairs of features that may touch before the next search.

use bevy_math::{Vec3, Vec3A};

use crate::{
    contact::feature::{
        pair::{ClosestPoints, FeatureContact, Features},
        triangle_pack::FeatureMask,
    },
    geometry::{
        bvh::{
            TriangleBvh,
            bounds::{Bounds, BvhBounds},
            edges_of,
        },
        intersection::pierces,
    },
};

/// Where points are when a search is made, and where they go.
#[derive(Clone, Copy, Debug)]
pub struct Displacements<'a> {
    /// Where they are, m.
    pub position: &'a [Vec3A],
    /// How far they will come before the next search if nothing stops them, m. None for what stays.
    pub way: &'a [Vec3A],
    /// By how much they may come off that, m. None for what stays on it.
    pub slack: &'a [f32],
}

impl Displacements<'_> {
    /// How far a point will come.
    #[inline]
    pub fn way(&self, point: usize) -> Vec3A {
        self.way.get(point).copied().unwrap_or(Vec3A::ZERO)
    }

    /// By how much a point may come off its way.
    #[inline]
    pub fn slack(&self, point: usize) -> f32 {
        self.slack.get(point).copied().unwrap_or(0.0)
    }

    /// Box around the way of a triangle.
    #[inline]
    pub fn bounds(&self, triangle: [u32; 3]) -> Bounds {
        let [a, b, c] = triangle.map(|i| {
            let (start, way, slack) = (self.position[i as usize], self.way(i as usize), self.slack(i as usize));
            Bounds { low: start.min(start + way), high: start.max(start + way) }.grown(slack)
        });
        a.union(b).union(c)
    }
}

/// One of two surfaces that may touch.
#[derive(Clone, Copy, Debug)]
pub struct ContactSide<'a> {
    pub surface: &'a TriangleBvh,
    /// Boxes around the ways of triangles, with the margin.
    pub places: &'a BvhBounds,
    /// By how much its boxes are larger than what is in them, m.
    pub margin: f32,
    pub ways: Displacements<'a>,
    /// Number of the first of its points among all.
    pub first: u32,
    /// How sharp a corner or edge has to be that the other side may be caught on.
    pub sharper_than: f32,
    /// Whether its faces are met, and not its corners and edges alone.
    pub has_faces: bool,
    /// Distance in m that each point has around it, if any has.
    pub radii: &'a [f32],
}

impl ContactSide<'_> {
    #[inline]
    fn place(&self, point: u32) -> Vec3A {
        self.ways.position[point as usize]
    }

    #[inline]
    fn way(&self, point: u32) -> Vec3A {
        self.ways.way(point as usize)
    }

    /// Box around the way of a point, as thick as it is, with the margin of this side.
    #[inline]
    fn way_of(&self, point: u32) -> Bounds {
        let (start, way) = (self.place(point), self.way(point));
        Bounds { low: start.min(start + way), high: start.max(start + way) }
            .grown(self.radius(point) + self.ways.slack(point as usize) + self.margin)
    }

    #[inline]
    fn radius(&self, point: u32) -> f32 {
        self.radii.get(point as usize).copied().unwrap_or(0.0)
    }
}

/// Distances of a search.
#[derive(Clone, Copy, Debug)]
pub struct QueryMargin<'a> {
    /// Distance that features are to keep, m.
    pub distance: f32,
    /// The same of edges from edges.
    pub edge_distance: f32,
    /// By how much features may come off their ways towards each other before the next search, m, beyond the slack of their points.
    pub slack: f32,
    /// Whether features are taken to go straight on along their ways, within their slack. Else they may use the length of their ways in
    /// any direction.
    pub goes_straight: bool,
    /// Friction between the features, no unit.
    pub friction: f32,
    /// Where the points of a surface that may touch itself are at rest, m. What is nearer at rest than the distance may be
    /// so.
    pub rest: Option<&'a [Vec3]>,
}

/// Share of a rest distance that features of one cloth keep at most: they aren't to push each other at rest.
const AT_REST: f32 = 0.9;

/// A pair that has been found.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    pub pair: FeatureContact,
    /// Which sides the first and the second feature are of.
    pub is_first_of_a: bool,
    /// Triangle of the second feature, of a point and a face.
    pub face: usize,
    /// How far apart the features are, and where.
    pub nearest: ClosestPoints,
}

/// Shows the pairs of features of triangle `s` of `a` and triangle `t` of `b` that may touch, of those in the `mask`.
pub fn pairs_between(
    (a, s): (&ContactSide, usize),
    (b, t): (&ContactSide, usize),
    mask: FeatureMask,
    reach: &QueryMargin,
    mut found: impl FnMut(Candidate),
) {
    let (triangle, other) = (a.surface.triangles[s], b.surface.triangles[t]);
    let (mine, theirs) = (&a.surface.owned[s], &b.surface.owned[t]);
    let is_same = reach.rest.is_some();
    if is_same && triangle.iter().any(|corner| other.contains(corner)) && is_open(a, triangle, other) {
        return;
    }
    // Boxes tell most features apart, at a fraction of the price of their distance.
    let (face, other_face) = (&a.places.of_triangles[s], &b.places.of_triangles[t]);
    let is_set = |bits: u8, k: usize| bits >> k & 1 == 1;
    for (k, &corner) in triangle.iter().enumerate().filter(|_| b.has_faces) {
        let is_met = is_set(mask.corners, k) && mine.corners[k] > a.sharper_than && a.way_of(corner).meets(other_face);
        if is_met && !(is_same && other.contains(&corner)) {
            let points = [corner, other[0], other[1], other[2]];
            found_between(Features::PointFace, [a, b, b, b], points, reach, |f| found(Candidate { face: t, ..f }));
        }
    }
    for (k, &corner) in other.iter().enumerate().filter(|_| a.has_faces) {
        let is_met =
            is_set(mask.other_corners, k) && theirs.corners[k] > b.sharper_than && b.way_of(corner).meets(face);
        if is_met && !(is_same && triangle.contains(&corner)) {
            let points = [corner, triangle[0], triangle[1], triangle[2]];
            let first = |f| found(Candidate { is_first_of_a: false, face: s, ..f });
            found_between(Features::PointFace, [b, a, a, a], points, reach, first);
        }
    }
    if mask.edges == 0 || mask.other_edges == 0 {
        return;
    }
    for (i, [p, q]) in edges_of(triangle).into_iter().enumerate() {
        if !is_set(mask.edges, i) || mine.edges[i] <= a.sharper_than {
            continue;
        }
        let edge = a.way_of(p).union(a.way_of(q));
        for (k, [u, v]) in edges_of(other).into_iter().enumerate() {
            let is_met = is_set(mask.other_edges, k)
                && theirs.edges[k] > b.sharper_than
                && edge.meets(&b.way_of(u).union(b.way_of(v)));
            if is_met && !(is_same && (p == u || p == v || q == u || q == v)) {
                found_between(Features::EdgeEdge, [a, a, b, b], [p, q, u, v], reach, &mut found);
            }
        }
    }
}

/// Corners of triangle `t` of `b` that have come through triangle `s` of `a`: a sharp edge pierces it, and that end of it is
/// the nearer one to go back.
pub fn tips_through((a, s): (&ContactSide, usize), (b, t): (&ContactSide, usize)) -> impl Iterator<Item = u32> {
    let triangle = a.surface.triangles[s].map(|i| a.place(i));
    // What is farther through than the cloth's own edges are long has come to stay.
    let farthest = a.surface.longest_edge;
    let edges = edges_of(b.surface.triangles[t]).into_iter().zip(b.surface.owned[t].edges);
    edges.filter(|&(_, sharpness)| sharpness > b.sharper_than).filter_map(move |([p, q], _)| {
        let (from, to) = (b.place(p), b.place(q));
        let share = pierces([from, to], triangle)?;
        let (tip, beyond) = if share < 0.5 { (p, share) } else { (q, 1.0 - share) };
        (beyond * from.distance(to) <= farthest).then_some(tip)
    })
}

/// The pair of a corner of `b` that has come through triangle `s` of `a`, and is to go back.
pub fn back_through((a, s): (&ContactSide, usize), (b, tip): (&ContactSide, u32), reach: &QueryMargin) -> Candidate {
    let triangle = a.surface.triangles[s];
    let [u, v, w] = triangle.map(|i| a.place(i));
    let nearest = Features::PointFace.nearest([b.place(tip), u, v, w]);
    let (direction, length) = nearest.between.normalize_and_length();
    let normal = if length > 0.0 { -direction } else { (v - u).cross(w - u).normalize_or(Vec3A::Y) };
    let [p, q, r] = triangle.map(|i| a.first + i);
    let pair = FeatureContact {
        features: Features::PointFace,
        points: [b.first + tip, p, q, r],
        distance: reach.distance + b.radius(tip),
        taper: 0.0,
        friction: reach.friction,
        gap: -length,
        normal,
        gap_before: 0.0,
        load: 0.0,
        is_solved_by_cloth: false,
    };
    Candidate { pair, is_first_of_a: false, face: s, nearest }
}

/// Cosine of the angle between triangles that share a corner from which on they are near to folding up.
const OPEN: f32 = 0.3;

/// Whether two triangles of a surface that share a corner are far from folding up onto each other.
fn is_open(side: &ContactSide, triangle: [u32; 3], other: [u32; 3]) -> bool {
    let normal = |triangle: [u32; 3]| {
        let [a, b, c] = triangle.map(|i| side.ways.position[i as usize]);
        (b - a).cross(c - a)
    };
    let (n, m) = (normal(triangle), normal(other));
    n.dot(m) > OPEN * (n.length_squared() * m.length_squared()).sqrt()
}

/// `distance` (m), or what features of one cloth may keep of it that are nearer to each other at rest.
#[inline]
fn distance_at_rest(features: Features, points: [u32; 4], rest: &[Vec3], distance: f32, side: &ContactSide) -> f32 {
    let [a, b, c, d] = points;
    let [a, b, c, d] = [rest[a as usize], rest[b as usize], rest[c as usize], rest[d as usize]];
    // Mostly they are far apart in the cloth: no two places of theirs are nearer than that.
    let far = distance / AT_REST + 2.0 * side.surface.longest_edge;
    if a.distance_squared(c) > far * far {
        return distance;
    }
    let nearest = features.nearest([a, b, c, d].map(Vec3A::from));
    distance.min(AT_REST * nearest.between.length())
}

/// Shows a pair of features if it may touch.
#[inline]
fn found_between(
    features: Features,
    sides: [&ContactSide; 4],
    points: [u32; 4],
    reach: &QueryMargin,
    found: impl FnOnce(Candidate),
) {
    let ([s0, s1, s2, s3], [p0, p1, p2, p3]) = (sides, points);
    let places = [s0.place(p0), s1.place(p1), s2.place(p2), s3.place(p3)];
    let [w0, w1, w2, w3] = [s0.way(p0), s1.way(p1), s2.way(p2), s3.way(p3)];
    let (distance, taper) = match features {
        Features::PointFace => (reach.distance + sides[0].radius(points[0]), 0.0),
        Features::EdgeEdge => {
            let near = sides[2].radius(points[2]);
            (reach.edge_distance + near, sides[3].radius(points[3]) - near)
        }
    };
    let apart = |p: Vec3A, q: Vec3A| p.distance_squared(q);
    let approach = match features {
        Features::PointFace => apart(w0, w1).max(apart(w0, w2)).max(apart(w0, w3)),
        Features::EdgeEdge => apart(w0, w2).max(apart(w0, w3)).max(apart(w1, w2)).max(apart(w1, w3)),
    };
    let slack_of = |side: &ContactSide, point: u32| side.ways.slack(point as usize);
    let [l0, l1, l2, l3] = [slack_of(s0, p0), slack_of(s1, p1), slack_of(s2, p2), slack_of(s3, p3)];
    let of_points = match features {
        Features::PointFace => l0 + l1.max(l2).max(l3),
        Features::EdgeEdge => l0.max(l1) + l2.max(l3),
    };
    let slack = reach.slack + of_points;
    let approach = approach.sqrt() + slack;
    let nearest = features.nearest(places);
    let farthest = distance + taper.max(0.0) + approach;
    let squared = nearest.between.length_squared();
    if squared > farthest * farthest {
        return;
    }
    let margin = distance + taper.max(0.0) + slack;
    if reach.goes_straight && squared > margin * margin {
        // Along a direction that stays, the distance between points that go straight on is least where they start or end.
        let direction = nearest.between / squared.sqrt();
        let [a, b, c, d] = [places[0] + w0, places[1] + w1, places[2] + w2, places[3] + w3].map(|p| direction.dot(p));
        let gap = match features {
            Features::PointFace => a - b.max(c).max(d),
            Features::EdgeEdge => a.min(b) - c.max(d),
        };
        if gap > margin {
            return;
        }
    }
    let distance = reach.rest.map_or(distance, |rest| distance_at_rest(features, points, rest, distance, sides[0]));
    let (direction, length) = nearest.between.normalize_and_length();
    let normal = if length > 0.0 { direction } else { Vec3A::Y };
    let points = [s0.first + p0, s1.first + p1, s2.first + p2, s3.first + p3];
    let pair = FeatureContact {
        features,
        points,
        distance,
        taper,
        friction: reach.friction,
        gap: length,
        normal,
        gap_before: 0.0,
        load: 0.0,
        is_solved_by_cloth: false,
    };
    found(Candidate { pair, is_first_of_a: true, face: 0, nearest });
}

#[cfg(test)]
mod tests;
