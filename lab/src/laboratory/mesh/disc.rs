//! Discs for the drape test.

use bevy::{math::DVec2, prelude::*};

use super::{Kind, lying, poisson};

/// A disc of `radius` (m) around the origin with edges of about `edge` (m), with two rings of vertices half an edge to both
/// sides of `clamp` (m): what is held within bends from the middle between them.
pub fn disc(kind: Kind, radius: f64, clamp: f64, edge: f64) -> Mesh {
    let rings = [clamp - 0.5 * edge, clamp + 0.5 * edge, radius];
    let first: Vec<DVec2> = rings.into_iter().flat_map(|radius| ring(radius, edge)).collect();
    // Not nearer to a ring than its vertices are to each other.
    let is_free = |place: DVec2| rings.iter().all(|ring| (place.length() - ring).abs() > 0.7 * edge);
    let is_inside = |place: DVec2| place.length() < radius && is_free(place);
    let points = match kind {
        Kind::Delaunay => {
            let shift = |points: Vec<DVec2>, by: f64| points.into_iter().map(|p| p + by).collect::<Vec<_>>();
            let has_place = |place: DVec2| (place - radius).length() < radius;
            shift(poisson::sample(DVec2::splat(2.0 * radius), edge, shift(first, radius), has_place), -radius)
        }
        Kind::Grid | Kind::Bias => {
            let reach = (radius / edge) as i32;
            let squares = (-reach..=reach).flat_map(|i| (-reach..=reach).map(move |j| DVec2::new(i.into(), j.into())));
            let inside = squares.map(|place| place * edge).filter(|&place| is_inside(place));
            first.into_iter().chain(inside).collect()
        }
    };
    lying(&points, &poisson::triangles(&points), Vec3::Z)
}

fn ring(radius: f64, edge: f64) -> impl Iterator<Item = DVec2> {
    let count = (core::f64::consts::TAU * radius / edge).round().max(3.0);
    (0..count as u32).map(move |i| DVec2::from_angle(core::f64::consts::TAU * f64::from(i) / count) * radius)
}
