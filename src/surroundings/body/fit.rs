//! The capsule of two radii that fits points best. Knows neither meshes nor entities.

use bevy::math::Vec3A;

use super::axes::principal_axes;
use crate::solver::{Solid, TaperedCapsule};

/// Points that a capsule is found by, at most. All of them count for how thick it is.
const SAMPLES: usize = 256;

/// By how much a radius may grow along a capsule, no unit: a cone of 35°.
const STEEPEST: f32 = 0.7;

/// How deep the ends' centres may be beneath the outermost points, in parts of the radius there.
const DEPTHS: [f32; 5] = [1.0, 0.75, 0.5, 0.25, 0.0];

/// A capsule, and where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fit {
    pub capsule: TaperedCapsule,
    pub centre: Vec3A,
    /// Its own Y axis, of length 1.
    pub axis: Vec3A,
}

impl Fit {
    /// Mean of both radii, m.
    pub fn radius(&self) -> f32 {
        (self.capsule.radius_top + self.capsule.radius_bottom) / 2.0
    }

    fn is_sound(&self) -> bool {
        let TaperedCapsule { radius_top, radius_bottom, half_length } = self.capsule;
        let is_finite = half_length.is_finite() && self.centre.is_finite() && self.axis.is_normalized();
        is_finite && [radius_top, radius_bottom].iter().all(|&radius| radius.is_finite() && radius > 0.0)
    }
}

/// The capsule along one of the principal axes of points with weights whose surface is nearest to them, thick enough that the share
/// `cover` of them is inside. None where they have no width.
pub(super) fn fit(points: &[(Vec3A, f32)], cover: f32) -> Option<Fit> {
    let (middle, axes) = principal_axes(points);
    let candidates = axes.into_iter().filter_map(|axis| {
        let all: Vec<Around> =
            points.iter().map(|&(place, weight)| Around { weight, ..around(place - middle, axis) }).collect();
        let few: Vec<Around> = all.iter().copied().step_by(points.len().div_ceil(SAMPLES).max(1)).collect();
        let line = Line::through(&few)?;
        let shape = line.rounded(&few, &all);
        let error = shape.error(&few);
        let Shape { ends: [low, high], radii } = shape.lifted(&all, cover);
        let capsule = TaperedCapsule::new(radii[1], radii[0], high - low);
        let fit = Fit { capsule, centre: middle + axis * ((low + high) / 2.0), axis };
        (fit.is_sound() && error.is_finite()).then_some((error, fit))
    });
    candidates.reduce(|best, next| if next.0 < best.0 { next } else { best }).map(|(_, fit)| fit)
}

/// A point around an axis.
#[derive(Clone, Copy, Debug)]
struct Around {
    /// Where it is along the axis, m.
    along: f32,
    /// Distance from the axis, m.
    distance: f32,
    weight: f32,
}

fn around(offset: Vec3A, axis: Vec3A) -> Around {
    let along = offset.dot(axis);
    Around { along, distance: (offset - axis * along).length(), weight: 1.0 }
}

/// A radius that changes linearly along an axis, m.
struct Line {
    radius: f32,
    slope: f32,
    /// The mean of the points' distances.
    mean: f32,
}

impl Line {
    /// Least squares of the distance from the axis. None where there is none.
    fn through(points: &[Around]) -> Option<Self> {
        let sum = |of: &dyn Fn(&Around) -> f32| points.iter().map(|point| point.weight * of(point)).sum::<f32>();
        let whole = sum(&|_| 1.0);
        let (along, radius) = (sum(&|point| point.along) / whole, sum(&|point| point.distance) / whole);
        let products = sum(&|point| (point.along - along) * (point.distance - radius));
        let squares = sum(&|point| (point.along - along) * (point.along - along));
        let slope = if squares > 0.0 { (products / squares).clamp(-STEEPEST, STEEPEST) } else { 0.0 };
        (radius > 0.0).then_some(Self { radius: radius - slope * along, slope, mean: radius })
    }

    /// The radius at a place. What the line would have thinner than a fifth of its mean isn't, as the tip of a foot.
    fn at(&self, along: f32) -> f32 {
        (self.radius + self.slope * along).max(0.2 * self.mean)
    }

    /// A shape with round ends. Where skin closes around an end, the cap ends with it; where it goes on to the next joint there is
    /// only a rim, and the cap goes on too: as deep as brings the surface nearest to `few` of `all` points.
    fn rounded(&self, few: &[Around], all: &[Around]) -> Shape {
        let (low, high) =
            all.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), p| (low.min(p.along), high.max(p.along)));
        let shape = |[below, above]: [f32; 2]| {
            let (from, to) = (low + below * self.at(low), high - above * self.at(high));
            let ends = if from <= to { [from, to] } else { [(from + to) / 2.0; 2] };
            Shape { ends, radii: ends.map(|end| self.at(end)) }
        };
        let best = |shapes: [Shape; DEPTHS.len()]| {
            let errors = shapes.map(|shape| shape.error(few));
            (1..DEPTHS.len()).fold(0, |best, next| if errors[next] < errors[best] { next } else { best })
        };
        let above = DEPTHS[best(DEPTHS.map(|above| shape([1.0, above])))];
        let below = DEPTHS[best(DEPTHS.map(|below| shape([below, above])))];
        shape([below, above])
    }
}

/// A capsule along an axis.
#[derive(Clone, Copy)]
struct Shape {
    /// Where its balls are, the lower one first.
    ends: [f32; 2],
    radii: [f32; 2],
}

