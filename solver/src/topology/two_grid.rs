//! The two grids of a mesh without rows and columns: its particles, and a coarse grid of aggregates.
//!
//! All matrices are those of one number a particle: the implicit solver's preconditioner doesn't tell directions apart.

use std::sync::{Arc, Mutex, PoisonError};

use crate::linear::{
    cholesky::{self, Factor},
    sparse_rows::SparseRows,
};

/// Factors that are kept: those of the substeps in use, with some sets of pins.
const KEPT_FACTORS: usize = 8;

/// Particles, aggregates, and what is between them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TwoGrid {
    /// From values at the aggregates to values at the particles: a row a particle, whose weights add up to one.
    pub interpolation: SparseRows<f32>,
    /// What joins the particles: symmetric, a row a particle.
    pub fine: SparseRows<Stiffness>,
    /// Its diagonal, which each step asks for.
    pub diagonal: Vec<Stiffness>,
    /// Areas of the particles, m², and what joins them, interpolated: the lower triangle, a row a column of it, in the order in
    /// which the aggregates are eliminated.
    pub coarse: SparseRows<(f32, Stiffness)>,
    /// Where the factor of such a matrix can be other than zero, below its diagonal, column by column.
    pub factor_pattern: SparseRows<()>,
    /// Number of the connected component that each particle belongs to.
    pub component: Vec<u32>,
    /// Number of connected components.
    pub component_count: usize,
    /// Whether the cloth is scaled since: what joins the particles is then roughly what it was.
    pub is_stretched: bool,
    factors: FactorCache,
}

/// Factors of the coarse matrix, kept for all cloths of a topology. They follow from the grids, so that a copy begins without any,
/// and they make no grids different.
#[derive(Debug, Default)]
struct FactorCache(Mutex<Vec<Arc<CoarseFactor>>>);

impl Clone for FactorCache {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl PartialEq for FactorCache {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// An entry of a stiffness matrix: that of a sheet that is stretched, with stiffness 1 (no unit), and that of one that is bent,
/// with rigidity 1, 1/m².
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stiffness {
    /// By stretch.
    pub stretch: f32,
    /// By bending.
    pub bend: f32,
}

/// How stiff a sheet is for its mass in a substep of h seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rate {
    /// k h²/ρ, m².
    pub stretch: f32,
    /// B h²/ρ, m⁴.
    pub bend: f32,
}

impl Rate {
    /// The same within 9 %: close enough for a preconditioner, so that settings and time steps that change a little share it.
    fn rounded(self) -> Self {
        // Four significant bits less the leading one: steps of 1/8 of a power of two.
        let round = |x: f32| f32::from_bits((x.to_bits() + (1 << 19)) & !((1 << 20) - 1));
        Self { stretch: round(self.stretch), bend: round(self.bend) }
    }

    /// An entry of the stiffness matrix over the density, m².
    pub fn of(self, stiffness: Stiffness) -> f32 {
        self.stretch * stiffness.stretch + self.bend * stiffness.bend
    }
}

/// The factor of a coarse matrix, with what it is for.
#[derive(Debug)]
pub(crate) struct CoarseFactor {
    rate: Rate,
    /// The particles that are held, in order: not interpolated to.
    held: Vec<u32>,
    pub factor: Factor,
}

impl TwoGrid {
    /// Grids of a cloth as it was built, without any factor yet.
    pub(crate) fn new(
        fine: SparseRows<Stiffness>,
        interpolation: SparseRows<f32>,
        coarse: SparseRows<(f32, Stiffness)>,
        component: Vec<u32>,
        component_count: usize,
    ) -> Self {
        let diagonal = |i: usize| fine.get(i, i).unwrap_or_default();
        Self {
            diagonal: (0..fine.len()).map(diagonal).collect(),
            factor_pattern: cholesky::pattern(&coarse),
            interpolation,
            fine,
            coarse,
            component,
            component_count,
            is_stretched: false,
            factors: FactorCache::default(),
        }
    }

    /// The factor of Pᵀ (A + rate K) P, where particles that are `held` have no row in P: the one that is kept, or a new one.
    ///
    /// Allocates where there is none yet.
    pub(crate) fn factor(&self, rate: Rate, held: &[u32]) -> Arc<CoarseFactor> {
        let rate = rate.rounded();
        // A panic elsewhere leaves a list that is as good as any.
        let mut factors = self.factors.0.lock().unwrap_or_else(PoisonError::into_inner);
        let known = factors.iter().position(|factor| factor.rate == rate && factor.held == held);
        let factor = match known {
            Some(known) => factors.remove(known),
            None => {
                factors.truncate(KEPT_FACTORS - 1);
                Arc::new(self.new_factor(rate, held))
            }
        };
        factors.insert(0, factor.clone());
        factor
    }

    fn new_factor(&self, rate: Rate, held: &[u32]) -> CoarseFactor {
        let entry = |(area, stiffness): (f32, Stiffness)| f64::from(area + rate.of(stiffness));
        let mut values: Vec<f64> = self.coarse.values().iter().map(|&value| entry(value)).collect();
        let mut take = |i: usize, j: usize, value: f64| {
            for (p, weight) in self.interpolation.row(i) {
                for (q, other) in self.interpolation.row(j).filter(|&(q, _)| q <= p) {
                    let range = self.coarse.range(q);
                    if let Some(at) = self.coarse.columns(q).iter().position(|&row| row as usize == p) {
                        values[range.start + at] -= value * f64::from(weight) * f64::from(other);
                    }
                }
            }
        };
        let is_held = |i: usize| held.binary_search(&(i as u32)).is_ok();
        for i in held.iter().map(|&i| i as usize) {
            for (j, stiffness) in self.fine.row(i) {
                let value = f64::from(rate.of(stiffness));
                take(i, j, value);
                if !is_held(j) {
                    take(j, i, value);
                }
            }
        }
        // Their masses stay: what a particle that is held adds to an aggregate only keeps it from being weightless.
        let column = |j: usize| {
            self.coarse.columns(j).iter().map(|&row| row as usize).zip(values[self.coarse.range(j)].iter().copied())
        };
        CoarseFactor { rate, held: held.to_vec(), factor: Factor::new(&self.factor_pattern, column) }
    }
}
