//! Convex hulls. Knows neither meshes nor entities.

use bevy::{math::Mat3A, prelude::*};
use parry3d::transformation::try_convex_hull;

use super::triangles::{Made, THINNEST, clean, key, numbers, numbers_of, places, thickness};
use crate::{solver::build::weld::weld, surroundings::collider::error::ColliderError};

/// By how much points are moved to find their hull, as a share of their size. The hull is of them as they are.
const UNEVEN: f32 = 1e-5;

/// The convex hull of the corners of `triangles` between `points` (m), after `scale`.
pub(crate) fn hull_of(points: &[Vec3], triangles: &[[u32; 3]], scale: Mat3A) -> Result<Made, ColliderError> {
    let welded = weld(points, triangles);
    let places = places(points, &welded.vertex_of_particle, scale)?;
    Ok(hull(&places)?.made_of(&welded.vertex_of_particle))
}

/// The convex hull of `points`, m.
pub(crate) fn hull(points: &[Vec3]) -> Result<Made, ColliderError> {
    let low = points.iter().copied().reduce(Vec3::min).unwrap_or_default();
    let size = points.iter().copied().reduce(Vec3::max).unwrap_or_default() - low;
    if !size.is_finite() {
        return Err(ColliderError::NoSize);
    }
    if points.len() < 4 || size.min_element() <= 0.0 {
        return Err(ColliderError::Flat);
    }
    // A hull stays one under any scale, and is found best in a cube. Where many points lie in one plane, as on the end of a
    // cylinder, the search may lose others that lie far outside; where they are a little uneven, it doesn't.
    let first = numbers(points);
    let is_first = |&(i, point): &(u32, &Vec3)| first.get(&key(*point)) == Some(&i);
    let uneven = |(i, &point): (u32, &Vec3)| {
        let within = (point - low) / size + UNEVEN * Vec3::from([0, 1, 2].map(|k| noise(3 * i + k)));
        (i, within)
    };
    let (given, within): (Vec<u32>, Vec<Vec3>) = (0..).zip(points).filter(is_first).map(uneven).unzip();
    let no_hull = |reason: String| ColliderError::NoHull { reason };
    let (corners, triangles) = try_convex_hull(&within).map_err(|error| no_hull(error.to_string()))?;
    let found = numbers_of(&corners, &numbers(&within))?;
    let origin: Vec<u32> = found.iter().map(|&i| given[i as usize]).collect();
    let corners: Vec<Vec3> = origin.iter().map(|&i| points[i as usize]).collect();
    // What is flat comes as two sheets.
    if thickness(&corners, &triangles).abs() <= THINNEST {
        return Err(ColliderError::Flat);
    }
    let made = clean(corners, triangles)?;
    if !made.mesh.is_closed {
        return Err(no_hull("it has gaps".into()));
    }
    Ok(made.made_of(&origin))
}

/// Any number from 0 to 1, the same always.
fn noise(i: u32) -> f32 {
    let mut bits = i.wrapping_mul(0x9e37_79b1);
    bits ^= bits >> 15;
    bits = bits.wrapping_mul(0x85eb_ca77);
    bits ^= bits >> 13;
    (bits >> 8) as f32 / (1 << 24) as f32
}

#[cfg(test)]
mod tests {
    use core::f32::consts::FRAC_PI_8;

    use bevy::math::Vec3A;

    use super::{
        super::triangles::tests::{refusal, volume},
        *,
    };

    #[test]
    fn points_in_a_plane_have_no_hull() {
        let tilted = |a: f32, b: f32| Vec3::new(a, b, 0.3 * a - 0.7 * b);
        let plane: Vec<Vec3> = (0..40).map(|i| tilted((i % 7) as f32, (i / 7) as f32)).collect();
        assert_eq!(refusal(hull(&plane)), ColliderError::Flat);
        let line: Vec<Vec3> = (0..40).map(|i| Vec3::new(1.0, 2.0, 3.0) * i as f32).collect();
        let level: Vec<Vec3> = plane.iter().map(|point| point.with_y(2.0)).collect();
        for points in [&line[..], &line[..1], &line[..2], &level, &[]] {
            assert_eq!(refusal(hull(points)), ColliderError::Flat, "{points:?}");
        }
    }

    #[test]
    fn a_hull_holds_all_points_and_bulges_everywhere() {
        let mut random = fastrand::Rng::with_seed(7);
        let mut number = || random.f32() * 2.0 - 1.0;
        let mut found = 0;
        for round in 0..600 {
            let size = Vec3::new(1.0, 10.0_f32.powi(round % 5 - 3), 1.0);
            // On a lattice, and on the ends of a cylinder, many lie in one plane.
            let snap = [1e6, 4.0, 2.0][round as usize % 3];
            let mut point = || {
                let [x, y, z] = [number(), number(), number()];
                let angle = (8.0 * x).round() * FRAC_PI_8;
                let place = if round % 2 == 0 {
                    Vec3::new(x, y, z)
                } else {
                    Vec3::new(ops::cos(angle), y.signum(), ops::sin(angle))
                };
                (place * snap).round() / snap * size + 3.0
            };
            let points: Vec<Vec3> = (0..8 + round % 60).map(|_| point()).collect();
            let mesh = match hull(&points) {
                Err(ColliderError::Flat) => continue,
                made => made.unwrap().mesh,
            };
            found += 1;
            assert!(mesh.is_closed && volume(&mesh) > 0.0);
            for triangle in mesh.triangles() {
                let [a, b, c] = triangle.map(|i| mesh.points[i as usize] / Vec3A::from(size));
                let (normal, area) = (b - a).cross(c - a).normalize_and_length();
                // A splinter along an edge faces anywhere.
                if area > 0.02 {
                    let out = points.iter().map(|&point| normal.dot(Vec3A::from(point / size) - a)).fold(0.0, f32::max);
                    assert!(out < 1e-2, "round {round}: {out}");
                }
            }
        }
        assert!(found > 590, "{found}");
    }

    #[test]
    fn points_that_are_not_finite_have_no_hull() {
        assert_eq!(refusal(hull(&[Vec3::NAN; 8])), ColliderError::NoSize);
        assert_eq!(refusal(hull(&[Vec3::ZERO, Vec3::ONE, Vec3::X, Vec3::INFINITY])), ColliderError::NoSize);
    }
}
