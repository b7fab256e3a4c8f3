//! An irregular square metre: points that keep their distance, joined by Delaunay's triangulation.
//!
//! Points as far from each other as those of the border leave no narrow triangle there: whatever is close to the border is
//! part of it.

use bevy::math::DVec2;

use super::Sheet;
use crate::laboratory::mesh::poisson;

/// About `n` x `n` vertices, the border first, then in the order of sampling: neighbours in the cloth are strewn over
/// memory as in no other mesh here.
pub fn sheet(n: u32) -> Sheet {
    // Fitted: so many steps along each side give n² vertices in all, up to 5 % more or less at n = 16, 1 % at 64.
    let along_side = (1.2745 * n as f32 - 1.85).round().max(1.0) as u32;
    let points = poisson::sample(DVec2::ONE, 1.0 / f64::from(along_side), border(along_side), |_| true);
    super::square(points.iter().map(|p| p.as_vec2()).collect(), &poisson::triangles(&points))
}

/// So many steps along each side of the unit square, the four corners among them.
fn border(along_side: u32) -> Vec<DVec2> {
    let along = (0..along_side).map(|step| f64::from(step) / f64::from(along_side));
    along.flat_map(|a| [(a, 0.0), (1.0, a), (1.0 - a, 1.0), (0.0, 1.0 - a)]).map(DVec2::from).collect()
}
