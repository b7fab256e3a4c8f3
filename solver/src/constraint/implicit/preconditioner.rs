//! An inverse of the matrix, roughly: the coarse grid, the diagonal, and the rigid motions, added up.

use std::sync::Arc;

use fearless_simd::{f32x4, prelude::*};

use crate::{
    constraint::implicit::{
        contact::ImplicitContacts,
        rigid::RigidMotions,
        vectors::{Masses, four},
    },
    topology::two_grid::{CoarseFactor, Rate, TwoGrid},
};

/// What the preconditioner of a step consists of.
#[derive(Clone, Debug, Default)]
pub(super) struct Preconditioner {
    factor: Option<Arc<CoarseFactor>>,
    /// 1/ρ, m²/kg: the coarse matrix is that of density 1.
    per_density: f32,
    /// Inverse of the diagonal, 1/kg. Zero for a particle that is fixed.
    pub inverse_diagonal: Vec<f32>,
    /// 1 for particles that aggregates move, 0 for those that are held.
    is_moved: Vec<f32>,
    /// Values at the aggregates.
    coarse: Vec<[f32; 4]>,
    pub rigid: RigidMotions,
}

impl Preconditioner {
    /// Prepares for a step, with stiffness `stretch` (kg) and `bend` (kg m²) in all directions.
    pub fn prepare(&mut self, two_grid: &TwoGrid, masses: &Masses, density: f32, stretch: f32, bend: f32) {
        let rate = Rate { stretch: stretch / density, bend: bend / density };
        self.factor = Some(two_grid.factor(rate, &masses.held));
        self.per_density = density.recip();
        self.inverse_diagonal.clear();
        self.inverse_diagonal.extend(masses.mass.iter().enumerate().map(|(i, [mass, ..])| {
            let diagonal = || two_grid.diagonal.get(i).map_or(0.0, |&stiffness| rate.of(stiffness) * density);
            if *mass > 0.0 { (mass + diagonal()).recip() } else { 0.0 }
        }));
        self.is_moved.clear();
        self.is_moved.resize(masses.mass.len(), 1.0);
        for &particle in &masses.held {
            self.is_moved[particle as usize] = 0.0;
        }
        self.coarse.resize(two_grid.coarse.len(), [0.0; 4]);
    }

    /// Takes a residual (kg m) to a way, m, of particles with `contacts`.
    #[inline(always)]
    pub fn apply<S: Simd>(
        &mut self,
        simd: S,
        two_grid: &TwoGrid,
        masses: &Masses,
        contacts: &mut ImplicitContacts,
        residual: &mut [[f32; 4]],
        preconditioned: &mut [[f32; 4]],
    ) {
        let Self { factor, per_density, inverse_diagonal, is_moved, coarse, rigid } = self;
        contacts.scale_residual(inverse_diagonal, residual);
        coarse.fill([0.0; 4]);
        let count = two_grid.interpolation.len();
        for i in 0..count {
            let at = four(simd, &residual[i]) * (is_moved[i] * *per_density);
            for (to, weight) in two_grid.interpolation.row(i) {
                coarse[to] = (four(simd, &coarse[to]) + at * weight).into();
            }
        }
        if let Some(factor) = factor {
            factor.factor.solve(simd, &two_grid.factor_pattern, coarse);
        }
        for i in 0..count {
            let mut sum = f32x4::splat(simd, 0.0);
            for (from, weight) in two_grid.interpolation.row(i) {
                sum += four(simd, &coarse[from]) * weight;
            }
            preconditioned[i] = (sum * is_moved[i] + four(simd, &residual[i]) * inverse_diagonal[i]).into();
        }
        contacts.scale_ways(inverse_diagonal, residual, preconditioned);
        rigid.add_held(two_grid, residual, preconditioned);
        rigid.remove_free(two_grid, masses, preconditioned);
    }
}
