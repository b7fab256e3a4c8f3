//! Eight bends side by side.

use crate::{
    layout::simd::{LANES, Lane},
    topology::Bend,
};

/// Up to eight [bends](Bend) that share no particle, component by component. Where there is no bend, the particles are one more
/// than there are, and the weights are zero.
#[derive(Clone, Debug, PartialEq)]
pub struct BendPack {
    /// The particles.
    pub particles: [[u32; LANES]; 4],
    /// Weights of the particles but the first, 1/m.
    pub weights: [Lane; 3],
    /// [`Bend::rest`], no unit.
    pub rest: [Lane; 3],
}

impl BendPack {
    /// Up to eight bends; `nobody` is the particle of those that aren't there.
    pub fn new(bends: &[Bend], nobody: u32) -> Self {
        let mut pack =
            Self { particles: [[nobody; LANES]; 4], weights: [Lane::default(); 3], rest: [Lane::default(); 3] };
        for (lane, bend) in bends.iter().enumerate().take(LANES) {
            for (particles, particle) in pack.particles.iter_mut().zip(bend.particles) {
                particles[lane] = particle;
            }
            for i in 0..3 {
                pack.weights[i][lane] = bend.weights[i + 1];
                pack.rest[i][lane] = bend.rest[i];
            }
        }
        pack
    }
}
