//! What is found against all pairs of features that there are.

use fastrand::Rng;
use proptest::prelude::*;

use super::*;
use crate::{
    contact::feature::triangle_pack::TrianglePack, geometry::bvh::traversal::Traversal, layout::simd::SimdLevel,
};

/// A sheet of triangles on its way.
struct Sheet {
    rest: Vec<Vec3>,
    surface: TriangleBvh,
    places: BvhBounds,
    position: Vec<Vec3A>,
    way: Vec<Vec3A>,
    slack: Vec<f32>,
    radii: Vec<f32>,
    margin: f32,
}

const DISTANCE: f32 = 0.05;
const EDGE_DISTANCE: f32 = 0.03;
const SLACK: f32 = 0.01;

/// The largest slack of a point, m.
const POINT_SLACK: f32 = 0.02;

/// Points that the sides of a sheet have.
const SIDE: u32 = 5;

impl Sheet {
    /// Some `layers` of a square metre above each other, each facing up, at and around `height` (m).
    fn new(layers: u32, height: f32, radius: f32, rng: &mut Rng) -> Self {
        let count = SIDE * SIDE;
        let place = |i: u32| Vec3::new((i % SIDE) as f32, 0.0, (i / SIDE % SIDE) as f32) / (SIDE - 1) as f32;
        let rest: Vec<Vec3> = (0..layers * count).map(|i| place(i) + Vec3::Y * (i / count) as f32).collect();
        let cells = (0..layers * count).filter(|i| i % SIDE < SIDE - 1 && i / SIDE % SIDE < SIDE - 1);
        let triangles: Vec<[u32; 3]> =
            cells.flat_map(|i| [[i, i + SIDE, i + 1], [i + 1, i + SIDE, i + SIDE + 1]]).collect();
        let mut noise = |size: f32| (Vec3A::new(rng.f32(), rng.f32(), rng.f32()) - 0.5) * size;
        let position: Vec<Vec3A> = (0..layers * count)
            .map(|i| {
                let layer = (i / count) as f32;
                Vec3A::from(place(i)) + Vec3A::Y * (height + 0.1 * layer) + noise(0.1)
            })
            .collect();
        let way = position.iter().map(|_| noise(0.1)).collect();
        let radii =
            if radius > 0.0 { position.iter().map(|_| (noise(1.0).x + 0.5) * radius).collect() } else { Vec::new() };
        let slack = position.iter().map(|_| (noise(1.0).x + 0.5) * POINT_SLACK).collect();
        let surface = TriangleBvh::new(&rest, &triangles);
        let mut sheet = Self { rest, surface, places: BvhBounds::default(), position, way, slack, radii, margin: 0.0 };
        sheet.follow(0.5 * (DISTANCE + SLACK), radius);
        sheet
    }

    /// Puts boxes around where it is, and a margin around them.
    fn follow(&mut self, margin: f32, radius: f32) {
        let mut places = BvhBounds::default();
        let corners = |triangle: [u32; 3]| triangle.map(|i| self.position[i as usize]);
        let bounds = |triangle| self.side(0).ways.bounds(triangle).grown(margin + radius);
        places.follow(&self.surface, bounds, Some(corners));
        (self.places, self.margin) = (places, margin);
    }

    fn packs(&self) -> Vec<TrianglePack> {
        let (ways, bounds) = (self.side(0).ways, &self.places.of_triangles);
        self.surface.leaves().map(|leaf| TrianglePack::new(&self.surface, leaf, &ways, bounds)).collect()
    }

    fn side(&self, first: u32) -> ContactSide<'_> {
        ContactSide {
            surface: &self.surface,
            places: &self.places,
            margin: self.margin,
            ways: Displacements { position: &self.position, way: &self.way, slack: &self.slack },
            first,
            sharper_than: 0.0,
            has_faces: true,
            radii: &self.radii,
        }
    }

    fn count(&self) -> u32 {
        self.position.len() as u32
    }
}

/// All points on their ways.
struct All {
    position: Vec<Vec3A>,
    way: Vec<Vec3A>,
    slack: Vec<f32>,
    radii: Vec<f32>,
}

impl All {
    fn of(sheets: &[&Sheet]) -> Self {
        let radii = |sheet: &Sheet| {
            if sheet.radii.is_empty() { vec![0.0; sheet.position.len()] } else { sheet.radii.clone() }
        };
        Self {
            position: sheets.iter().flat_map(|sheet| sheet.position.clone()).collect(),
            way: sheets.iter().flat_map(|sheet| sheet.way.clone()).collect(),
            slack: sheets.iter().flat_map(|sheet| sheet.slack.clone()).collect(),
            radii: sheets.iter().flat_map(|sheet| radii(sheet)).collect(),
        }
    }

