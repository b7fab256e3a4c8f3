//! How much work a cloth needs to be stretched no more than is wanted.

use super::{LevelPass, Topology};

/// Substeps and levels of a step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Effort {
    /// Substeps a step, where nothing is near that the cloth could touch.
    pub substeps: u32,
    /// The fewest substeps where something is near.
    pub contact_substeps: u32,
    /// Iterations of the coarse levels. Without tethers, there are none.
    pub levels: Vec<LevelPass>,
    /// The same where something is near.
    pub contact_levels: Vec<LevelPass>,
}

impl Effort {
    /// Fewer leave a cloth on something trembling.
    const LEAST_IN_CONTACT: u32 = 8;

    /// What a cloth of 64 x 64 particles, 1 m wide and hung by two corners, is stretched in one substep of 1/60 s with
    /// levels, no unit.
    const STRAIN_OF_ONE: f32 = 0.012;

    /// The same without rows and columns, for all but one in a hundred springs.
    const LOOSE_STRAIN_OF_ONE: f32 = 0.04;

    /// Substeps that hold the largest strain of [`Method::Strands`](super::Method::Strands) at about `max_strain` (no
    /// unit), with levels, at 60 steps a second.
    ///
    /// Measured with `lab hang` over grids of 16 to 256 particles a side: with levels, strain falls with the number of
    /// substeps, and grows with the power 0.9 of the particles along a side. A cloth that is stretched more by its own
    /// weight stays so. On a mesh without rows and columns a few springs are stretched several times as much.
    pub fn to_hold(max_strain: f32, topology: &Topology) -> Self {
        let is_woven = topology.lattice.is_some();
        let of_64 = if is_woven { Self::STRAIN_OF_ONE } else { Self::LOOSE_STRAIN_OF_ONE };
        let of_one = of_64 * bevy::math::ops::powf(side(topology) / 64.0, 0.9);
        let substeps = (of_one / max_strain).ceil().clamp(1.0, 64.0) as u32;
        let contact_substeps = substeps.max(Self::LEAST_IN_CONTACT);
        let levels = Self::levels_for(substeps, topology);
        Self { substeps, contact_substeps, levels, contact_levels: Self::levels_for(contact_substeps, topology) }
    }

    /// So many substeps, whatever is near.
    pub fn fixed(substeps: u32, levels: Vec<LevelPass>) -> Self {
        Self { substeps, contact_substeps: substeps, contact_levels: levels.clone(), levels }
    }

    /// The levels that go with so many substeps: the fewer there are, the farther a pull has to travel in one. Where
    /// substeps are enough by themselves, levels would only stiffen the cloth.
    pub fn levels_for(substeps: u32, topology: &Topology) -> Vec<LevelPass> {
        let widest = side(topology) / (2.5 * substeps as f32);
        let iterations = if substeps < 4 { 8 } else { 4 };
        let used = topology.levels.iter().filter(|level| level.stride as f32 <= widest);
        used.map(|level| LevelPass { stride: level.stride, iterations }).collect()
    }
}

/// Particles along a side, if the cloth were a square.
fn side(topology: &Topology) -> f32 {
    (topology.particle_count() as f32).sqrt()
}
