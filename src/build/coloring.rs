//! Sorts springs into colours: no two springs of one colour share a particle.
//!
//! Within a colour the order doesn't matter, so it may run side by side, and sweeping colour after colour carries no
//! direction of the mesh into the cloth.

use crate::solver::{Spring, SpringBatch, SpringKind};

/// Order in which the solver visits the kinds. What comes last is held best: stretch shows more than bending.
const ORDER: [SpringKind; 3] = [SpringKind::Bend, SpringKind::Shear, SpringKind::Structural];

/// The springs in batches of one kind, one colour, and either on threads or not, for `count` particles.
pub(crate) fn batches(count: usize, all: &[(SpringKind, Spring)], woven: &[bool]) -> (Vec<Spring>, Vec<SpringBatch>) {
    let mut springs = Vec::with_capacity(all.len());
    let mut batches = Vec::new();
    for (kind, on_thread) in ORDER.into_iter().flat_map(|kind| [(kind, false), (kind, true)]) {
        let of_batch = all.iter().zip(woven).filter(|&(spring, &woven)| spring.0 == kind && woven == on_thread);
        let mut left: Vec<Spring> = of_batch.map(|(&(_, spring), _)| spring).collect();
        // Last colour, counted from one, that used a particle.
        let mut used_by = vec![0; count];
        for color in 1.. {
            if left.is_empty() {
                break;
            }
            let start = springs.len();
            left.retain(|&spring| {
                let ends = [spring.a as usize, spring.b as usize];
                let is_free = ends.iter().all(|&end| used_by[end] != color);
                if is_free {
                    for end in ends {
                        used_by[end] = color;
                    }
                    springs.push(spring);
                }
                !is_free
            });
            let carries = springs[start..].iter().any(|spring| spring.share != [0.0; 3]);
            batches.push(SpringBatch { kind, range: start..springs.len(), woven: on_thread, carries });
        }
    }
    (springs, batches)
}
