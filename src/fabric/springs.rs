//! Plain springs in place of a fabric's moduli.

use bevy::prelude::*;

use crate::{
    error::{ClothError, check},
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
    /// Stiffness of the springs along the threads in N/m. 500 for something stretchy, 20 000 for canvas.
    pub structural_stiffness: f32,
    /// Stiffness of the springs along the diagonals in N/m. A tenth of the structural one for most weaves.
    pub shear_stiffness: f32,
    /// Stiffness of the springs between particles two steps apart in N/m. 0.5 for silk, 20 for cotton, 500 for leather.
    pub bend_stiffness: f32,
    /// Damping along the structural springs in N·s/m. 0 to 0.1.
    pub structural_damping: f32,
    /// Damping along the shear springs in N·s/m. 0 to 0.1.
    pub shear_damping: f32,
    /// Damping along the bending springs in N·s/m. 0 to 0.1.
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
        for (name, value) in [
            ("ClothSprings::structural_stiffness", self.structural_stiffness),
            ("ClothSprings::shear_stiffness", self.shear_stiffness),
            ("ClothSprings::bend_stiffness", self.bend_stiffness),
            ("ClothSprings::structural_damping", self.structural_damping),
            ("ClothSprings::shear_damping", self.shear_damping),
            ("ClothSprings::bend_damping", self.bend_damping),
        ] {
            check(name, value, value >= 0.0, "0 or greater")?;
        }
        let spring = |stiffness, damping| SpringConstants { stiffness, damping };
        Ok([
            spring(self.structural_stiffness, self.structural_damping),
            spring(self.shear_stiffness, self.shear_damping),
            spring(self.bend_stiffness, self.bend_damping),
        ])
    }
}
