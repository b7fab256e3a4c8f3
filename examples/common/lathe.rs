//! Things that are turned on a lathe or a potter's wheel: plates, bowls, bottles, baskets.

use std::f32::consts::TAU;

use bevy::{
    asset::RenderAssetUsages,
    math::{cubic_splines::CubicGenerator, ops},
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};

/// Corners around.
const AROUND: u32 = 32;

/// Places along the profile from one of its points to the next.
const SMOOTH: usize = 3;

/// Turns a smooth profile about Y. Its points have a radius and a height, m: from the axis at the bottom, up on the
/// outside, over the rim and down on the inside to the axis again, so that they enclose a volume.
pub fn turned(profile: &[(f32, f32)]) -> Mesh {
    let rows = smoothed(profile);
    let last = rows.len() - 1;
    let mut positions = Vec::new();
    let mut normals = Vec::new();
    let mut uvs = Vec::new();
    for (row, place) in rows.iter().enumerate() {
        let way = rows[(row + 1).min(last)] - rows[row.saturating_sub(1)];
        let out = Vec2::new(way.y, -way.x).normalize_or_zero();
        for column in 0..=AROUND {
            // A seam is closed where its vertices are at one place to the bit.
            let (sin, cos) = ops::sin_cos(TAU * (column % AROUND) as f32 / AROUND as f32);
            positions.push([place.x * cos, place.y, place.x * sin]);
            normals.push([out.x * cos, out.y, out.x * sin]);
            uvs.push([column as f32 / AROUND as f32, row as f32 / last as f32]);
        }
    }
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs)
        .with_inserted_indices(Indices::U32(indices(last as u32)))
}

/// Places on a curve through all points, of which only the ends are on the axis.
fn smoothed(profile: &[(f32, f32)]) -> Vec<Vec2> {
    let points: Vec<Vec2> = profile.iter().map(|&(radius, height)| Vec2::new(radius, height)).collect();
    let spans = profile.len() - 1;
    let curve = CubicCardinalSpline::new_catmull_rom(points.iter().copied()).to_curve();
    let mut places: Vec<Vec2> = curve.map_or(points, |curve| curve.iter_positions(SMOOTH * spans).collect());
    for (i, place) in places.iter_mut().enumerate() {
        place.x = if i == 0 || i == SMOOTH * spans { 0.0 } else { place.x.max(1e-4) };
    }
    places
}

/// Triangles between the rows; where a row is on the axis, one for each pair of them.
fn indices(last: u32) -> Vec<u32> {
    let mut indices = Vec::new();
    for (row, column) in (0..last).flat_map(|row| (0..AROUND).map(move |column| (row, column))) {
        let a = row * (AROUND + 1) + column;
        let (b, c, d) = (a + 1, a + AROUND + 1, a + AROUND + 2);
        if row > 0 {
            indices.extend([a, c, b]);
        }
        if row + 1 < last {
            indices.extend([b, c, d]);
        }
    }
    indices
}
