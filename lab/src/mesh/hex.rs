//! A square metre of equilateral triangles.
//!
//! ```text
//!   o---o---o---o
//!    \ / \ / \ /
//!     o---o---o       rows of C and C - 1 vertices take turns
//!    / \ / \ / \
//!   o---o---o---o
//! ```
//!
//! The left and right border go in zigzag: half triangles, which would make them straight, have a right angle and a
//! side of half the length, and such a border would be stiffer than the inside. Rows are stretched by up to about 1/n,
//! so that whole ones fill the metre.

use bevy::prelude::*;

use super::Sheet;

/// About `n` x `n` vertices, row by row from -Z.
pub fn sheet(n: u32) -> Sheet {
    // C x R = n² where the height of a triangle, 1 / (R - 1), is √3/2 of its side, 1 / (C - 1).
    let slope = 0.75_f32.sqrt();
    let columns = ((n as f32 * slope.sqrt()).round() as u32).max(3);
    let rows = ((columns - 1) as f32 / slope).round() as u32 + 1;
    let mut uvs: Vec<Vec2> = Vec::new();
    let mut triangles = Vec::new();
    let mut above: Vec<u32> = Vec::new();
    for row in 0..rows {
        let first = uvs.len() as u32;
        let (count, shift) = if row % 2 == 0 { (columns, 0.0) } else { (columns - 1, 0.5) };
        let place = |column| Vec2::new((column as f32 + shift) / (columns - 1) as f32, row as f32 / (rows - 1) as f32);
        uvs.extend((0..count).map(place));
        let below: Vec<u32> = (first..first + count).collect();
        join(&above, &below, &mut triangles);
        above = below;
    }
    super::square(uvs, &triangles)
}

/// Fills the strip between two rows, each edge with the vertex of the other row that is opposite its middle.
fn join(above: &[u32], below: &[u32], triangles: &mut Vec<[u32; 3]>) {
    // The longer row sticks out by a vertex on either side.
    let opposite = |row: &[u32], other: &[u32]| usize::from(row.len() < other.len());
    for (&[left, right], &low) in above.array_windows().zip(&below[opposite(above, below)..]) {
        triangles.push([left, low, right]);
    }
    for (&[left, right], &high) in below.array_windows().zip(&above[opposite(below, above)..]) {
        triangles.push([high, left, right]);
    }
}
