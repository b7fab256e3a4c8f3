//! The scene `hang`, the same cloth as in the lab of bevy_drape.

use std::f64::consts::TAU;

/// Duration of a frame, s.
pub const FRAME: f32 = 1.0 / 60.0;

/// Acceleration by gravity along -Y, m/s².
pub const GRAVITY: f32 = 9.81;

/// Mass of the whole cloth, kg.
pub const MASS: f32 = 0.2;

/// Stiffness of a spring between neighbours in a row or a column, N/m.
pub const STRUCTURAL: f32 = 5000.0;

/// Stiffness of a spring along a diagonal of a cell, N/m.
pub const SHEAR: f32 = 500.0;

/// Stiffness of a spring between particles two apart in a row or a column, N/m.
pub const BEND: f32 = 20.0;

/// A square metre of cloth, centred on the origin, in the XZ plane. Particles go row by row.
pub struct Cloth {
    /// Particles along each side.
    pub n: usize,
    /// Places without any strain, flat, m.
    pub rest: Vec<[f32; 3]>,
    /// Places at the start: as at rest, but for a smooth ripple of 1 mm, m.
    pub start: Vec<[f32; 3]>,
    /// Particles that don't move.
    pub pins: Vec<usize>,
}

impl Cloth {
    /// Cloth of `n` x `n` particles that hangs from two corners of one edge.
    pub fn hanging(n: usize) -> Self {
        Self { pins: vec![0, n - 1], ..Self::free(n) }
    }

    /// The same with nothing pinned: it falls.
    pub fn free(n: usize) -> Self {
        let rest: Vec<[f32; 3]> = (0..n * n)
            .map(|particle| [particle % n, particle / n].map(|place| place as f32 / (n - 1) as f32 - 0.5))
            .map(|[x, z]| [x, 0.0, z])
            .collect();
        Self { n, start: rest.iter().map(ripple).collect(), rest, pins: Vec::new() }
    }

    /// Mass of a particle, kg.
    pub fn particle_mass(&self) -> f32 {
        MASS / (self.n * self.n) as f32
    }

    /// Distance between neighbours at rest, m.
    pub fn spacing(&self) -> f32 {
        1.0 / (self.n - 1) as f32
    }

    /// Pairs of particles that are `distance` apart in a row or a column: 1 for structural springs, 2 for bending.
    pub fn pairs(&self, distance: usize) -> impl Iterator<Item = [usize; 2]> {
        let n = self.n;
        (0..n * n).flat_map(move |particle| {
            let along_row = (particle % n + distance < n).then_some([particle, particle + distance]);
            let along_column = (particle / n + distance < n).then_some([particle, particle + distance * n]);
            along_row.into_iter().chain(along_column)
        })
    }

    /// Two triangles a cell.
    pub fn faces(&self) -> Vec<[u32; 3]> {
        let n = self.n as u32;
        let cells = (0..n - 1).flat_map(|row| (0..n - 1).map(move |column| row * n + column));
        cells.flat_map(|a| [[a, a + n, a + 1], [a + 1, a + n, a + n + 1]]).collect()
    }
}

fn ripple(&[x, y, z]: &[f32; 3]) -> [f32; 3] {
    let wave = |x: f64| (TAU * x).sin();
    [x, y + (0.001 * wave(x.into()) * wave(f64::from(z) + 0.25)) as f32, z]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_has_its_springs_and_faces() {
        let cloth = Cloth::hanging(4);
        assert_eq!(cloth.pairs(1).count(), 24);
        assert_eq!(cloth.pairs(2).count(), 16);
        assert_eq!(cloth.faces().len(), 18);
    }

    #[test]
    fn neighbours_are_a_spacing_apart_at_rest() {
        let cloth = Cloth::hanging(5);
        for [a, b] in cloth.pairs(1) {
            let [a, b] = [cloth.rest[a], cloth.rest[b]];
            assert!(((a[0] - b[0]).abs() + (a[2] - b[2]).abs() - cloth.spacing()).abs() < 1e-6);
        }
    }
}
