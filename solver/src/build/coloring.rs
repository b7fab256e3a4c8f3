//! Sorts springs, faces and bends into colours: no two of one colour share a particle.
//!
//! Within a colour the order doesn't matter, so it may run side by side, and sweeping colour after colour carries no
//! direction of the mesh into the cloth.

use core::ops::Range;

use crate::{Spring, SpringBatch, SpringKind};

/// Order in which the solver visits the kinds. What comes last is held best: stretch shows more than bending.
const ORDER: [SpringKind; 3] = [SpringKind::Bend, SpringKind::Shear, SpringKind::Structural];

/// The springs in batches of one kind, one colour, and either on strands or not, for `count` particles.
pub(crate) fn batches(
    count: usize,
    all: &[(SpringKind, Spring)],
    on_strands: &[bool],
) -> (Vec<Spring>, Vec<SpringBatch>) {
    let mut springs = Vec::with_capacity(all.len());
    let mut batches = Vec::new();
    for (kind, on_strand) in ORDER.into_iter().flat_map(|kind| [(kind, false), (kind, true)]) {
        let of_batch = all.iter().zip(on_strands).filter(|&(spring, &other)| spring.0 == kind && other == on_strand);
        let of_batch: Vec<Spring> = of_batch.map(|(&(_, spring), _)| spring).collect();
        for range in sort(count, of_batch, |spring| [spring.a, spring.b], &mut springs) {
            let carries = springs[range.clone()].iter().any(|spring| spring.share != [0.0; 3]);
            batches.push(SpringBatch { kind, range, on_strand, carries });
        }
    }
    (springs, batches)
}

/// Adds what is `left` to `sorted`, colour after colour, and returns the runs of one colour. `particles` are those that no
/// two of a colour share, out of `count`.
pub(super) fn sort<T: Copy, const N: usize>(
    count: usize,
    mut left: Vec<T>,
    particles: impl Fn(&T) -> [u32; N],
    sorted: &mut Vec<T>,
) -> Vec<Range<usize>> {
    let mut runs = Vec::new();
    // Last colour, counted from one, that used a particle.
    let mut used_by = vec![0; count];
    for color in 1.. {
        if left.is_empty() {
            break;
        }
        let start = sorted.len();
        left.retain(|item| {
            let particles = particles(item);
            let is_free = particles.iter().all(|&particle| used_by[particle as usize] != color);
            if is_free {
                for particle in particles {
                    used_by[particle as usize] = color;
                }
                sorted.push(*item);
            }
            !is_free
        });
        runs.push(start..sorted.len());
    }
    runs
}
