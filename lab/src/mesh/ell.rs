//! An L of quads: a square of a metre without the quarter that is farthest from its top and right.
//!
//! ```text
//!   o---o---o---o
//!   |   |   |   |       cut off where nothing pulls at it, so that the top hangs as that of the square does
//!   o---o---o---o
//!   |   |
//!   o---o
//! ```

use bevy::prelude::*;

use super::Sheet;

/// A square of about `n²` vertices when it is whole has a quarter more: as many are left.
pub fn sheet(n: u32) -> Sheet {
    let side = ((n as f32 * (4.0_f32 / 3.0).sqrt()).round() as u32).max(3);
    let half = side / 2;
    let is_there = |row: u32, column: u32| row <= half || column <= half;
    let mut number = vec![u32::MAX; (side * side) as usize];
    let mut uvs = Vec::new();
    for (row, column) in (0..side).flat_map(|row| (0..side).map(move |column| (row, column))) {
        if is_there(row, column) {
            number[(row * side + column) as usize] = uvs.len() as u32;
            uvs.push(Vec2::new(column as f32, row as f32) / (side - 1) as f32);
        }
    }
    let mut triangles = Vec::new();
    for (row, column) in (0..side - 1).flat_map(|row| (0..side - 1).map(move |column| (row, column))) {
        if is_there(row + 1, column + 1) {
            let at = |down: u32, along: u32| number[((row + down) * side + column + along) as usize];
            let [a, b, c, d] = [at(0, 0), at(0, 1), at(1, 0), at(1, 1)];
            // The diagonals alternate, as those of a grid do.
            let cell = if (row + column) % 2 == 0 { [[a, c, b], [b, c, d]] } else { [[a, c, d], [a, d, b]] };
            triangles.extend(cell);
        }
    }
    super::square(uvs, &triangles)
}
