//! How rows and columns bend: a plate of rectangular cells.
//!
//! Its energy is B/2 (κuu² + κvv² + 2 κuv²) times the area, with the curvatures along rows and columns and the twist: that
//! of a sheet that bends as easily in any direction, and doesn't curl across a bend.
//!
//! ```text
//!   κuu = 2 / (a + b) ((x2 - x1) / b - (x1 - x0) / a)          x0 -a- x1 -b- x2
//!   κuv = (x00 + x11 - x01 - x10) / (the cell's area)
//! ```

use bevy_math::Vec3;

use super::lattice::Rectangle;
use crate::{
    Bend,
    layout::simd::{LANES, Lane},
    topology::lattice::RestCurvature,
};

/// A bend at rest of less than this angle is a flat place and rounding, rad.
pub(super) const FLAT: f32 = 1e-3;

/// Where two weights stand in a [`Bend`] along a strand: of the particle before and of that after.
pub(super) const ENDS: [usize; 2] = [0, 1];

/// The bends of particles in rows and columns, numbered row by row.
pub(super) struct Plate {
    rows: usize,
    columns: usize,
    closed: bool,
    /// Of the row in each particle, of the column, and the twist of the cell that begins there.
    along_rows: Vec<Option<Bend>>,
    along_columns: Vec<Option<Bend>>,
    twists: Vec<Option<Bend>>,
}

impl Plate {
    /// Those of particles at `rest`, m.
    pub fn new(rest: &[Vec3], rectangle: &Rectangle) -> Self {
        let columns = rectangle.columns;
        let (rows, closed) = (rest.len() / columns, rectangle.closed);
        let mut surface = Surface { rest, rows, columns, closed, areas: Vec::new() };
        let places = || (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
        surface.areas = places().map(|at| surface.measure(at)).collect();
        Self {
            rows,
            columns,
            closed,
            along_rows: places().map(|at| surface.along_row(at)).collect(),
            along_columns: places().map(|at| surface.along_column(at)).collect(),
            twists: places().map(|at| surface.twist(at)).collect(),
        }
    }

    /// All bends, and whether each is within the lattice: all but those across the seam of a tube.
    pub fn bends(&self) -> impl Iterator<Item = (Bend, bool)> {
        let columns = self.columns;
        let is_inner = move |i: usize| (1..columns - 1).contains(&(i % columns));
        let along_rows = self.along_rows.iter().enumerate().filter_map(move |(i, bend)| Some(((*bend)?, is_inner(i))));
        let along_columns = self.along_columns.iter().filter_map(|bend| Some(((*bend)?, true)));
        let twists = self.twists.iter().enumerate();
        let twists = twists.filter_map(move |(i, bend)| Some(((*bend)?, i % columns + 1 < columns)));
        along_rows.chain(along_columns).chain(twists)
    }

    /// The bend of a row in one of its particles.
    pub fn along_row(&self, (row, column): (usize, usize)) -> Option<Bend> {
        self.along_rows[row * self.columns + column]
    }

    /// The bend of a column in one of its particles.
    pub fn along_column(&self, (row, column): (usize, usize)) -> Option<Bend> {
        self.along_columns[row * self.columns + column]
    }

    /// The twist of the cell that begins at a particle.
    pub fn twist(&self, (row, column): (usize, usize)) -> Option<Bend> {
        self.twists[row * self.columns + column]
    }

    /// What bends are at rest, for the lattice. None where all is flat.
    pub fn curl(&self) -> Option<RestCurvature> {
        if self.bends().all(|(bend, _)| bend.rest == [0.0; 3]) {
            return None;
        }
        let of = |find: &dyn Fn((usize, usize)) -> Option<Bend>, is_turned: &dyn Fn((usize, usize)) -> bool| {
            let at = |(row, column): (usize, usize)| {
                let is_inside = row < self.rows && column < self.columns;
                let rest = is_inside.then(|| find((row, column))).flatten().map_or([0.0; 3], |bend| bend.rest);
                // The lattice looks for a strand's side always after it, where a bend at the border looks before.
                let [x, y, z] = rest;
                if is_turned((row, column)) { [x, -y, -z] } else { rest }
            };
            let blocks = (0..self.columns).step_by(LANES).flat_map(|first| (0..self.rows).map(move |row| (row, first)));
            let block = |(row, first): (usize, usize)| {
                [0, 1, 2].map(|axis| -> Lane { core::array::from_fn(|l| at((row, first + l))[axis]) })
            };
            blocks.map(block).collect::<Vec<_>>()
        };
        let is_inner = |(_, column): (usize, usize)| column > 0 && column + 1 < self.columns;
        let curl = RestCurvature {
            along_rows: of(&|at| self.along_row(at).filter(|_| is_inner(at)), &|(row, _)| row + 1 == self.rows),
            along_columns: of(&|at| self.along_column(at), &|(_, column)| !self.closed && column + 1 == self.columns),
            twist: of(&|at| self.twist(at).filter(|_| at.1 + 1 < self.columns), &|_| false),
        };
        Some(curl)
    }
}

/// Where the particles are.
struct Surface<'a> {
    rest: &'a [Vec3],
    rows: usize,
    columns: usize,
    closed: bool,
    /// Area of the cell that begins at each particle, m²; 0 where there is none.
    areas: Vec<f32>,
}

