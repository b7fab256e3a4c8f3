//! The mesh: a rectangle that hangs from the x axis, its hoist on the y axis, in two halves that meet at a UV seam.

use super::SIZE;

const COLUMNS: u16 = 30;
const ROWS: u16 = 20;
const SEAM: u16 = COLUMNS / 2;

/// Rows whose vertex at the hoist is pinned: the top, the bottom, and toggles between them.
const PINNED_ROWS: [u16; 5] = [0, 5, 10, 15, ROWS];

/// Each half of the flag has its own part of the texture, with a margin between them so that neither bleeds into the
/// other. The fly half lies there mirrored.
pub const HOIST_U: [f32; 2] = [0.0, 0.48];
pub const FLY_U: [f32; 2] = [0.99, 0.51];

#[derive(Default)]
pub struct FlagMesh {
    pub positions: Vec<[f32; 3]>,
    pub uvs: Vec<[f32; 2]>,
    /// 1 where the cloth is held, else 0.
    pub pins: Vec<[f32; 1]>,
    pub indices: Vec<u16>,
}

pub fn flag() -> FlagMesh {
    let mut mesh = FlagMesh::default();
    mesh.add_half(0, SEAM, HOIST_U);
    mesh.add_half(SEAM, COLUMNS, FLY_U);
    mesh
}

impl FlagMesh {
    /// The columns from `first` to `last`, with vertices of their own at both ends: at the seam that makes two.
    fn add_half(&mut self, first: u16, last: u16, u: [f32; 2]) {
        let start = self.positions.len() as u16;
        let stride = last - first + 1;
        for row in 0..=ROWS {
            for column in first..=last {
                self.add_vertex(column, row, fraction(column - first, last - first), u);
            }
        }
        for row in 0..ROWS {
            for column in 0..stride - 1 {
                let corner = start + row * stride + column;
                self.add_quad([corner, corner + 1, corner + stride, corner + stride + 1], first + column + row);
            }
        }
    }

    fn add_vertex(&mut self, column: u16, row: u16, along: f32, u: [f32; 2]) {
        let down = fraction(row, ROWS);
        self.positions.push([fraction(column, COLUMNS) * SIZE[0], -down * SIZE[1], 0.0]);
        self.uvs.push([u[0] + along * (u[1] - u[0]), down]);
        let is_pinned = column == 0 && PINNED_ROWS.contains(&row);
        self.pins.push([if is_pinned { 1.0 } else { 0.0 }]);
    }

    /// Neighbouring quads are cut along opposite diagonals, so that the cloth prefers neither.
    fn add_quad(&mut self, [top_left, top_right, low_left, low_right]: [u16; 4], number: u16) {
        self.indices.extend(if number.is_multiple_of(2) {
            [top_left, low_left, low_right, top_left, low_right, top_right]
        } else {
            [top_left, low_left, top_right, top_right, low_left, low_right]
        });
    }
}

fn fraction(part: u16, whole: u16) -> f32 {
    f32::from(part) / f32::from(whole)
}
