//! Solves strands exactly: chains of springs, and what bends and shears between them.

pub(crate) mod bend_factors;
pub(crate) mod cells;
#[cfg(test)]
mod dense;
pub(crate) mod grid;
pub(crate) mod law;
pub(crate) mod material;
pub(crate) mod packs;
pub(crate) mod pentadiagonal;
pub(crate) mod seam;
pub(crate) mod shear_strands;
pub(crate) mod tridiagonal;
pub(crate) mod twist;