impl Surface<'_> {
    fn along_row(&self, (row, column): (usize, usize)) -> Option<Bend> {
        let (before, after) = (self.left((row, column))?, self.right((row, column))?);
        let side = if row + 1 < self.rows { (row + 1, column) } else { (row - 1, column) };
        self.along([before, (row, column), after], side)
    }

    fn along_column(&self, (row, column): (usize, usize)) -> Option<Bend> {
        let (before, after) = ((row.checked_sub(1)?, column), self.below((row, column))?);
        let side = self.right((row, column)).or_else(|| self.left((row, column)))?;
        self.along([before, (row, column), after], side)
    }

    fn twist(&self, at: (usize, usize)) -> Option<Bend> {
        let corners = self.cell(at)?;
        let weight = (2.0 / self.area(at)).sqrt();
        let particles = [corners[0], corners[2], corners[1], corners[3]];
        weight.is_finite().then(|| self.bend(particles, [weight, weight, -weight, -weight]))
    }

    fn along(&self, strand: [(usize, usize); 3], side: (usize, usize)) -> Option<Bend> {
        let [before, here, after] = strand.map(|at| self.place(at));
        let (a, b) = (before.distance(here), here.distance(after));
        let area = self.area_around(strand[1]).sqrt();
        let [p, q] = [a, b].map(|side| 2.0 * area / ((a + b) * side));
        let particles = [strand[0], strand[2], strand[1], side];
        (p.is_finite() && q.is_finite()).then(|| self.bend(particles, [p, q, -(p + q), 0.0]))
    }

    /// A bend with what it is at rest. Where it is only bent within the cloth, as strands of uneven cells are, stretch sees
    /// to that.
    fn bend(&self, particles: [(usize, usize); 4], weights: [f32; 4]) -> Bend {
        let places = particles.map(|at| self.place(at));
        let sum: Vec3 = places.iter().zip(weights).map(|(place, weight)| *place * weight).sum();
        let along = (places[1] - places[0]).normalize_or_zero();
        let across = (places[3] - places[2]).reject_from(along).normalize_or_zero();
        let rest = [along, across, along.cross(across)].map(|direction| sum.dot(direction));
        let rest = if rest[2].abs() < FLAT { [0.0; 3] } else { rest };
        Bend { particles: particles.map(|at| self.particle(at)), weights, rest }
    }

    /// Area that a particle stands for, m²: a quarter of the cells around it.
    fn area_around(&self, at: (usize, usize)) -> f32 {
        let left = self.left(at);
        let above = |(row, column): (usize, usize)| row.checked_sub(1).map(|row| (row, column));
        let cells = [Some(at), left, above(at), left.and_then(above)];
        cells.into_iter().flatten().map(|cell| self.area(cell) / 4.0).sum()
    }

    fn area(&self, (row, column): (usize, usize)) -> f32 {
        self.areas[row * self.columns + column]
    }

    /// Area of the cell that begins at a particle, m²; 0 where there is none.
    fn measure(&self, at: (usize, usize)) -> f32 {
        self.cell(at).map_or(0.0, |corners| {
            let [p, q, r, s] = corners.map(|at| self.place(at));
            (r - p).cross(s - q).length() / 2.0
        })
    }

    /// Corners of the cell that begins at a particle, around it.
    fn cell(&self, at: (usize, usize)) -> Option<[(usize, usize); 4]> {
        let (right, below) = (self.right(at)?, self.below(at)?);
        Some([at, right, self.right(below)?, below])
    }

    fn left(&self, (row, column): (usize, usize)) -> Option<(usize, usize)> {
        let before = if self.closed { Some((column + self.columns - 1) % self.columns) } else { column.checked_sub(1) };
        before.map(|column| (row, column))
    }

    fn right(&self, (row, column): (usize, usize)) -> Option<(usize, usize)> {
        let next = if self.closed { (column + 1) % self.columns } else { column + 1 };
        (next < self.columns).then_some((row, next))
    }

    fn below(&self, (row, column): (usize, usize)) -> Option<(usize, usize)> {
        (row + 1 < self.rows).then_some((row + 1, column))
    }

    fn place(&self, at: (usize, usize)) -> Vec3 {
        self.rest[self.particle(at) as usize]
    }

    fn particle(&self, (row, column): (usize, usize)) -> u32 {
        (row * self.columns + column) as u32
    }
}
