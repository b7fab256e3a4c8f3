//! Ways to bring sheets into shape.

use core::f32::consts::{PI, TAU};

use bevy::math::{Vec2, Vec3};

use super::{
    anatomy::Anatomy,
    field::{Loft, project},
    mesh::{Sheet, Vertex, fraction},
    skin::Influences,
};

/// The position, moved off the skin where that is nearer than `clearance`.
pub fn keep_clear(anatomy: &Anatomy, position: Vec3, clearance: f32) -> Vec3 {
    let field = |point| anatomy.body(point);
    if field(position) < clearance { project(field, position, clearance) } else { position }
}

/// Where the way from outside to `centre`, through the given point, comes within `clearance` of the skin.
pub fn cast(anatomy: &Anatomy, centre: Vec3, through: Vec3, clearance: f32) -> Vec3 {
    let inwards = (centre - through).normalize();
    let mut place = centre - inwards * 0.25;
    for _ in 0..60 {
        // Fields aren't quite distances.
        place += inwards * (0.7 * (anatomy.body(place) - clearance));
    }
    place
}

/// Moves each point half the way to the middle of its neighbours. The first and the last row stay, and edges stay
/// edges.
pub fn relax(positions: &mut [Vec3], columns: usize, is_closed: bool) {
    let old = positions.to_vec();
    let rows = old.len() / columns;
    for row in 1..rows - 1 {
        for column in 0..columns {
            let at = |row: usize, column: usize| old[row * columns + column];
            let along = (at(row - 1, column) + at(row + 1, column)) / 2.0;
            let across = match (is_closed, column) {
                (true, 0) => (at(row, columns - 2) + at(row, 1)) / 2.0,
                (true, _) if column == columns - 1 => (at(row, columns - 2) + at(row, 1)) / 2.0,
                (false, _) if column == 0 || column == columns - 1 => along,
                _ => (at(row, column - 1) + at(row, column + 1)) / 2.0,
            };
            positions[row * columns + column] = at(row, column).lerp((along + across) / 2.0, 0.5);
        }
    }
}

/// A sheet with `fineness` rows and columns for each, through the same points and smooth between them.
pub fn fine(positions: &[Vec3], columns: usize, fineness: usize) -> Vec<Vec3> {
    let rows: Vec<Vec<Vec3>> = positions.chunks(columns).map(|row| fine_line(row, fineness)).collect();
    let lines: Vec<Vec<Vec3>> = (0..rows[0].len())
        .map(|column| fine_line(&rows.iter().map(|row| row[column]).collect::<Vec<_>>(), fineness))
        .collect();
    (0..lines[0].len()).flat_map(|row| lines.iter().map(move |line| line[row])).collect()
}

/// Catmull and Rom's spline through the points.
fn fine_line(points: &[Vec3], fineness: usize) -> Vec<Vec3> {
    let last = points.len() - 1;
    let mut line = Vec::new();
    for index in 0..last {
        let (b, c) = (points[index], points[index + 1]);
        let a = if index > 0 { points[index - 1] } else { 2.0 * b - c };
        let d = if index + 1 < last { points[index + 2] } else { 2.0 * c - b };
        for step in 0..fineness {
            let t = fraction(step, fineness);
            let slopes = (c - a) * (t - 2.0 * t * t + t * t * t) + (d - b) * (t * t * t - t * t);
            line.push(b + (c - b) * (t * t * (3.0 - 2.0 * t)) + slopes * 0.5);
        }
    }
    line.push(points[last]);
    line
}

/// A closed tube around the body, from the top down, whose first row lies on the skin at a distance of `clearance`.
/// `loose` tells looseness and skin of a vertex by its place and its share of the way down.
pub fn tube(
    anatomy: &Anatomy,
    shape: &Loft,
    [columns, rows]: [usize; 2],
    height: impl Fn(usize) -> f32,
    clearance: f32,
    loose: impl Fn(Vec3, f32) -> (f32, Influences),
) -> Sheet {
    let mut vertices: Vec<Vertex> = Vec::new();
    for row in 0..=rows {
        let start = vertices.len();
        for column in 0..columns {
            let angle = TAU * fraction(column, columns) - PI;
            let place = shape.point(height(row), angle);
            let position = match row {
                0 => project(|point| anatomy.body(point), place, clearance),
                _ => keep_clear(anatomy, place, clearance),
            };
            let down = fraction(row, rows);
            let (looseness, skin) = loose(position, down);
            vertices.push(Vertex { position, uv: Vec2::new(fraction(column, columns), down), looseness, skin });
        }
        // The seam: the same vertex with another UV.
        let first = vertices[start];
        vertices.push(Vertex { uv: first.uv.with_x(1.0), ..first });
    }
    Sheet { columns: columns + 1, vertices, is_closed: true }
}
