//! Sorts springs and bends into colours, and faces and bends into runs of eight: no two of a colour or run share a particle.
//!
//! Within a colour the order doesn't matter, so it may run side by side, and sweeping colour after colour carries no
//! direction of the mesh into the cloth.

use core::ops::Range;
use std::collections::VecDeque;

use crate::{Spring, SpringBatch, SpringKind, layout::simd::LANES};

/// How many items are looked at for eight that share no particle. Few, so that what a run touches is close in memory.
const WINDOW: usize = 160;

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

/// Sorts items into runs of up to eight that share no particle and are close in memory.
pub(super) fn runs<T: Copy, const N: usize>(
    mut all: Vec<T>,
    particles: impl Fn(&T) -> [u32; N],
) -> (Vec<T>, Vec<Range<usize>>) {
    all.sort_by_key(|item| particles(item).into_iter().min());
    let mut left = VecDeque::from(all);
    let (mut sorted, mut runs): (Vec<T>, Vec<Range<usize>>) = (Vec::with_capacity(left.len()), Vec::new());
    while !left.is_empty() {
        let start = sorted.len();
        let mut at = 0;
        while at < left.len().min(WINDOW) && sorted.len() < start + LANES {
            let those = particles(&left[at]);
            if sorted[start..].iter().any(|one| particles(one).iter().any(|particle| those.contains(particle))) {
                at += 1;
            } else {
                sorted.extend(left.remove(at));
            }
        }
        runs.push(start..sorted.len());
    }
    (sorted, runs)
}
