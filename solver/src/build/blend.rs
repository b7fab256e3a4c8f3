//! By which weights particles follow what their cloth is pinned to, where that is several things: by distances along the
//! cloth.

use super::geodesic::{Kept, Label, Search};
use crate::Topology;

/// Carriers that a particle follows at most.
const MOST: usize = 4;

/// The weights by which each particle follows the carriers of its cloth. One that is pinned follows its own alone.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BlendWeights(Vec<[(u32, f32); MOST]>);

impl BlendWeights {
    /// Numbers of the carriers that a particle follows, with weights whose sum is 1. None for a particle that hangs on no
    /// pin.
    pub fn of(&self, particle: usize) -> impl Iterator<Item = (usize, f32)> {
        let weights = self.0.get(particle).into_iter().flatten();
        weights.filter(|(_, weight)| *weight > 0.0).map(|&(carrier, weight)| (carrier as usize, weight))
    }
}

/// Weights that are being worked out, a part at a time.
#[derive(Clone, Debug)]
pub struct BlendWeightBuild {
    /// Pinned particles, each with the number of its carrier.
    pins: Vec<(u32, u32)>,
    /// None before the first part.
    search: Option<Search>,
}

impl BlendWeightBuild {
    /// Begins at pinned particles, each with the number of its carrier.
    pub fn begin(pins: Vec<(u32, u32)>) -> Self {
        Self { pins, search: None }
    }

    /// Settles as many as `most` distances. True where all are settled.
    pub fn advance(&mut self, topology: &Topology, most: usize) -> bool {
        let search = self.search.get_or_insert_with(|| {
            let mut search = Search::new(topology, Kept::Nearest(MOST + 1));
            for &(particle, carrier) in &self.pins {
                search.propose(particle, carrier, 0.0);
            }
            search
        });
        search.run(&topology.rest, most)
    }

    /// The weights, once all distances are settled.
    pub fn finish(self) -> BlendWeights {
        let labels = self.search.into_iter().flat_map(|search| search.labels);
        BlendWeights(labels.map(|labels| weights(&labels)).collect())
    }
}

/// Weights of the nearest carriers: `((R - d) / (R d))^2` by their distances d, where R is that of the first that is left
/// out (Franke and Nielson, "Smooth interpolation of large sets of scattered data", 1980). So a carrier comes and goes at
/// weight 0.
fn weights(labels: &[Label]) -> [(u32, f32); MOST] {
    let mut weights = [(0, 0.0); MOST];
    let left_out = labels.get(MOST).map_or(0.0, |label| 1.0 / label.distance);
    let near = labels.iter().take(MOST);
    // By the nearest distance, so that no weight is infinite.
    let nearest = labels.first().map_or(0.0, |label| label.distance);
    for (weight, &Label { pin, distance }) in weights.iter_mut().zip(near.clone()) {
        let closeness = if distance > 0.0 { nearest / distance - nearest * left_out } else { 1.0 };
        *weight = (pin, closeness * closeness);
    }
    let sum: f32 = weights.iter().map(|(_, weight)| weight).sum();
    let count = near.len() as f32;
    for (_, weight) in weights.iter_mut().take(near.len()) {
        // Where all are equally far, the first that is left out too.
        *weight = if sum > 0.0 { *weight / sum } else { 1.0 / count };
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;

    fn weights_of(distances: &[f32]) -> [f32; MOST] {
        let labels: Vec<Label> = (0..).zip(distances).map(|(pin, &distance)| Label { pin, distance }).collect();
        weights(&labels).map(|(_, weight)| weight)
    }

    #[test]
    fn a_pinned_particle_follows_its_own_carrier_alone() {
        assert_eq!(weights_of(&[0.0, 0.3, 2.0]), [1.0, 0.0, 0.0, 0.0]);
        assert_eq!(weights_of(&[0.0, 0.1, 0.2, 0.3, 0.4]), [1.0, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn nearer_carriers_have_more_weight_and_all_have_one_in_sum() {
        assert_eq!(weights_of(&[]), [0.0; MOST]);
        assert_eq!(weights_of(&[0.5]), [1.0, 0.0, 0.0, 0.0]);
        assert_eq!(weights_of(&[1.0, 1.0]), [0.5, 0.5, 0.0, 0.0]);
        let [near, far, ..] = weights_of(&[1.0, 2.0]);
        assert!((near - 0.8).abs() < 1e-6 && (far - 0.2).abs() < 1e-6, "{near} {far}");
        assert_eq!(weights_of(&[2.0; 5]), [0.25; MOST]);
    }

    #[test]
    fn a_carrier_that_becomes_one_too_many_has_no_weight_left() {
        let [.., last] = weights_of(&[1.0, 1.5, 2.0, 2.999, 3.0]);
        assert!(last < 1e-6, "{last}");
    }
}
