//! Coarse lattices over a cloth without rows and columns: laid over a chart that spreads it out flat.
//!
//! ```text
//!    o-----o-----o-----o
//!    | .  /|\ . .| .\. |       o nodes, in whatever triangle is there
//!    |. ./ | .\. |. . .|       . particles, between the four nodes around them
//!    o-----o-----o-----o
//! ```

use bevy_math::{Rect, UVec2, Vec2, Vec3};

use super::by_strides;
use crate::{Lattice, Level, LinearWeights, topology::level::TransferOperator};

/// Parts that the way from node to node is cut into to be measured along the cloth.
const PARTS: usize = 4;

/// A point of a triangle: its corners and its barycentric weights.
type InTriangle = ([u32; 3], [f32; 3]);

/// All levels over a `chart`: coordinates of each particle, in which no two triangles overlap.
pub(in crate::build) fn of_chart(rest: &[Vec3], triangles: &[[u32; 3]], chart: &[Vec2]) -> Vec<Level> {
    let map = Map::new(rest, triangles, chart);
    let side = (rest.len() as f32).sqrt() as usize;
    by_strides(side, |stride| map.level(stride))
}

/// A chart, and its triangles in a raster so that they are found.
struct Map<'a> {
    rest: &'a [Vec3],
    triangles: &'a [[u32; 3]],
    chart: &'a [Vec2],
    bounds: Rect,
    /// Cells of the raster along both axes.
    cells: UVec2,
    /// Triangles that may reach into each cell.
    raster: Vec<Vec<u32>>,
}

impl<'a> Map<'a> {
    fn new(rest: &'a [Vec3], triangles: &'a [[u32; 3]], chart: &'a [Vec2]) -> Self {
        let none = Rect { min: Vec2::INFINITY, max: Vec2::NEG_INFINITY };
        let bounds = triangles.as_flattened().iter().fold(none, |bounds, &i| bounds.union_point(chart[i as usize]));
        let side = (triangles.len() as f32).sqrt().ceil().max(1.0);
        let mut map = Self { rest, triangles, chart, bounds, cells: UVec2::splat(side as u32), raster: Vec::new() };
        map.raster = vec![Vec::new(); (map.cells.x * map.cells.y) as usize];
        for (number, triangle) in (0..).zip(triangles) {
            let corners = triangle.map(|i| map.cell(chart[i as usize]));
            let (low, high) = (corners[0].min(corners[1]).min(corners[2]), corners[0].max(corners[1]).max(corners[2]));
            for y in low.y..=high.y {
                for x in low.x..=high.x {
                    map.raster[(y * map.cells.x + x) as usize].push(number);
                }
            }
        }
        map
    }

    fn cell(&self, at: Vec2) -> UVec2 {
        let share = (at - self.bounds.min) / self.bounds.size();
        (share * self.cells.as_vec2()).as_uvec2().min(self.cells - 1)
    }

    /// Where on the cloth a place of the chart is.
    fn find(&self, at: Vec2) -> Option<InTriangle> {
        // A node at the border may lie outside by a rounding.
        const OUTSIDE: f32 = 1e-3;
        let cell = self.cell(at);
        let near = &self.raster[(cell.y * self.cells.x + cell.x) as usize];
        let inside = near.iter().filter_map(|&triangle| {
            let corners = self.triangles[triangle as usize];
            let [a, b, c] = corners.map(|i| self.chart[i as usize]);
            let area = (b - a).perp_dot(c - a);
            let weights = [(b - at).perp_dot(c - at) / area, (c - at).perp_dot(a - at) / area];
            let weights = [weights[0], weights[1], 1.0 - weights[0] - weights[1]];
            let least = weights.into_iter().fold(f32::INFINITY, f32::min);
            (least >= -OUTSIDE).then_some((least, corners, weights))
        });
        let (_, corners, weights) = inside.max_by(|(p, ..), (q, ..)| p.total_cmp(q))?;
        let weights = weights.map(|weight| weight.max(0.0));
        let sum: f32 = weights.iter().sum();
        Some((corners, weights.map(|weight| weight / sum)))
    }

    fn place(&self, at: Vec2) -> Option<Vec3> {
        let (corners, weights) = self.find(at)?;
        Some(corners.iter().zip(weights).map(|(&i, weight)| self.rest[i as usize] * weight).sum())
    }

