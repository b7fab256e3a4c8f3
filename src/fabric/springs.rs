//! Plain springs in place of a fabric's moduli.

use bevy::prelude::*;

use crate::{
    error::ClothError,
    parameter::{Parameter, check_parameters},
    solver::SpringConstants,
};

/// The low-level way in: springs that are all alike, next to a cloth, in place of the stiffness, rigidity and inner damping
/// of its [`Fabric`](crate::prelude::Fabric). Change, add or remove it at any time.
///
/// These are the springs of the textbook: what they amount to depends on the size of the mesh's cells. Those against
/// bending join particles two steps apart, which is cheap, and resists no bend of a flat cloth that is small.
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, Clone, PartialEq)]
pub struct ClothSprings {
    /// Stiffness of the springs along the threads in N/m, 0 or more, 5000 by default. 500 for something stretchy, 20 000 for
    /// canvas. Stiffer cloth needs more substeps.
    #[reflect(@Parameter::not_negative("N/m", (0.0, 1e5)).logarithmic(0.1).entered((0.0, 1e8)).titled("Stretch"))]
    pub structural_stiffness: f32,
    /// Stiffness of the springs along the diagonals in N/m, 0 or more, 500 by default: how hard it is to pull the squares of
    /// the weave askew. A tenth of the structural one for most weaves.
    #[reflect(@Parameter::not_negative("N/m", (0.0, 1e5)).logarithmic(0.1).entered((0.0, 1e8)).titled("Shear"))]
    pub shear_stiffness: f32,
    /// Stiffness of the springs between particles two steps apart in N/m, 0 or more, 20 by default. 0.5 for silk, 20 for
    /// cotton, 500 for leather.
    #[reflect(@Parameter::not_negative("N/m", (0.0, 1e5)).logarithmic(0.1).entered((0.0, 1e8)).titled("Bend"))]
    pub bend_stiffness: f32,
    /// Damping along the structural springs in N·s/m, 0 or more, 0 by default. 0 to 0.1. It calms trembling where cloth is
    /// pulled tight.
    #[reflect(@Parameter::not_negative("N·s/m", (0.0, 1.0)).logarithmic(1e-4).entered((0.0, 1e4)).titled("Stretch damping"))]
    pub structural_damping: f32,
    /// Damping along the shear springs in N·s/m, 0 or more, 0 by default. 0 to 0.1.
    #[reflect(@Parameter::not_negative("N·s/m", (0.0, 1.0)).logarithmic(1e-4).entered((0.0, 1e4)))]
    pub shear_damping: f32,
    /// Damping along the bending springs in N·s/m, 0 or more, 0 by default. 0 to 0.1. It calms folds as they open and close.
    #[reflect(@Parameter::not_negative("N·s/m", (0.0, 1.0)).logarithmic(1e-4).entered((0.0, 1e4)))]
    pub bend_damping: f32,
}

impl Default for ClothSprings {
    /// A light weave of cells of 2 cm.
    fn default() -> Self {
        Self {
            structural_stiffness: 5000.0,
            shear_stiffness: 500.0,
            bend_stiffness: 20.0,
            structural_damping: 0.0,
            shear_damping: 0.0,
            bend_damping: 0.0,
        }
    }
}

impl ClothSprings {
    /// The constants by [`SpringKind::index`](crate::solver::SpringKind::index).
    ///
    /// # Errors
    ///
    /// [`ClothError::InvalidParameter`] with the first field that is NaN, infinite or negative.
    pub fn constants(&self) -> Result<[SpringConstants; 3], ClothError> {
        check_parameters(self, |_| true)?;
        let spring = |stiffness, damping| SpringConstants { stiffness, damping };
        Ok([
            spring(self.structural_stiffness, self.structural_damping),
            spring(self.shear_stiffness, self.shear_damping),
            spring(self.bend_stiffness, self.bend_damping),
        ])
    }
}
