//! A chart: coordinates in which a cloth lies flat, and nowhere over itself.

use bevy_math::{Vec2, Vec3};

/// How much larger than the cloth's own the area of a chart's bounds may come out by rounding.
const ROUNDING: f32 = 1.001;

/// The chart that the mesh's UVs are, or else the view of it along its mean normal. None where both overlap.
pub(super) fn find(rest: &[Vec3], triangles: &[[u32; 3]], uvs: Option<Vec<Vec2>>) -> Option<Vec<Vec2>> {
    uvs.filter(|uvs| is_flat(uvs, triangles)).or_else(|| {
        let view = view(rest, triangles)?;
        is_flat(&view, triangles).then_some(view)
    })
}

/// Whether all triangles face the same way and fit into the bounds of all: then they hardly overlap.
fn is_flat(chart: &[Vec2], triangles: &[[u32; 3]]) -> bool {
    let areas = || {
        triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.map(|i| chart[i as usize]);
            (b - a).perp_dot(c - a) / 2.0
        })
    };
    let bounds = triangles.as_flattened().iter().map(|&i| chart[i as usize]);
    let (low, high) = bounds.fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    let size = high - low;
    let faces_one_way = areas().all(|area| area > 0.0) || areas().all(|area| area < 0.0);
    faces_one_way && areas().sum::<f32>().abs() <= size.x * size.y * ROUNDING
}

/// The cloth as seen against its mean normal.
fn view(rest: &[Vec3], triangles: &[[u32; 3]]) -> Option<Vec<Vec2>> {
    let normals = triangles.iter().map(|triangle| {
        let [a, b, c] = triangle.map(|i| rest[i as usize]);
        (b - a).cross(c - a)
    });
    let normal = normals.sum::<Vec3>().try_normalize()?;
    let (x, y) = normal.any_orthonormal_pair();
    Some(rest.iter().map(|p| Vec2::new(p.dot(x), p.dot(y))).collect())
}
