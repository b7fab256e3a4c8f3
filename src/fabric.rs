//! What a cloth is made of.

mod begun;
pub(crate) mod file;
pub(crate) mod handle;
pub(crate) mod loader;
mod presets;

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use crate::{
    error::{ClothError, check},
    solver::{Material, SpringConstants},
};

/// The physical constants of a cloth. Change them at any time: they act in the next step.
///
/// A value out of its range is refused with one warning, and the cloth keeps what it had.
///
/// It is an asset as well, from `*.fabric.ron` files or [`Assets<Fabric>`]: a
/// [`FabricHandle`](crate::prelude::FabricHandle) next to the cloth copies it here. A file has each field once:
///
/// ```
/// # use bevy_drape::prelude::*;
/// let text = Fabric::SILK.to_ron();
/// assert!(text.contains("density: 0.09,"));
/// assert_eq!(Fabric::from_ron(&text), Ok(Fabric::SILK));
/// ```
#[derive(Asset, Component, Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[reflect(Component, Default, Debug, Clone, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Fabric {
    /// Areal density in kg/m². 0.05 for silk, 0.2 for cotton, 0.6 for heavy canvas. Greater than zero.
    pub density: f32,
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
    /// Damping of the velocity in 1/s: all motion fades to 37 % within 1/damping seconds. 0 to 2.
    pub damping: f32,
    /// Distance that the cloth keeps from obstacles in m. 0.002 to 0.02; more where its triangles are large.
    pub thickness: f32,
    /// Coulomb friction against obstacles, no unit. 0.2 for silk, 0.5 for cotton, 0.9 for rubber.
    pub friction: f32,
    /// Drag coefficient, no unit: force of the air along its flow. About 1.2 for a plate; 0 and no lift for no air.
    pub drag: f32,
    /// Lift coefficient, no unit: force of the air across its flow. 0 to 1; it makes flags flutter.
    pub lift: f32,
}

impl Default for Fabric {
    /// A light woven cotton.
    fn default() -> Self {
        Self::LIGHT_WEAVE
    }
}

impl Fabric {
    /// The default, and what the presets don't say.
    const LIGHT_WEAVE: Self = Self {
        density: 0.2,
        structural_stiffness: 5000.0,
        shear_stiffness: 500.0,
        bend_stiffness: 20.0,
        structural_damping: 0.0,
        shear_damping: 0.0,
        bend_damping: 0.0,
        damping: 0.2,
        thickness: 0.005,
        friction: 0.5,
        drag: 1.2,
        lift: 0.4,
    };

    /// The constants as the solver reads them, if all are in their range.
    ///
    /// # Errors
    ///
    /// [`ClothError::InvalidParameter`] with the first field that is NaN, infinite, negative or, for the density, zero.
    pub fn material(&self) -> Result<Material, ClothError> {
        check("Fabric::density", self.density, self.density > 0.0, "greater than 0 kg/m²")?;
        for (name, value) in [
            ("Fabric::structural_stiffness", self.structural_stiffness),
            ("Fabric::shear_stiffness", self.shear_stiffness),
            ("Fabric::bend_stiffness", self.bend_stiffness),
            ("Fabric::structural_damping", self.structural_damping),
            ("Fabric::shear_damping", self.shear_damping),
            ("Fabric::bend_damping", self.bend_damping),
            ("Fabric::damping", self.damping),
            ("Fabric::thickness", self.thickness),
            ("Fabric::friction", self.friction),
            ("Fabric::drag", self.drag),
            ("Fabric::lift", self.lift),
        ] {
            check(name, value, value >= 0.0, "0 or greater")?;
        }
        let spring = |stiffness, damping| SpringConstants { stiffness, damping };
        Ok(Material {
            density: self.density,
            springs: [
                spring(self.structural_stiffness, self.structural_damping),
                spring(self.shear_stiffness, self.shear_damping),
                spring(self.bend_stiffness, self.bend_damping),
            ],
            damping: self.damping,
            thickness: self.thickness,
            friction: self.friction,
            drag: self.drag,
            lift: self.lift,
        })
    }
}
