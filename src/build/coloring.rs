//! Sorts springs into colours: no two springs of one colour share a particle.
//!
//! Within a colour the order doesn't matter, so it may run side by side, and sweeping colour after colour carries no
//! direction of the mesh into the cloth.

use bevy::prelude::*;

use super::springs::Link;
use crate::solver::{Spring, SpringBatch, SpringKind};

/// Order in which the solver visits the kinds. What comes last is held best: stretch shows more than bending.
const ORDER: [SpringKind; 3] = [SpringKind::Bend, SpringKind::Shear, SpringKind::Structural];

/// The springs of `links` in batches of one kind and one colour, with rest lengths from `rest` (m).
pub(crate) fn batches(rest: &[Vec3], links: &[Link]) -> (Vec<Spring>, Vec<SpringBatch>) {
    let mut springs = Vec::with_capacity(links.len());
    let mut batches = Vec::new();
    for kind in ORDER {
        let mut left: Vec<Link> = links.iter().copied().filter(|link| link.0 == kind).collect();
        // Last colour, counted from one, that used a particle.
        let mut used_by = vec![0; rest.len()];
        for color in 1.. {
            if left.is_empty() {
                break;
            }
            let start = springs.len();
            left.retain(|&(_, a, b)| {
                let is_free = used_by[a as usize] != color && used_by[b as usize] != color;
                if is_free {
                    used_by[a as usize] = color;
                    used_by[b as usize] = color;
                    let rest = rest[a as usize].distance(rest[b as usize]);
                    springs.push(Spring { a, b, rest });
                }
                !is_free
            });
            batches.push(SpringBatch { kind, range: start..springs.len() });
        }
    }
    (springs, batches)
}
