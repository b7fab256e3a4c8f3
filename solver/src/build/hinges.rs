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

use bevy_math::{Vec2, Vec3, ops};

use super::{
    edges::{Edges, HalfEdge},
    plate::FLAT,
};
use crate::Bend;

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

/// A bend for each edge between two triangles. `areas` are those of the particles and `triangle_areas`
/// those of the triangles, m², and `warp` is the direction of the warp in each triangle.
pub(super) fn find(rest: &[Vec3], edges: &Edges, areas: &[f32], triangle_areas: &[f32], warp: &[Vec3]) -> Vec<Bend> {
    let inner = edges.iter().filter_map(|sides| match sides {
        [one, other] => hinge(rest, [one, other], triangle_areas, warp),
        _ => None,
    });
    let mut hinges: Vec<Hinge> = inner.collect();
    weaken_outliers(&mut hinges, areas);
    let scale = calibrate(&hinges, triangle_areas).sqrt().recip();
    let scaled = |Hinge { bend: Bend { particles, weights, rest }, .. }| {
        let rest = if Vec3::from(rest).length() < FLAT { [0.0; 3] } else { rest.map(|r| r * scale) };
        Bend { particles, weights: weights.map(|weight| weight * scale), rest }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        build::{SourceMesh, build},
        topology::Topology,
    };

    /// The topology of a sheet of `n` x `n` points, moved at random by up to a third of a cell inside, in triangles of
    /// random diagonals: too irregular for a lattice.
    fn irregular(n: u32, place: impl Fn(Vec2) -> Vec3) -> Topology {
        let mut random = fastrand::Rng::with_seed(3);
        let mut shift = |i: u32| if i > 0 && i < n - 1 { 0.66 * (random.f32() - 0.5) } else { 0.0 };
        let points: Vec<Vec2> = (0..n * n)
            .map(|i| (i % n, i / n))
            .map(|(i, j)| Vec2::new(i as f32 + shift(i), j as f32 + shift(j)) / (n - 1) as f32)
            .collect();
        let cells = (0..n - 1).flat_map(|j| (0..n - 1).map(move |i| j * n + i));
        let triangles = cells.flat_map(|a| {
            let [b, c, d] = [a + 1, a + n + 1, a + n];
            if a % 7 < 3 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
        });
        let positions = points.iter().map(|&p| place(p)).collect();
        let source =
            SourceMesh { triangles: triangles.collect(), positions, uvs: Some(points), ..SourceMesh::default() };
        build(&source, bevy_math::Mat3A::IDENTITY).unwrap().1
    }

    fn sum(bend: &Bend, height: impl Fn(u32) -> f32) -> f32 {
        bend.particles.iter().zip(bend.weights).map(|(&i, weight)| weight * height(i)).sum()
    }

    #[test]
    fn a_bent_sheet_has_the_energy_of_its_rigidity_on_average_and_a_tilted_one_none() {
        let topology = irregular(20, |p| p.extend(0.0));
        let at = |i: u32| topology.rest[i as usize].truncate();
        assert!(topology.lattice.is_none() && !topology.is_curved);
        let energy = |degrees: f32| -> f32 {
            let direction = Vec2::from_angle(degrees.to_radians());
            let height = |i: u32| 0.5 * at(i).dot(direction) * at(i).dot(direction);
            topology.bends.iter().map(|bend| sum(bend, height) * sum(bend, height)).sum()
        };
        let energies = [0.0, 30.0, 60.0, 90.0, 120.0, 150.0].map(energy);
        let mean = energies.iter().sum::<f32>() / 6.0;
        // A square metre, less a part of the hinges along its border.
        assert!((0.9..1.03).contains(&mean), "{energies:?}");
        assert!(energies.iter().all(|energy| (energy / mean - 1.0).abs() < 0.35), "{energies:?}");
        for bend in &topology.bends {
            let size: f32 = bend.weights.iter().map(|weight| weight.abs()).sum();
            assert!(sum(bend, |i| at(i).x).abs() < 1e-5 * size && sum(bend, |_| 1.0).abs() < 1e-5 * size);
        }
    }

    #[test]
    fn what_is_curved_has_its_sum_at_rest_and_flat_places_have_exactly_none() {
        // Flat, and from the middle on a part of a tube.
        let radius = 0.5;
        let topology = irregular(20, |p| {
            let angle = (p.x - 0.5).max(0.0) / radius;
            let end = p.x.min(0.5);
            Vec3::new(end + radius * ops::sin(angle), p.y, radius * (1.0 - ops::cos(angle)))
        });
        assert!(topology.is_curved);
        for bend in &topology.bends {
            let places = bend.particles.map(|i| topology.rest[i as usize]);
            let sum: Vec3 = places.iter().zip(bend.weights).map(|(&p, weight)| p * weight).sum();
            let along = (places[1] - places[0]).normalize();
            let across = (places[3] - places[2]).reject_from(along).normalize();
            let [x, y, z] = bend.rest;
            let rest = along * x + across * y + along.cross(across) * z;
            if places.iter().all(|p| p.x < 0.5) {
                assert_eq!(bend.rest, [0.0; 3]);
            } else {
                assert!(sum.distance(rest) < 2.0 * FLAT, "{sum} {rest}");
            }
        }
    }

    #[test]
    fn a_mesh_of_two_triangles_bends() {
        let rest = [Vec3::ZERO, Vec3::X, Vec3::new(0.3, -0.6, 0.0), Vec3::new(0.2, 0.9, 0.0)];
        let triangles = [[0, 2, 1], [0, 1, 3]];
        let bends = find(&rest, &Edges::new(4, &triangles), &[0.25, 0.25, 0.1, 0.15], &[0.3, 0.45], &[Vec3::Y; 2]);
        assert_eq!(bends.len(), 1);
        assert!(bends[0].weights.iter().all(|weight| weight.is_finite() && *weight != 0.0));
    }
}
