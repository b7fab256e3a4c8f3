//! How triangles bend: over each edge between two of them.
//!
//! ```text
//!          3
//!        / | \            curvature across the edge  =  |e| / root(A1 + A2)  (z2/h1 + z3/h2 - what the edge
//!      /   h2  \                                                              takes over of both, by the feet)
//!    0 --- e --- 1
//!      \   h1  /
//!        \ | /
//!          2
//! ```
//!
//! The sum of the positions with these weights is the angle between the triangles times |e| / root(A1 + A2), for small
//! angles, and nothing where they lie in a plane: the quadratic bending energy of Wardetzky et al., "Discrete Quadratic
//! Curvature Energies" (2007). Which of its directions bends more easily depends on the mesh, so its scale is found by
//! bending the mesh.

use bevy::{math::ops, prelude::*};

use super::{
    edges::{Edges, HalfEdge},
    plate::FLAT,
};
use crate::solver::Bend;

/// Directions of the test bends, degrees from the warp. Their mean is that of all directions, for energies that are of
/// the fourth degree in the direction.
const DIRECTIONS: [f32; 4] = [0.0, 45.0, 90.0, 135.0];

/// Bends over edges whose particles would be moved so many times as fast as is usual are weakened: they are next to
/// slivers, and what is as stiff as the stiffest bend decides how costly all of them are.
const OUTLIER: f32 = 3.0;

/// Two triangles, unfolded into a plane: along the edge, and across it.
struct Hinge {
    bend: Bend,
    triangles: [usize; 2],
    area: f32,
    unfolded: [Vec2; 4],
    warp: Vec2,
}

/// A bend for each edge between two triangles, none of them woven. `areas` are those of the particles and `triangle_areas` those of the
/// triangles, m², and `warp` is the direction of the warp in each triangle.
pub(super) fn find(
    rest: &[Vec3],
    edges: &Edges,
    areas: &[f32],
    triangle_areas: &[f32],
    warp: &[Vec3],
) -> Vec<(Bend, bool)> {
    let inner = edges.iter().filter_map(|sides| match sides {
        [one, other] => hinge(rest, [one, other], triangle_areas, warp),
        _ => None,
    });
    let mut hinges: Vec<Hinge> = inner.collect();
    weaken_outliers(&mut hinges, areas);
    let scale = calibrate(&hinges, triangle_areas).sqrt().recip();
    let scaled = |Hinge { bend: Bend { particles, weights, rest }, .. }| {
        let rest = if Vec3::from(rest).length() < FLAT { [0.0; 3] } else { rest.map(|r| r * scale) };
        (Bend { particles, weights: weights.map(|weight| weight * scale), rest }, false)
    };
    hinges.into_iter().map(scaled).collect()
}

fn hinge(rest: &[Vec3], sides: [&HalfEdge; 2], triangle_areas: &[f32], warp: &[Vec3]) -> Option<Hinge> {
    let particles = [sides[0].a, sides[0].b, sides[0].opposite, sides[1].opposite];
    let [p0, p1, p2, p3] = particles.map(|i| rest[i as usize]);
    let length = p0.distance(p1);
    let along = (p1 - p0).try_normalize()?;
    // The feet of the opposite corners on the edge, and how far from it they are.
    let feet = [p2, p3].map(|p| (p - p0).dot(along));
    let up = [p2, p3].map(|p| (p - p0).reject_from_normalized(along));
    let heights = up.map(Vec3::length);
    let triangles = sides.map(|side| side.triangle as usize);
    let area = triangles.map(|triangle| triangle_areas[triangle]).iter().sum::<f32>();
    let factor = length / area.sqrt();
    let [a, b] = heights.map(|height| factor / height);
    let [s, t] = feet.map(|foot| foot / length);
    let far = a * s + b * t;
    let weights = [a + b - far, far, -a, -b];
    if !weights.iter().all(|weight| weight.is_finite()) || p2 == p3 {
        return None;
    }
    // In each triangle, across the edge from the first triangle to the second.
    let across = [-up[0] / heights[0], up[1] / heights[1]];
    let warps = [0, 1].map(|i| Vec2::new(warp[triangles[i]].dot(along), warp[triangles[i]].dot(across[i])));
    let warp = if warps[0].dot(warps[1]) < 0.0 { warps[0] - warps[1] } else { warps[0] + warps[1] };
    let sum = (across[0] - across[1]) * factor;
    let side = (p3 - p2).reject_from_normalized(along).normalize_or_zero();
    Some(Hinge {
        bend: Bend { particles, weights, rest: [0.0, sum.dot(side), sum.dot(along.cross(side))] },
        triangles,
        area,
        unfolded: [Vec2::ZERO, Vec2::new(length, 0.0), Vec2::new(feet[0], -heights[0]), Vec2::new(feet[1], heights[1])],
        warp: warp.try_normalize().unwrap_or(Vec2::X),
    })
}

