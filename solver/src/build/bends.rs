//! Sorts bends into colours, and finds out what they are at rest.

use super::{coloring, plate::Plate};
use crate::{Bend, BendBatch};

/// The bends of a plate in batches of one colour that are either on strands or not, for `count` particles.
pub(super) fn of_plate(plate: &Plate, count: usize) -> (Vec<Bend>, Vec<BendBatch>) {
    let all: Vec<(Bend, bool)> = plate.bends().collect();
    let (mut bends, mut batches) = (Vec::with_capacity(all.len()), Vec::new());
    for on_strand in [false, true] {
        let those = all.iter().filter(|(_, other)| *other == on_strand).map(|(bend, _)| *bend).collect();
        let runs = coloring::sort(count, those, |bend: &Bend| bend.particles, &mut bends);
        batches.extend(runs.into_iter().map(|range| BendBatch { range, on_strand }));
    }
    (bends, batches)
}

/// The bends of a mesh without rows and columns in batches of up to eight.
pub(super) fn of_hinges(hinges: Vec<Bend>) -> (Vec<Bend>, Vec<BendBatch>) {
    let (bends, runs) = coloring::runs(hinges, |bend| bend.particles);
    (bends, runs.into_iter().map(|range| BendBatch { range, on_strand: false }).collect())
}