    /// How near two features may come to touching on their ways, at least, m, if their points use up their slack; and how far from it
    /// they begin.
    fn nearest(&self, features: Features, points: [u32; 4]) -> [f32; 2] {
        let radius = |i: usize| self.radii[points[i] as usize];
        let room = match features {
            Features::PointFace => radius(0),
            Features::EdgeEdge => radius(2).min(radius(3)),
        };
        let at = |share: f32| {
            let places = points.map(|i| self.position[i as usize] + self.way[i as usize] * share);
            let ClosestPoints { weights, between } = features.nearest(places);
            let slack: f32 = points.iter().zip(weights).map(|(&i, weight)| self.slack[i as usize] * weight.abs()).sum();
            [between.length() - room - slack, between.length() - room]
        };
        [(0..=10).map(|i| at(i as f32 / 10.0)[0]).fold(f32::INFINITY, f32::min), at(0.0)[1]]
    }
}

/// A name for a pair, whichever way around it is found.
fn name(features: Features, [a, b, c, d]: [u32; 4]) -> (u8, [u32; 4]) {
    let sorted = |mut points: [u32; 3]| {
        points.sort_unstable();
        points
    };
    match features {
        Features::PointFace => {
            let [b, c, d] = sorted([b, c, d]);
            (0, [a, b, c, d])
        }
        Features::EdgeEdge => {
            let [one, other] = [[a.min(b), a.max(b)], [c.min(d), c.max(d)]];
            let [[a, b], [c, d]] = if one < other { [one, other] } else { [other, one] };
            (1, [a, b, c, d])
        }
    }
}

/// All pairs of features of two sheets, whose points are numbered one after the other.
fn pairs(a: &Sheet, b: &Sheet) -> Vec<(Features, [u32; 4])> {
    let first = a.count();
    let faces = |sheet: &Sheet, first: u32| -> Vec<[u32; 3]> {
        sheet.surface.triangles.iter().map(|triangle| triangle.map(|i| i + first)).collect()
    };
    let (faces_a, faces_b) = (faces(a, 0), faces(b, first));
    let points_a = (0..first).flat_map(|point| faces_b.iter().map(move |&[p, q, r]| [point, p, q, r]));
    let points_b = (first..first + b.count()).flat_map(|point| faces_a.iter().map(move |&[p, q, r]| [point, p, q, r]));
    let edges_b: Vec<[u32; 2]> = b.surface.edges().map(|edge| edge.map(|i| i + first)).collect();
    let edges = a.surface.edges().flat_map(|[p, q]| edges_b.iter().map(move |&[u, v]| [p, q, u, v]));
    let points = points_a.chain(points_b).map(|points| (Features::PointFace, points));
    points.chain(edges.map(|points| (Features::EdgeEdge, points))).collect()
}

/// Distance that features keep.
fn kept(features: Features) -> f32 {
    if features == Features::EdgeEdge { EDGE_DISTANCE } else { DISTANCE }
}

