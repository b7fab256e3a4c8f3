//! What a cloth is made of.

mod begun;
pub(crate) mod file;
pub(crate) mod handle;
pub(crate) mod loader;
mod presets;
pub(crate) mod resolution;
mod springs;

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use crate::{
    error::{ClothError, check},
    solver::{Elasticity, Material, Moduli},
};

pub use presets::FabricPreset;
pub use springs::ClothSprings;

/// The physical constants of a cloth, as a textile laboratory measures them. Change them at any time: they act in the next
/// step.
///
/// Forces are over the width that they act on: a strip of 5 cm with a stiffness of 1000 N/m takes 50 N to be twice as
/// long, and 0.5 N for one per cent. The same fabric is the same cloth whatever its mesh, as far as the mesh is fine
/// enough for its folds: its edges should be no longer than [`max_edge_length`](Self::max_edge_length), and one warning
/// says so where they are.
///
/// The warp runs along the V axis of a mesh's first UVs, the weft along U; [`ATTRIBUTE_WARP`](crate::prelude::ATTRIBUTE_WARP)
/// says otherwise where a mesh has it, and without both the warp runs along the mesh's own Y. On meshes with rows and
/// columns it is whichever of the two is nearer to that.
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
    /// Thickness in m. 0.0002 for silk, 0.001 for leather. Greater than zero.
    pub thickness: f32,
    /// Stiffness of a strip that is cut along the warp and pulled: force over width and strain, in N/m, at rest. 30 for jersey,
    /// 4000 for a tablecloth.
    /// Greater than zero.
    pub warp_stiffness: f32,
    /// Stiffness of a strip that is cut along the weft and pulled: force over width and strain, in N/m. Greater than zero.
    pub weft_stiffness: f32,
    /// By how much the warp gets stiffer as it is stretched, no unit: a strip that is stretched by a strain takes
    /// `warp_stiffness * (1 + warp_stiffening * strain)` for any more. 0 for most weaves, 10 and more for knits.
    pub warp_stiffening: f32,
    /// How much stiffer the weft becomes as it is stretched, as `warp_stiffening`, no unit.
    pub weft_stiffening: f32,
    /// Share of their stiffness that is left of threads that are pressed together, no unit, 0 to 1: threads buckle where
    /// folds would be too small for the mesh.
    pub compression: f32,
    /// Force over width and shear angle, in N/m. 20 for a loose weave, 100 for a tight one; more for leather and rubber,
    /// which have no threads. At most what fits warp and weft: the product of their stiffnesses over their difference.
    pub shear_stiffness: f32,
    /// Bending rigidity in N·m: moment over width and curvature. 0.000003 for silk, 0.00002 for cotton, 0.00025 for leather.
    pub bending_rigidity: f32,
    /// Inner damping of stretch and shear in s: its force over the stiffness and the rate of strain. 0 to 0.01.
    pub stretch_damping: f32,
    /// Inner damping of bending in s: its moment over the rigidity and the rate of curvature. 0 to 0.1. Cloth that moves twice a
    /// second loses as much as 0.02 (polyester) to 0.05 (cotton) would, by friction between its threads. It takes a tenth of
    /// a step, so the presets go without.
    pub bend_damping: f32,
    /// Damping of the velocity in 1/s: all motion fades to 37 % within 1/damping seconds. 0 to 2.
    pub damping: f32,
    /// Coulomb friction against obstacles, no unit. 0.2 for silk, 0.5 for cotton, 0.9 for rubber.
    pub friction: f32,
    /// Drag coefficient, no unit: force of the air along its flow. About 1.2 for a plate; 0 and no lift for no air.
    pub drag: f32,
    /// Lift coefficient, no unit: force of the air across its flow. 0 to 1; it makes flags flutter.
    pub lift: f32,
}

impl Default for Fabric {
    /// Plain woven cotton.
    fn default() -> Self {
        Self::COTTON_WOVEN
    }
}

impl Fabric {
    /// The constants as the solver reads them, if all are in their range.
    ///
    /// # Errors
    ///
    /// [`ClothError::InvalidParameter`] with the first field that is NaN, infinite, out of its range or doesn't fit the
    /// others.
    pub fn material(&self) -> Result<Material, ClothError> {
        self.check_surface()?;
        let positive = |name, value| check(name, value, value > 0.0, "greater than 0 N/m");
        positive("Fabric::warp_stiffness", self.warp_stiffness)?;
        positive("Fabric::weft_stiffness", self.weft_stiffness)?;
        for (name, value) in [
            ("Fabric::warp_stiffening", self.warp_stiffening),
            ("Fabric::weft_stiffening", self.weft_stiffening),
            ("Fabric::shear_stiffness", self.shear_stiffness),
            ("Fabric::bending_rigidity", self.bending_rigidity),
            ("Fabric::stretch_damping", self.stretch_damping),
            ("Fabric::bend_damping", self.bend_damping),
        ] {
            check(name, value, value >= 0.0, "0 or greater")?;
        }
        check("Fabric::compression", self.compression, (0.0..=1.0).contains(&self.compression), "0 to 1")?;
        let pulled = [self.warp_stiffness, self.weft_stiffness];
        let stiffening = [self.warp_stiffening, self.weft_stiffening];
        let misfit = || ClothError::InvalidParameter {
            name: "Fabric::shear_stiffness".into(),
            value: self.shear_stiffness,
            rule: format!(
                "at most {} N/m, the product of warp and weft stiffness over their difference: with more, a strip would \
                 be stiffer than was measured",
                Moduli::most_shear(pulled)
            ),
        };
        let moduli = Moduli::from_strips(pulled, self.shear_stiffness, stiffening, self.compression);
        let moduli = Moduli {
            bending: self.bending_rigidity,
            stretch_damping: self.stretch_damping,
            bend_damping: self.bend_damping,
            ..moduli.ok_or_else(misfit)?
        };
        Ok(self.with(Elasticity::Moduli(moduli)))
    }

    /// The same, with `springs` in place of stiffness, rigidity and inner damping where there are any.
    ///
    /// # Errors
    ///
    /// [`ClothError::InvalidParameter`] with the first field that is out of its range. Of the fabric, only those count that
    /// springs don't take the place of.
    pub fn material_with(&self, springs: Option<&ClothSprings>) -> Result<Material, ClothError> {
        let Some(springs) = springs else { return self.material() };
        self.check_surface()?;
        Ok(self.with(Elasticity::Springs(springs.constants()?)))
    }

    fn check_surface(&self) -> Result<(), ClothError> {
        check("Fabric::density", self.density, self.density > 0.0, "greater than 0 kg/m²")?;
        check("Fabric::thickness", self.thickness, self.thickness > 0.0, "greater than 0 m")?;
        for (name, value) in [
            ("Fabric::damping", self.damping),
            ("Fabric::friction", self.friction),
            ("Fabric::drag", self.drag),
            ("Fabric::lift", self.lift),
        ] {
            check(name, value, value >= 0.0, "0 or greater")?;
        }
        Ok(())
    }

    fn with(&self, elasticity: Elasticity) -> Material {
        Material {
            damping: self.damping,
            thickness: self.thickness,
            friction: self.friction,
            drag: self.drag,
            lift: self.lift,
            ..Material::bare(self.density, elasticity)
        }
    }
}
