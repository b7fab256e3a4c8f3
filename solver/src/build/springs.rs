//! Which particles are joined by which kind of spring.
//!
//! ```text
//!   structural          shear          bend
//!       o               o   o            o
//!       |                \ /             |     two steps along a strand,
//!    o--x--o              x         o----x----o  or across an edge between
//!       |                / \             |     free triangles
//!       o               o   o            o
//! ```

use bevy_math::Vec3;

use super::{
    cells::Cells,
    edges::{Edges, HalfEdge},
    grouped::Grouped,
};
use crate::SpringKind;

/// Largest cosine between two edges that count as one strand going straight on: 120° and more between them.
const STRAIGHT: f32 = -0.5;

/// A spring before it has a rest length: kind and ends, the lower index first.
pub(crate) type Link = (SpringKind, u32, u32);

/// The springs of a mesh, sorted by kind and ends, each pair of particles joined once at most.
///
/// Both diagonals of a cell are shear, every other edge is structural. Bending springs join the far ends of two edges
/// in line where a particle has cells all around it, and the two vertices opposite an edge everywhere else. An edge
/// with three or more sides doesn't bend.
pub(crate) fn find(
    rest: &[Vec3],
    triangles: &[[u32; 3]],
    slivers: &[[u32; 3]],
    edges: &Edges,
    cells: &Cells,
) -> Vec<Link> {
    let mut links = Vec::new();
    for &[a, b, c, d] in &cells.corners {
        links.push(link(SpringKind::Shear, a, c));
        links.push(link(SpringKind::Shear, b, d));
    }
    let is_diagonal = |sides: &[HalfEdge]| {
        let cell = |side: &HalfEdge| cells.of_triangle[side.triangle as usize];
        matches!(sides, [one, other] if cell(one).is_some() && cell(one) == cell(other))
    };
    let structural: Vec<&[HalfEdge]> = edges.iter().filter(|sides| !is_diagonal(sides)).collect();
    links.extend(structural.iter().map(|sides| link(SpringKind::Structural, sides[0].a, sides[0].b)));
    for &[i, j, k] in slivers {
        links.extend([(i, j), (j, k), (k, i)].map(|(p, q)| link(SpringKind::Structural, p, q)));
    }
    links.extend(bends_across_edges(&structural, cells));
    links.extend(bends_along_strands(rest, triangles, &structural, cells));

    // Where two kinds claim a pair, the first in the order of `SpringKind` has it.
    let mut at_lower: Grouped<(u32, SpringKind)> =
        Grouped::new(rest.len(), links.iter().map(|&(kind, a, b)| (a, (b, kind))));
    at_lower.iter_mut().for_each(<[_]>::sort_unstable);
    links.clear();
    for kind in SpringKind::ALL {
        for a in 0..rest.len() as u32 {
            let pairs = at_lower.of(a).chunk_by(|(p, _), (q, _)| p == q);
            links.extend(pairs.filter(|pair| pair[0].1 == kind).map(|pair| (kind, a, pair[0].0)));
        }
    }
    links
}

fn link(kind: SpringKind, p: u32, q: u32) -> Link {
    (kind, p.min(q), p.max(q))
}

/// Bending across edges that aren't between two cells.
fn bends_across_edges(structural: &[&[HalfEdge]], cells: &Cells) -> Vec<Link> {
    let in_cell = |side: &HalfEdge| cells.of_triangle[side.triangle as usize].is_some();
    structural
        .iter()
        .filter_map(|sides| match sides {
            [one, other] if !(in_cell(one) && in_cell(other)) => {
                Some(link(SpringKind::Bend, one.opposite, other.opposite))
            }
            _ => None,
        })
        .filter(|&(_, p, q)| p != q)
        .collect()
}

/// Bending through particles that have cells all around: their edges that go straight on join their far ends.
fn bends_along_strands(rest: &[Vec3], triangles: &[[u32; 3]], structural: &[&[HalfEdge]], cells: &Cells) -> Vec<Link> {
    let mut all_cells = vec![true; rest.len()];
    for (triangle, cell) in triangles.iter().zip(&cells.of_triangle) {
        for &particle in triangle {
            all_cells[particle as usize] &= cell.is_some();
        }
    }
    let ends = structural.iter().flat_map(|&sides| {
        let HalfEdge { a, b, .. } = sides[0];
        [(a, (b, sides)), (b, (a, sides))]
    });
    let arms: Grouped<(u32, &[HalfEdge])> = Grouped::new(rest.len(), ends);
    let mut links = Vec::new();
    for centre in (0..rest.len()).filter(|&i| all_cells[i]) {
        let arms = arms.of(centre as u32);
        for (i, &(p, sides_p)) in arms.iter().enumerate() {
            for &(q, sides_q) in &arms[i + 1..] {
                if !share_cell(sides_p, sides_q, cells) && is_straight(rest, p, centre, q) {
                    links.push(link(SpringKind::Bend, p, q));
                }
            }
        }
    }
    links
}

fn share_cell(p: &[HalfEdge], q: &[HalfEdge], cells: &Cells) -> bool {
    let cell = |side: &HalfEdge| cells.of_triangle[side.triangle as usize];
    p.iter().any(|p| q.iter().any(|q| cell(p) == cell(q)))
}

fn is_straight(rest: &[Vec3], p: u32, centre: usize, q: u32) -> bool {
    let arm = |end: u32| (rest[end as usize] - rest[centre]).normalize_or_zero();
    arm(p).dot(arm(q)) <= STRAIGHT
}