fn reach(rest: Option<&[Vec3]>) -> QueryMargin<'_> {
    QueryMargin {
        distance: DISTANCE,
        edge_distance: EDGE_DISTANCE,
        slack: SLACK,
        goes_straight: true,
        friction: 0.3,
        rest,
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn all_features_that_may_touch_are_found_once(seed in any::<u64>(), height in 0.0_f32..0.3, radius in prop_oneof![Just(0.0_f32), 0.01_f32..0.1], is_wide in any::<bool>()) {
        let mut rng = Rng::with_seed(seed);
        let (a, b) = (Sheet::new(1, 0.0, 0.0, &mut rng), Sheet::new(1, height, radius, &mut rng));
        let (one, other) = (a.side(0), b.side(a.count()));
        let mut found = Vec::new();
        let mut leaves = Vec::new();
        Traversal::default().between((&a.surface, &a.places), (&b.surface, &b.places), |p, q| leaves.push((p, q)));
        let (packs, others) = (a.packs(), b.packs());
        let simd_level = if is_wide { SimdLevel::Best } else { SimdLevel::Baseline };
        for (p, q) in leaves {
            // With a radius, as an obstacle has, there are no packs.
            if radius > 0.0 {
                for (s, t) in a.surface.of_leaf(p).flat_map(|s| b.surface.of_leaf(q).map(move |t| (s, t))) {
                    pairs_between((&one, s), (&other, t), FeatureMask::ALL, &reach(None), |f| found.push(f.pair));
                }
                continue;
            }
            let (pack, other_pack) = (&packs[a.surface.leaf_number(p)], &others[b.surface.leaf_number(q)]);
            // Packs know nothing of slack that isn't of a point.
            let distances = [DISTANCE + SLACK, EDGE_DISTANCE + SLACK];
            pack.near(other_pack, distances, false, simd_level, |s, t, mask| {
                let (s, t) = (a.surface.of_leaf(p).start + s, b.surface.of_leaf(q).start + t);
                pairs_between((&one, s), (&other, t), mask, &reach(None), |f| found.push(f.pair));
            });
        }
        let all = All::of(&[&a, &b]);
        let mut names: Vec<_> = found.iter().map(|pair| name(pair.features, pair.points)).collect();
        names.sort_unstable();
        prop_assert!(names.is_sorted_by(|a, b| a < b), "a pair is found twice");
        for (features, points) in pairs(&a, &b) {
            let [nearest, start] = all.nearest(features, points);
            let is_found = names.binary_search(&name(features, points)).is_ok();
            let reached = kept(features) + SLACK;
            prop_assert!(is_found || nearest > reached - 1e-5, "{features:?} {points:?}: {nearest} m");
            // None goes farther on its way than 0.1 m along each axis.
            let farthest = reached + 2.0 * POINT_SLACK + 0.35 + radius;
            prop_assert!(!is_found || start < farthest, "{features:?} {points:?}: {start} m");
        }
        for pair in &found {
            let nearest = pair.features.nearest(pair.points.map(|i| all.position[i as usize])).between;
            prop_assert!((pair.gap - nearest.length()).abs() < 1e-6);
            prop_assert!(nearest.distance(pair.normal * pair.gap) < 1e-5, "{nearest} along {}", pair.normal);
            let radius = |i: usize| all.radii[pair.points[i] as usize];
            let [near, far] = if pair.features == Features::EdgeEdge { [radius(2), radius(3)] } else { [radius(0); 2] };
            let kept = kept(pair.features);
            prop_assert!((pair.distance - kept - near).abs() < 1e-6);
            prop_assert!((pair.distance + pair.taper - kept - far).abs() < 1e-6);
        }
    }

    #[test]
    fn what_of_one_cloth_may_touch_is_found_once_and_keeps_less_than_at_rest(seed in any::<u64>()) {
        let rng = &mut Rng::with_seed(seed);
        let mut sheet = Sheet::new(2, 0.0, 0.0, rng);
        // Crumpled, so that triangles with a common corner are looked at too.
        for place in &mut sheet.position {
            *place += (Vec3A::new(rng.f32(), rng.f32(), rng.f32()) - 0.5) * 0.5;
        }
        // So much that what is a cell apart has less.
        let kept = 0.3;
        sheet.follow(0.5 * (kept + SLACK), 0.0);
        let reach = QueryMargin { distance: kept, edge_distance: kept, ..reach(Some(&sheet.rest)) };
        let side = sheet.side(0);
        let mut found = Vec::new();
        let count = sheet.surface.triangles.len();
        for (s, t) in (0..count).flat_map(|s| (s + 1..count).map(move |t| (s, t))) {
            pairs_between((&side, s), (&side, t), FeatureMask::ALL, &reach, |f| found.push(f.pair));
        }
        let mut names: Vec<_> = found.iter().map(|pair| name(pair.features, pair.points)).collect();
        names.sort_unstable();
        prop_assert!(names.is_sorted_by(|a, b| a < b), "a pair is found twice");
        let all = All::of(&[&sheet]);
        let layer = |i: u32| i / (SIDE * SIDE);
        // Between the layers: within one, what shares corners is told apart by how it is folded.
        let points = (0..sheet.count()).flat_map(|point| sheet.surface.triangles.iter().map(move |&[p, q, r]| [point, p, q, r]));
        let edges: Vec<_> = sheet.surface.edges().collect();
        let edges = edges.iter().flat_map(|&[p, q]| edges.iter().map(move |&[u, v]| [p, q, u, v]));
        let points = points.map(|points| (Features::PointFace, points));
        for (features, points) in points.chain(edges.map(|points| (Features::EdgeEdge, points))) {
            if layer(points[0]) == layer(points[3]) {
                continue;
            }
            let [nearest, _] = all.nearest(features, points);
            let is_found = names.binary_search(&name(features, points)).is_ok();
            prop_assert!(is_found || nearest > kept + SLACK - 1e-5, "{features:?} {points:?}: {nearest} m");
        }
        for pair in &found {
            let distinct = match pair.features {
                Features::PointFace => !pair.points[1..].contains(&pair.points[0]),
                Features::EdgeEdge => !pair.points[..2].iter().any(|end| pair.points[2..].contains(end)),
            };
            prop_assert!(distinct, "{pair:?} shares a corner");
            let rest = pair.features.nearest(pair.points.map(|i| sheet.rest[i as usize].into())).between.length();
            prop_assert!((pair.distance - kept.min(AT_REST * rest)).abs() < 1e-6, "{pair:?}: {rest} m at rest");
        }
    }
}
