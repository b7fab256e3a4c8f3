//! Finds the quads of a mesh that arrives triangulated: pairs of triangles that form a near-rectangle.

use core::array;

use bevy_math::Vec3;

use super::edges::{Edges, HalfEdge};

/// How far from a rectangle a cell may be.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CellBounds {
    /// Largest |cos| of a corner.
    most_cosine: f32,
    /// Least cosine between the normals of its two triangles.
    least_flatness: f32,
}

impl CellBounds {
    /// Near-rectangles: corners of 70° to 110°, and nearly flat.
    pub const EVEN: Self = Self { most_cosine: 0.342, least_flatness: 0.9 };

    /// Corners of 37° to 143°, folded by 60° at most: single cells of a sheet that is even [on the whole](Self::MOST_ON_AVERAGE), as at a
    /// collar or along the side of a flare.
    pub const UNEVEN: Self = Self { most_cosine: 0.8, least_flatness: 0.5 };

    /// Largest |cos| of the corners of uneven cells, on average over all of them: 75° to 105°. Rows and columns bend as if they crossed
    /// at right angles.
    pub const MOST_ON_AVERAGE: f32 = 0.259;

    /// Share of the triangles of an uneven sheet that are in even cells at least: with fewer, it isn't looked at.
    pub const LEAST_EVEN: f32 = 0.5;
}

/// The cells of a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Cells {
    /// Corners of each cell, around it. The mesh's own diagonal joins the first and the third.
    pub corners: Vec<[u32; 4]>,
    /// Cell of each triangle, if it is in one.
    pub of_triangle: Vec<Option<u32>>,
}

impl Cells {
    /// Direction of the warp in each cell, given that in each triangle.
    pub fn warp(&self, of_triangles: &[Vec3]) -> Vec<Vec3> {
        let mut warp = vec![Vec3::Y; self.corners.len()];
        for (cell, &of_triangle) in self.of_triangle.iter().zip(of_triangles) {
            if let Some(cell) = cell {
                warp[*cell as usize] = of_triangle;
            }
        }
        warp
    }

    /// Whether a share (0..=1) of all triangles are in cells, or more.
    pub fn hold(&self, share: f32) -> bool {
        let inside = self.of_triangle.iter().flatten().count();
        inside as f32 >= share * self.of_triangle.len() as f32
    }

    /// Largest |cos| of the corners of each, on average.
    pub fn mean_skew(&self, rest: &[Vec3]) -> f32 {
        let skew = |corners: &[u32; 4]| largest_cosine(&sides(corners.map(|i| rest[i as usize])));
        self.corners.iter().map(skew).sum::<f32>() / self.corners.len().max(1) as f32
    }

    /// None, of as many triangles: each is for itself.
    pub fn without_all(&self) -> Self {
        Self { corners: Vec::new(), of_triangle: vec![None; self.of_triangle.len()] }
    }
}

/// Pairs triangles into cells within `bounds`, the most rectangular pairs first; each triangle is in one cell at most.
pub(crate) fn find(rest: &[Vec3], triangles: &[[u32; 3]], edges: &Edges, bounds: CellBounds) -> Cells {
    let mut candidates: Vec<(f32, &[HalfEdge])> = edges
        .iter()
        .filter_map(|sides| {
            let [one, other] = sides else { return None };
            Some((skew(rest, corners_of(one, other), bounds)?, sides))
        })
        .collect();
    // Stable, so pairs that are equally rectangular keep the order of their edges.
    candidates.sort_by(|(p, _), (q, _)| p.total_cmp(q));
    let mut cells = Cells { corners: Vec::new(), of_triangle: vec![None; triangles.len()] };
    for (_, sides) in candidates {
        let pair = [sides[0].triangle as usize, sides[1].triangle as usize];
        if pair.iter().all(|&t| cells.of_triangle[t].is_none()) {
            for t in pair {
                cells.of_triangle[t] = Some(cells.corners.len() as u32);
            }
            cells.corners.push(corners_of(&sides[0], &sides[1]));
        }
    }
    cells
}

/// The quad of two triangles that share an edge: the edge's ends are its first and third corner.
fn corners_of(one: &HalfEdge, other: &HalfEdge) -> [u32; 4] {
    [one.a, one.opposite, one.b, other.opposite]
}

/// How far a quad is from a rectangle: the largest |cos| of its corners, rounded so that noise doesn't rank. None for a
/// quad that is too far, folded or degenerate.
fn skew(rest: &[Vec3], corners: [u32; 4], bounds: CellBounds) -> Option<f32> {
    let p = corners.map(|i| rest[i as usize]);
    let skew = largest_cosine(&sides(p));
    // Most pairs of triangles: their turn comes before the costlier look at their normals.
    if skew > bounds.most_cosine {
        return None;
    }
    let normal = |a: Vec3, b: Vec3, c: Vec3| (b - a).cross(c - a).normalize_or_zero();
    let flatness = normal(p[0], p[1], p[2]).dot(normal(p[0], p[2], p[3]));
    (flatness >= bounds.least_flatness).then_some((skew * 1e3).round())
}

/// Directions of a quad's sides, around it.
fn sides(corners: [Vec3; 4]) -> [Vec3; 4] {
    array::from_fn(|i| (corners[(i + 1) % 4] - corners[i]).normalize_or_zero())
}

/// The largest |cos| of the corners between sides.
fn largest_cosine(sides: &[Vec3; 4]) -> f32 {
    (0..4).map(|i| sides[i].dot(sides[(i + 1) % 4]).abs()).fold(0.0, f32::max)
}