    /// Length of the way along the cloth, m; zero where it leaves the cloth.
    fn length(&self, from: Vec2, to: Vec2) -> f32 {
        let places: Option<Vec<Vec3>> =
            (0..=PARTS).map(|i| self.place(from.lerp(to, i as f32 / PARTS as f32))).collect();
        places.map_or(0.0, |places| places.array_windows().map(|[p, q]| p.distance(*q)).sum())
    }

    /// Coordinates of nodes that divide an axis evenly.
    fn axis(low: f32, high: f32, nodes: usize) -> Vec<f32> {
        (0..nodes).map(|i| low + (high - low) * i as f32 / (nodes - 1) as f32).collect()
    }

    fn level(&self, stride: usize) -> Level {
        let size = self.extent();
        let spacing = (size.x * size.y / self.rest.len() as f32).sqrt() * stride as f32;
        let nodes = (size / spacing).round().as_uvec2().max(UVec2::splat(1)) + 1;
        let columns = Self::axis(self.bounds.min.x, self.bounds.max.x, nodes.x as usize);
        let rows = Self::axis(self.bounds.min.y, self.bounds.max.y, nodes.y as usize);
        let at = |row: usize, column: usize| Vec2::new(columns[column], rows[row]);
        let lattice = Lattice::of_lengths(rows.len(), columns.len(), false, |(row, column), way| match way {
            (0, 1) => self.length(at(row, column), at(row, column + 1)),
            (1, 0) => self.length(at(row, column), at(row + 1, column)),
            _ => 0.0,
        });
        let slots = lattice.order().particles();
        let nodes: Vec<InTriangle> = slots
            .flatten()
            .map(|node| {
                let node = node? as usize;
                self.find(at(node / columns.len(), node % columns.len()))
            })
            .map(Option::unwrap_or_default)
            .collect();
        let present = nodes.iter().filter(|(_, weights)| *weights != [0.0; 3]).count();
        let particles = self.chart.iter().map(|&at| around(at, &rows, &columns, &lattice, &nodes)).collect();
        let share = self.rest.len() as f32 / present.max(1) as f32;
        let transfer = TransferOperator::Chart { nodes, particles };
        Level { stride: stride as u32, lattice, rows, columns, ring: None, share, from_coarser: None, transfer }
    }

    /// How long the cloth is along both axes of the chart, m: by the mean stretch of its triangles.
    fn extent(&self) -> Vec2 {
        let (mut along, mut area) = (Vec2::ZERO, 0.0);
        for triangle in self.triangles {
            let [p, q, r] = triangle.map(|i| self.rest[i as usize]);
            let [a, b, c] = triangle.map(|i| self.chart[i as usize]);
            let (e1, e2) = (b - a, c - a);
            let double = e1.perp_dot(e2);
            if double != 0.0 {
                // Ways in space for a unit of either coordinate.
                let x = ((q - p) * e2.y - (r - p) * e1.y) / double;
                let y = ((r - p) * e1.x - (q - p) * e2.x) / double;
                along += Vec2::new(x.length(), y.length()) * double.abs();
                area += double.abs();
            }
        }
        self.bounds.size() * along / area.max(f32::MIN_POSITIVE)
    }
}

/// Slots of the nodes around a place of the chart, and its shares of those that are there.
fn around(at: Vec2, rows: &[f32], columns: &[f32], lattice: &Lattice, nodes: &[InTriangle]) -> ([u32; 4], [f32; 4]) {
    let (down, along) = (LinearWeights::locate(rows, at.y), LinearWeights::locate(columns, at.x));
    let corner = |row: u32, column: u32| {
        let slot = lattice.order().slot_at((down.first + row) as usize, (along.first + column) as usize);
        let is_there = nodes[slot].1 != [0.0; 3];
        let share = |share: f32, second: u32| if second == 1 { share } else { 1.0 - share };
        (slot as u32, if is_there { share(down.share, row) * share(along.share, column) } else { 0.0 })
    };
    let corners = [corner(0, 0), corner(0, 1), corner(1, 0), corner(1, 1)];
    let sum: f32 = corners.iter().map(|(_, share)| share).sum();
    let scale = if sum > 0.0 { sum.recip() } else { 0.0 };
    (corners.map(|(slot, _)| slot), corners.map(|(_, share)| share * scale))
}