/// Makes bends that are far stiffer for their particles' masses than others as stiff as these are.
fn weaken_outliers(hinges: &mut [Hinge], areas: &[f32]) {
    let rate = |hinge: &Hinge| -> f32 {
        let Bend { particles, weights, .. } = &hinge.bend;
        particles.iter().zip(weights).map(|(&i, weight)| weight * weight / areas[i as usize]).sum()
    };
    let mut rates: Vec<f32> = hinges.iter().map(rate).collect();
    let middle = rates.len() / 2;
    if rates.is_empty() {
        return;
    }
    let most = OUTLIER * *rates.select_nth_unstable_by(middle, f32::total_cmp).1;
    for hinge in hinges {
        let factor = (most / rate(hinge)).sqrt();
        if factor < 1.0 {
            hinge.bend.weights = hinge.bend.weights.map(|weight| weight * factor);
            hinge.bend.rest = hinge.bend.rest.map(|rest| rest * factor);
        }
    }
}

/// How many times the energy of a bent sheet the hinges have: B κ²/2 times the area is that of a sheet with curvature κ in
/// one direction and none across it.
///
/// What is compared are triangles with a hinge over each side, if there are any: at a border, a part of the hinges is
/// missing. Where there is a border everywhere, each hinge counts for a third of its triangles.
fn calibrate(hinges: &[Hinge], triangle_areas: &[f32]) -> f32 {
    let mut counts = vec![0_u8; triangle_areas.len()];
    for triangle in hinges.iter().flat_map(|hinge| hinge.triangles) {
        counts[triangle] += 1;
    }
    let is_inner = |triangle: &usize| counts[*triangle] == 3;
    let any_inner = (0..counts.len()).any(|triangle| is_inner(&triangle));
    let (mut energy, mut area) = (0.0, 0.0);
    for hinge in hinges {
        let counted = hinge.triangles.iter().filter(|triangle| !any_inner || is_inner(triangle));
        let counted: f32 = counted.map(|&triangle| triangle_areas[triangle]).sum();
        area += counted / 3.0;
        energy += counted / hinge.area * mean_energy(hinge);
    }
    let ratio = energy / area;
    if ratio.is_finite() && ratio > 0.0 { ratio } else { 1.0 }
}

/// Mean energy of the test bends, over B κ²/2, m².
fn mean_energy(hinge: &Hinge) -> f32 {
    let squares = DIRECTIONS.map(|degrees| {
        let angle = degrees.to_radians();
        let direction = Vec2::new(ops::cos(angle), ops::sin(angle)).rotate(hinge.warp);
        let height = |p: &Vec2| 0.5 * p.dot(direction) * p.dot(direction);
        let sum: f32 = hinge.unfolded.iter().zip(hinge.bend.weights).map(|(p, weight)| weight * height(p)).sum();
        sum * sum
    });
    squares.iter().sum::<f32>() / squares.len() as f32
}
