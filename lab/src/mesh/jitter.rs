//! Vertices moved at random: how regular a mesh has to be is measured with it.

use bevy::{mesh::VertexAttributeValues, prelude::*};
use fastrand::Rng;

/// Moves the vertices of a lying square metre of `n` x `n` particles, all but those at its sides, along both axes by up
/// to `share` of a cell. The same places each time.
pub fn jitter(mesh: &mut Mesh, share: f32, n: u32) {
    let reach = share / n as f32;
    let mut rng = Rng::with_seed(0);
    let mut moved = |along: f32| along + reach * (2.0 * rng.f32() - 1.0);
    // A side is straight but for rounding.
    let is_inside = |along: f32| along.abs() < 0.4999;
    if let Some(VertexAttributeValues::Float32x3(positions)) = mesh.attribute_mut(Mesh::ATTRIBUTE_POSITION) {
        for [x, _, z] in positions.iter_mut().filter(|[x, _, z]| is_inside(*x) && is_inside(*z)) {
            (*x, *z) = (moved(*x), moved(*z));
        }
    }
}
