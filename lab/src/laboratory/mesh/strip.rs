//! Strips, cut along the threads or across them.

use bevy::{
    math::{DVec2, Vec3A},
    prelude::*,
};
use bevy_drape::prelude::ClothGrid;

use super::{Kind, lying, poisson};

/// A rectangle that lies with one corner at the origin, and what is along it.
#[derive(Clone, Copy, Debug)]
pub struct Strip {
    pub kind: Kind,
    /// Cells along its length.
    pub cells: u32,
    /// Length of a cell, m.
    pub cell: f64,
    /// Cells across.
    pub cells_across: u32,
    /// What runs along the strip: "warp", "weft" or "45°".
    pub direction: &'static str,
}

impl Strip {
    /// Length, m.
    pub fn length(&self) -> f64 {
        self.cell * f64::from(self.cells)
    }

    /// Width, m.
    pub fn width(&self) -> f64 {
        self.cell * f64::from(self.cells_across)
    }

    /// How far along the strip a rest position is, m.
    pub fn along(&self, place: Vec3A) -> f64 {
        f64::from(if self.lies_along_x() { place.x } else { place.z })
    }

    /// How far across.
    pub fn across(&self, place: Vec3A) -> f64 {
        f64::from(if self.lies_along_x() { place.z } else { place.x })
    }

    /// The unit vector along the strip.
    pub fn axis(&self) -> Vec3A {
        if self.lies_along_x() { Vec3A::X } else { Vec3A::Z }
    }

    /// Grids know their warp by their columns, which are along Z.
    fn lies_along_x(&self) -> bool {
        self.direction != "warp"
    }

    pub fn mesh(&self) -> Mesh {
        let (length, width) = (self.length(), self.width());
        let points = match self.kind {
            Kind::Grid => return self.grid(),
            Kind::Bias => self.bias(),
            Kind::Delaunay => poisson::sample(DVec2::new(length, width), self.cell, self.seeds(), |_| true),
        };
        let points: Vec<DVec2> = points.into_iter().map(|p| if self.lies_along_x() { p } else { p.yx() }).collect();
        let warp = if self.direction == "45°" { Vec3::new(1.0, 0.0, 1.0) } else { Vec3::Z };
        lying(&points, &poisson::triangles(&points), warp)
    }

    fn grid(&self) -> Mesh {
        let [length, width] = [self.length() as f32, self.width() as f32];
        let [along, across] = [self.cells + 1, self.cells_across + 1];
        let grid = if self.lies_along_x() {
            ClothGrid::new(length, width, along, across)
        } else {
            ClothGrid::new(width, length, across, along)
        };
        let corner = 0.5 * grid.size;
        Mesh::from(grid.lying()).translated_by(Vec3::new(corner.x, 0.0, corner.y))
    }

    /// Corners of squares that stand on theirs, half of them cut off by the sides.
    fn bias(&self) -> Vec<DVec2> {
        let columns = (0..=self.cells).flat_map(|i| (0..=self.cells_across).map(move |j| (i, j)));
        let corners = columns.filter(|(i, j)| (i + j) % 2 == 0);
        corners.map(|(i, j)| DVec2::new(f64::from(i), f64::from(j)) * self.cell).collect()
    }

    /// The border, and a line across where a clamp ends: a cell from the start.
    fn seeds(&self) -> Vec<DVec2> {
        let at = |i: u32, j: u32| DVec2::new(f64::from(i), f64::from(j)) * self.cell;
        let sides = (0..=self.cells).flat_map(|i| [at(i, 0), at(i, self.cells_across)]);
        let ends = (1..self.cells_across).flat_map(|j| [at(0, j), at(1, j), at(self.cells, j)]);
        sides.chain(ends).collect()
    }
}
