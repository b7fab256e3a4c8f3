//! How fine a mesh has to be for the folds of a fabric.

use bevy::math::ops;

use super::Fabric;

/// Edges of a mesh may be so many times (B / (density g))^(1/3) long and still show a fabric's folds: a fold that hangs
/// under its weight is some six of them wide, and takes four edges.
const FOLD: f32 = 1.5;

/// Earth's gravity, m/s².
const GRAVITY: f32 = 9.81;

impl Fabric {
    /// (B / (density g))^(1/3), m: the length that decides how a fabric drapes. It hangs over an edge about twice as far until
    /// it points 41.5° down, which is how a laboratory measures it (ASTM D1388).
    pub fn bending_length(&self) -> f32 {
        ops::cbrt(self.bending_rigidity / (self.density * GRAVITY))
    }

    /// The longest that a mesh's edges may be if it is to show this fabric's folds, m. Zero where nothing resists bending:
    /// then no mesh shows them all.
    pub fn max_edge_length(&self) -> f32 {
        FOLD * self.bending_length()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limp_and_heavy_fabrics_need_fine_meshes() {
        // (40e-6 / (0.324 · 9.81))^(1/3) = 23.3 mm, and (3e-6 / (0.09 · 9.81))^(1/3) = 15.0 mm.
        for (fabric, length) in [(Fabric::DENIM, 0.0233), (Fabric::SILK, 0.0150)] {
            assert!((fabric.max_edge_length() / (FOLD * length) - 1.0).abs() < 0.005, "{}", fabric.max_edge_length());
        }
        assert_eq!(Fabric { bending_rigidity: 0.0, ..Fabric::SILK }.max_edge_length(), 0.0);
    }
}
