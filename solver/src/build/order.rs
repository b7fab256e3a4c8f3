//! In which order particles are numbered: what is close on the cloth is to be close in memory.

use std::collections::VecDeque;

use super::topology::Shape;

/// Numbers of neighbours may differ by this many times the particles along a side before others are given.
const MOST_SPREAD: f32 = 4.0;

/// A better order for `count` particles, if theirs is a bad one: what is to come first, by its present number.
///
/// Row by row, where they are in rows and columns. Else, where neighbours are far from each other, ring by ring around
/// the first, as Cuthill and McKee (1969) order a matrix.
pub(super) fn better(count: usize, shape: &Shape) -> Option<Vec<u32>> {
    if let Some(rectangle) = &shape.rectangle {
        return (!rectangle.is_in_order()).then(|| rectangle.particles.clone());
    }
    let side = (count as f32).sqrt();
    let (mut neighbours, mut spread, mut edges) = (vec![Vec::new(); count], 0.0, 0.0_f32);
    for sides in shape.edges.iter() {
        let (a, b) = (sides[0].a, sides[0].b);
        neighbours[a as usize].push(b);
        neighbours[b as usize].push(a);
        spread += a.abs_diff(b) as f32;
        edges += 1.0;
    }
    (spread / edges.max(1.0) > MOST_SPREAD * side).then(|| by_rings(&neighbours))
}

fn by_rings(neighbours: &[Vec<u32>]) -> Vec<u32> {
    let mut order = Vec::with_capacity(neighbours.len());
    let mut is_taken = vec![false; neighbours.len()];
    let mut queue = VecDeque::new();
    for start in 0..neighbours.len() {
        if !core::mem::replace(&mut is_taken[start], true) {
            queue.push_back(start as u32);
        }
        while let Some(particle) = queue.pop_front() {
            order.push(particle);
            for &next in &neighbours[particle as usize] {
                if !core::mem::replace(&mut is_taken[next as usize], true) {
                    queue.push_back(next);
                }
            }
        }
    }
    order
}
