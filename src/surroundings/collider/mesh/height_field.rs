//! Terrains as colliders.

use bevy::prelude::*;

use crate::solver::SourceMesh;
use crate::surroundings::collider::{ClothCollider, ColliderShape, error::ColliderError};

/// A terrain: heights on a grid, in the XZ plane around the entity's place.
///
/// The first height is that at the least x and the least z; along x go the columns, along z the rows:
///
/// ```text
///          columns -> x
///  rows    0   1   2   3
///   |      4   5   6   7
///   z      8   9  10  11
/// ```
///
/// It is a thin surface: cloth below it stays below.
#[derive(Clone, Debug, PartialEq, Reflect)]
#[reflect(Default, Debug, Clone, PartialEq)]
pub struct HeightField {
    /// Extent along x and z, m: from the first column to the last, and from the first row to the last.
    pub size: Vec2,
    /// Number of heights along x, at least 2.
    pub columns: u32,
    /// Heights above the entity's place, m, row by row. At least two rows.
    pub heights: Vec<f32>,
}

impl Default for HeightField {
    /// A level square of ten metres.
    fn default() -> Self {
        Self::new(Vec2::splat(10.0), 2, 2, |_, _| 0.0)
    }
}

impl HeightField {
    /// A terrain of `size` (m), whose `height` (m) at x and z is looked up in so many columns and rows.
    pub fn new(size: Vec2, columns: u32, rows: u32, mut height: impl FnMut(f32, f32) -> f32) -> Self {
        let mut field = Self { size, columns: columns.max(2), heights: Vec::new() };
        let rows = rows.max(2);
        field.heights = (0..field.columns * rows)
            .map(|i| {
                let place = field.place(i, rows);
                height(place.x, place.y)
            })
            .collect();
        field
    }

    /// Number of heights along z.
    pub fn rows(&self) -> u32 {
        (self.heights.len() / self.columns.max(1) as usize) as u32
    }

    /// Where height `i` is along x and z, m.
    fn place(&self, i: u32, rows: u32) -> Vec2 {
        let cells = UVec2::new(self.columns, rows) - 1;
        (UVec2::new(i % self.columns, i / self.columns).as_vec2() / cells.as_vec2() - 0.5) * self.size
    }

    /// Its points and triangles, which face up.
    pub(super) fn triangles(&self) -> Result<(Vec<Vec3>, Vec<[u32; 3]>), ColliderError> {
        let rows = self.rows();
        if self.columns < 2 || rows < 2 || (self.columns * rows) as usize != self.heights.len() {
            return Err(ColliderError::NoGrid { heights: self.heights.len(), columns: self.columns });
        }
        if !(self.size.is_finite() && self.size.min_element() > 0.0) {
            return Err(ColliderError::NoSize);
        }
        let point = |(i, &height): (u32, &f32)| self.place(i, rows).extend(height).xzy();
        let points = (0..).zip(&self.heights).map(point).collect();
        let grid = SourceMesh::grid(self.size, UVec2::new(self.columns, rows), true);
        Ok((points, grid.triangles))
    }
}

impl From<HeightField> for ClothCollider {
    fn from(field: HeightField) -> Self {
        ColliderShape::HeightField(field).into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_go_along_x_first_and_then_along_z() {
        let field = HeightField::new(Vec2::new(8.0, 4.0), 5, 3, |x, z| 10.0 * x + z);
        assert_eq!(field.heights, [-42., -22., -2., 18., 38., -40., -20., 0., 20., 40., -38., -18., 2., 22., 42.]);
        assert_eq!(field.rows(), 3);
        let (points, triangles) = field.triangles().unwrap();
        assert_eq!(points[1], Vec3::new(-2.0, -22.0, -2.0));
        assert_eq!(points[14], Vec3::new(4.0, 42.0, 2.0));
        assert_eq!(triangles.len(), 2 * 4 * 2);
        for [a, b, c] in triangles.into_iter().map(|triangle| triangle.map(|i| points[i as usize])) {
            assert!((b - a).cross(c - a).y > 0.0, "it faces up");
        }
    }

    #[test]
    fn heights_that_fill_no_grid_are_refused() {
        let field = |columns: u32, count: usize| HeightField { size: Vec2::ONE, columns, heights: vec![0.0; count] };
        for (columns, count) in [(0, 0), (0, 4), (1, 4), (2, 2), (2, 5), (3, 4), (u32::MAX, 4)] {
            let refused = Err(ColliderError::NoGrid { heights: count, columns });
            assert_eq!(field(columns, count).triangles(), refused);
        }
        assert!(field(2, 4).triangles().is_ok());
        let flat = HeightField { size: Vec2::new(1.0, 0.0), ..field(2, 4) };
        assert_eq!(flat.triangles(), Err(ColliderError::NoSize));
    }
}
