//! Pairs against all places of their features, and against the definition of a parting.

use bevy_math::DVec3;
use proptest::prelude::*;

use super::*;

const ALL: [Features; 2] = [Features::PointFace, Features::EdgeEdge];

fn point() -> impl Strategy<Value = Vec3A> {
    prop::array::uniform3(-1.0_f32..1.0).prop_map(Vec3A::from)
}

fn features() -> impl Strategy<Value = Features> {
    prop::sample::select(ALL.to_vec())
}

impl Features {
    /// Weights of many places of both, the first's less the other's.
    fn places(self) -> Vec<[f32; 4]> {
        const STEPS: u32 = 20;
        let shares = || (0..=STEPS).map(|i| i as f32 / STEPS as f32);
        match self {
            Self::PointFace => shares()
                .flat_map(|v| shares().map(move |w| [1.0, v + w - 1.0, -v, -w]))
                .filter(|weights| weights[1] <= 1e-6)
                .collect(),
            Self::EdgeEdge => shares().flat_map(|s| shares().map(move |t| [1.0 - s, s, t - 1.0, -t])).collect(),
        }
    }

    /// The distance of the nearest two of them, m: no less than that of the features.
    fn distance(self, points: [Vec3A; 4]) -> f32 {
        self.places().into_iter().map(|weights| weighted(weights, points).length()).fold(f32::INFINITY, f32::min)
    }
}

/// Points of which some are fixed.
fn masses() -> impl Strategy<Value = [f32; 4]> {
    prop::array::uniform4(prop_oneof![1 => Just(0.0_f32), 4 => 0.5_f32..2.0])
}

fn points(position: [Vec3A; 4], previous: [Vec3A; 4], inverse_mass: [f32; 4]) -> FeaturePoints {
    FeaturePoints {
        position: position.to_vec(),
        previous: previous.to_vec(),
        inverse_mass: inverse_mass.to_vec(),
        has_parted: false,
    }
}

/// Numbers of the points of a pair.
const NUMBERS: [u32; 4] = [0, 1, 2, 3];

/// A pair whose features were `gap` (m) apart along `normal`.
fn pair(features: Features, distance: f32, gap: f32, normal: Vec3A) -> FeatureContact {
    let points = NUMBERS;
    FeatureContact {
        features,
        points,
        distance,
        taper: 0.0,
        friction: 0.0,
        gap,
        normal,
        gap_before: 0.0,
        load: 0.0,
        is_solved_by_cloth: false,
    }
}