impl Shape {
    /// Distance of points, m, negative inside, and their weights.
    fn distances<'a>(&self, points: &'a [Around]) -> impl Iterator<Item = (f32, f32)> + use<'a> {
        let Self { ends: [low, high], radii } = *self;
        let solid = Solid::TaperedCapsule(TaperedCapsule::new(radii[1], radii[0], high - low));
        let middle = (low + high) / 2.0;
        points.iter().map(move |point| {
            let place = Vec3A::new(point.distance, point.along - middle, 0.0);
            (solid.surface(place).distance, point.weight)
        })
    }

    /// Sum of the squares of these distances.
    fn error(&self, points: &[Around]) -> f32 {
        self.distances(points).map(|(distance, weight)| weight * distance * distance).sum()
    }

    /// The same, so much thicker or thinner that the share `cover` of the points is inside.
    fn lifted(&self, points: &[Around], cover: f32) -> Self {
        let mut distances: Vec<(f32, f32)> = self.distances(points).collect();
        distances.sort_unstable_by(|one, other| one.0.total_cmp(&other.0));
        let whole: f32 = distances.iter().map(|(_, weight)| weight).sum();
        let mut inside = 0.0;
        let last = distances.iter().find(|(_, weight)| {
            inside += weight;
            inside >= cover * whole
        });
        let lift = last.or(distances.last()).map_or(0.0, |&(distance, _)| distance);
        // Distances all shrink by as much as both radii grow.
        Self { radii: self.radii.map(|radius| radius + lift), ..*self }
    }
}

#[cfg(test)]
mod tests {
    use core::f32::consts::TAU;

    use bevy::math::ops;

    use super::*;

    /// Rings around the Z axis, from `radii[0]` at z = 0 to `radii[1]` at `length`.
    fn tube(radii: [f32; 2], length: f32) -> Vec<(Vec3A, f32)> {
        let ring = |k: usize| {
            let share = k as f32 / 20.0;
            let radius = radii[0] + share * (radii[1] - radii[0]);
            (0..16).map(move |i| {
                let angle = i as f32 / 16.0 * TAU;
                (Vec3A::new(radius * ops::cos(angle), radius * ops::sin(angle), share * length), 0.1)
            })
        };
        (0..=20).flat_map(ring).collect()
    }

    #[test]
    fn a_tube_gets_its_radii_and_caps_that_go_on() {
        let Fit { capsule, centre, axis } = fit(&tube([0.1, 0.06], 0.5), 0.5).unwrap();
        assert!(axis.z.abs() > 0.999 && (centre.z - 0.25).abs() < 0.03 && centre.truncate().length() < 1e-3);
        let mut radii = [capsule.radius_top, capsule.radius_bottom];
        radii.sort_unstable_by(f32::total_cmp);
        assert!((radii[0] - 0.06).abs() < 0.006 && (radii[1] - 0.1).abs() < 0.006, "{radii:?}");
        assert!(capsule.half_length > 0.21, "{capsule:?}");
    }

    #[test]
    fn a_round_end_is_where_the_skin_ends() {
        let capsule = Solid::TaperedCapsule(TaperedCapsule::new(0.1, 0.1, 0.4));
        // What is cast on it from far around.
        let cast = |i: usize| {
            let (height, angle) = ((i / 24) as f32 / 20.0 * 0.6 - 0.3, (i % 24) as f32 / 24.0 * TAU);
            let from = Vec3A::new(ops::cos(angle) * 0.12, height * 1.2, ops::sin(angle) * 0.12);
            let surface = capsule.surface(from);
            (from - surface.normal * surface.distance, 1.0)
        };
        let fit = fit(&(0..21 * 24).map(cast).collect::<Vec<_>>(), 0.5).unwrap();
        assert!((fit.radius() - 0.1).abs() < 0.006 && (fit.capsule.half_length - 0.2).abs() < 0.015, "{fit:?}");
    }

    #[test]
    fn as_many_are_inside_as_are_asked_for() {
        let mut points = tube([0.1, 0.1], 0.5);
        // A flat one: 0.1 by 0.05.
        points.iter_mut().for_each(|point| point.0.y *= 0.5);
        for cover in [0.0, 0.3, 0.85, 1.0] {
            let Fit { capsule, centre, axis } = fit(&points, cover).unwrap();
            let solid = Solid::TaperedCapsule(capsule);
            let is_inside = |&&(point, _): &&(Vec3A, f32)| {
                let place = around(point - centre, axis);
                solid.surface(Vec3A::new(place.distance, place.along, 0.0)).distance < 1e-5
            };
            let share = points.iter().filter(is_inside).count() as f32 / points.len() as f32;
            assert!(share >= cover && share < cover + 0.15, "{share} for {cover}");
        }
    }

    #[test]
    fn what_has_no_width_has_no_capsule() {
        assert_eq!(fit(&[], 0.85), None);
        assert_eq!(fit(&[(Vec3A::ONE, 1.0); 20], 0.85), None);
        let weightless: Vec<(Vec3A, f32)> = tube([0.1; 2], 0.5).into_iter().map(|(place, _)| (place, 0.0)).collect();
        assert_eq!(fit(&weightless, 0.85), None);
        let line: Vec<(Vec3A, f32)> = (0..20).map(|i| (Vec3A::X * i as f32, 1.0)).collect();
        assert!(fit(&line, 0.85).is_none_or(|fit| fit.is_sound()));
    }
}
