//! Which particles a hanging cloth is pinned by.

use bevy::math::FloatOrd;
use bevy_drape::solver::Topology;

use super::{mesh::Top, options::PinnedPart};

/// The particles of the `top` in order: all of them, or the two that are farthest apart. A ring hangs by all.
pub fn choose(topology: &Topology, top: &Top, part: PinnedPart) -> Vec<u32> {
    let depths = top.depths(&topology.rest);
    let top_particles: Vec<u32> = (0..).zip(depths).filter(|&(_, depth)| depth <= top.depth).map(|(i, _)| i).collect();
    match part {
        PinnedPart::Corners if !top.is_ring => farthest_apart(topology, &top_particles),
        _ => top_particles,
    }
}

/// Compares each with each: a top has at most a few thousand.
fn farthest_apart(topology: &Topology, particles: &[u32]) -> Vec<u32> {
    let place = |particle: u32| topology.rest[particle as usize];
    let pairs = particles.iter().enumerate().flat_map(|(i, &p)| particles[i + 1..].iter().map(move |&q| [p, q]));
    let farthest = pairs.max_by_key(|&[p, q]| FloatOrd(place(p).distance_squared(place(q))));
    farthest.map_or_else(|| particles.to_vec(), Vec::from)
}