/// What a parting is to move each point by, m, from the definition in double precision.
fn moved(weights: [f32; 4], inverse_mass: [f32; 4], by: Vec3A) -> [DVec3; 4] {
    let (weights, masses) = (weights.map(f64::from), inverse_mass.map(f64::from));
    let whole: f64 = (0..4).map(|i| weights[i] * weights[i] * masses[i]).sum();
    core::array::from_fn(|i| by.as_dvec3() * (weights[i] * masses[i] / whole))
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_places_of_two_features_are_nearer(features in features(), places in prop::array::uniform4(point())) {
        let ClosestPoints { weights, between } = features.nearest(places);
        prop_assert!((weights.iter().sum::<f32>()).abs() < 1e-5);
        prop_assert!(between.distance(weighted(weights, places)) < 1e-5);
        let (first, other) = if features == Features::EdgeEdge { (2, 2) } else { (1, 3) };
        prop_assert!(weights[..first].iter().all(|weight| *weight >= -1e-4), "{weights:?}");
        prop_assert!(weights[4 - other..].iter().all(|weight| *weight <= 1e-4), "{weights:?}");
        prop_assert!((weights[..first].iter().sum::<f32>() - 1.0).abs() < 1e-4, "{weights:?}");
        let nearest = features.distance(places);
        prop_assert!(between.length() < nearest + 1e-4, "{} for {nearest}", between.length());
    }

    #[test]
    fn features_that_are_beyond_are_not_near(
        features in features(),
        places in prop::array::uniform4(point()),
        normal in point(),
        distance in 0.0_f32..0.5,
    ) {
        let normal = normal.normalize_or(Vec3A::Y);
        // Of all places, the least way along the normal is at corners.
        let least = features.places().into_iter().map(|w| weighted(w, places).dot(normal)).fold(f32::INFINITY, f32::min);
        if (least - distance).abs() > 1e-5 {
            prop_assert_eq!(features.is_beyond(places, normal, distance), least > distance);
        }
    }

    #[test]
    fn features_that_are_too_near_part_as_their_masses_say(
        features in features(),
        places in prop::array::uniform4(point()),
        inverse_mass in masses(),
        nearer in 0.05_f32..0.9,
        depenetration in prop::option::of(0.0_f32..0.1),
    ) {
        let ClosestPoints { weights, between } = features.nearest(places);
        let gap = between.length();
        prop_assume!(gap > 1e-2);
        // What gives way right beside what doesn't is held back.
        let effective: f32 = weights.iter().zip(inverse_mass).map(|(weight, w)| weight * weight * w).sum();
        let most = weights.iter().zip(inverse_mass).map(|(weight, w)| weight.abs() * w).fold(0.0, f32::max);
        prop_assume!(effective > 1e-4 && most < 0.9 * friction::MOST_LEVERAGE * effective);
        let distance = gap / nearer;
        // Before, they were as near; or as far as they should be.
        let (old_gap, most_parted) = match depenetration {
            Some(depenetration) => (gap, depenetration),
            None => (distance, 0.0),
        };
        let mut points = points(places, places, inverse_mass);
        let mut pair = pair(features, distance, old_gap, between / gap);
        prop_assert!(pair.solve(&mut points, most_parted, None).is_some() || most_parted == 0.0);
        let by = (distance.min(old_gap + most_parted) - gap).max(0.0);
        let expected = moved(weights, inverse_mass, between / gap * by);
        for i in 0..4 {
            let off = (points.position[i] - places[i]).as_dvec3().distance(expected[i]);
            prop_assert!(off < 1e-4, "{i}: {off} m");
            // What parts of what was too near before gains no speed.
            let way = points.position[i] - points.previous[i];
            let penetration = if depenetration.is_some() { DVec3::ZERO } else { expected[i] };
            prop_assert!(way.as_dvec3().distance(penetration) < 1e-4, "{i}: {way} for {penetration}");
        }
        let after = weighted(weights, core::array::from_fn(|i| points.position[NUMBERS[i] as usize]));
        prop_assert!((after.dot(between / gap) - gap - by).abs() < 1e-4);
        prop_assert!((pair.gap - gap - by).abs() < 1e-5);
    }

    #[test]
    fn features_that_are_far_enough_apart_stay(
        features in features(),
        places in prop::array::uniform4(point()),
        farther in 1.01_f32..3.0,
    ) {
        let ClosestPoints { between, .. } = features.nearest(places);
        prop_assume!(between.length() > 1e-2);
        let mut points = points(places, places, [1.0; 4]);
        let mut pair = pair(features, between.length() / farther, between.length(), between.normalize());
        prop_assert!(pair.solve(&mut points, 1.0, None).is_none());
        prop_assert_eq!(points.position, places.to_vec());
    }

    #[test]
    fn friction_takes_of_a_slide_no_more_than_its_share_of_the_push(
        features in features(),
        places in prop::array::uniform4(point()),
        inverse_mass in prop::array::uniform4(0.5_f32..2.0),
        slide in point(),
        friction in 0.0_f32..1.0,
    ) {
        let ClosestPoints { weights, between } = features.nearest(places);
        let gap = between.length();
        prop_assume!(gap > 1e-2);
        let normal = between / gap;
        // The first feature has slid along the other one by that.
        let slide = 0.2 * (slide - normal * slide.dot(normal));
        let first = if features == Features::EdgeEdge { 2 } else { 1 };
        let previous = core::array::from_fn(|i| places[i] - if i < first { slide } else { Vec3A::ZERO });
        let mut points = points(places, previous, inverse_mass);
        let mut pair = FeatureContact { friction, ..pair(features, 1.5 * gap, 1.5 * gap, normal) };
        prop_assert!(pair.solve(&mut points, 0.0, None).is_some());
        let at = |points: &[Vec3A]| weighted(weights, NUMBERS.map(|i| points[i as usize]));
        let left = at(&points.position) - at(&points.previous);
        let left = left - normal * left.dot(normal);
        let taken = slide.length().min(friction * 0.5 * gap);
        let expected = slide - slide.normalize_or_zero() * taken;
        prop_assert!(left.distance(expected) < 1e-4, "{left} for {expected} of {slide}");
    }

    #[test]
    fn what_goes_through_within_a_substep_comes_back_and_what_goes_by_does_not(
        features in prop::sample::select(vec![Features::PointFace, Features::EdgeEdge]),
        places in prop::array::uniform4(point()),
        way in point(),
    ) {
        const DISTANCE: f32 = 0.02;
        let first = if features == Features::EdgeEdge { 2 } else { 1 };
        let at = |share: f32| core::array::from_fn(|i| places[i] + if i < first { 2.0 * way * share } else { Vec3A::ZERO });
        let ClosestPoints { between, .. } = features.nearest(places);
        let after: [Vec3A; 4] = at(1.0);
        let gap = between.length();
        let beyond = features.nearest(after).between;
        prop_assume!(gap > 2.0 * DISTANCE && beyond.length() > 1e-3);
        // The volume between them changes evenly with the way: it is zero at one moment.
        let volume = |[p, q, r, s]: [Vec3A; 4]| {
            let [p, q, r, s] = [p, q, r, s].map(|p| p.as_dvec3());
            (q - p).cross(r - p).dot(s - p)
        };
        let (start, end) = (volume(places), volume(after));
        prop_assume!(start.abs() > 1e-3 && end.abs() > 1e-3);
        let meets = start * end < 0.0 && {
            let nearest = features.nearest(at((start / (start - end)) as f32)).between.length();
            prop_assume!((nearest - DISTANCE).abs() > 1e-3);
            nearest < DISTANCE
        };
        let mut points = points(places, places, [1.0; 4]);
        points.position = after.to_vec();
        let normal = between / gap;
        let mut pair = pair(features, DISTANCE, gap, normal);
        // What leads away from where they were is not the way out of what they have passed.
        let turned = meets && beyond.dot(normal) < 0.0;
        let is_touched = pair.solve(&mut points, 0.0, None).is_some();
        prop_assert_eq!(is_touched, turned || beyond.length() < DISTANCE);
        if turned {
            let out = beyond.normalize();
            let back = features.nearest(core::array::from_fn(|i| points.position[i])).between;
            prop_assert!(pair.normal.dot(out) < -0.99 && back.dot(out) < 1e-4, "{back} along {out}");
        }
    }
}
