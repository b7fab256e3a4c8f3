//! Sorts bends into colours, and finds out what they are at rest.

use super::plate::Plate;
use crate::solver::{Bend, BendBatch};

/// The bends of a plate in batches, for `count` particles.
pub(super) fn of_plate(plate: &Plate, count: usize) -> (Vec<Bend>, Vec<BendBatch>) {
    let all: Vec<(Bend, bool)> = plate.bends().collect();
    batches(count, &all)
}

/// The bends in batches of one colour that are either woven or not.
pub(super) fn batches(count: usize, all: &[(Bend, bool)]) -> (Vec<Bend>, Vec<BendBatch>) {
    let (mut bends, mut batches) = (Vec::with_capacity(all.len()), Vec::new());
    for woven in [false, true] {
        let mut left: Vec<Bend> = all.iter().filter(|(_, other)| *other == woven).map(|(bend, _)| *bend).collect();
        // Last colour, counted from one, that used a particle.
        let mut used_by = vec![0; count];
        for color in 1.. {
            if left.is_empty() {
                break;
            }
            let start = bends.len();
            left.retain(|bend| {
                let is_free = bend.particles.iter().all(|&i| used_by[i as usize] != color);
                if is_free {
                    for i in bend.particles {
                        used_by[i as usize] = color;
                    }
                    bends.push(*bend);
                }
                !is_free
            });
            batches.push(BendBatch { range: start..bends.len(), woven });
        }
    }
    (bends, batches)
}
