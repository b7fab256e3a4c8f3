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
    error::ClothError,
    parameter::{Parameter, check_parameters},
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
    /// Areal density in kg/m², greater than 0. 0.05 for silk, 0.2 for cotton, 0.6 for heavy canvas. Heavier cloth stretches
    /// more and is moved less by wind.
    #[reflect(@Parameter::positive("kg/m²", (0.02, 2.0)).logarithmic(0.02).entered((1e-3, 1e3)))]
    pub density: f32,
    /// Thickness in m, greater than 0. 0.0002 for silk, 0.001 for leather. `collision_margin` of the cloth is kept from
    /// obstacles besides.
    #[reflect(@Parameter::positive("m", (5e-5, 5e-3)).logarithmic(5e-5).entered((1e-6, 0.1)).shown_as("mm", 1e3))]
    pub thickness: f32,
    /// Stiffness of a strip that is cut along the warp and pulled: force over width and strain, in N/m, at rest, greater
    /// than 0. 30 for jersey, 400 for denim with elastane, 4000 for a tablecloth. It has to be near enough to the weft's for
    /// the shear stiffness: lower that first.
    #[reflect(@Parameter::positive("N/m", (1.0, 1e5)).logarithmic(1.0).entered((0.01, 1e8)))]
    pub warp_stiffness: f32,
    /// Stiffness of a strip that is cut along the weft and pulled: force over width and strain, in N/m, at rest, greater
    /// than 0. 30 to 20 000. It has to be near enough to the warp's for the shear stiffness: lower that first.
    #[reflect(@Parameter::positive("N/m", (1.0, 1e5)).logarithmic(1.0).entered((0.01, 1e8)))]
    pub weft_stiffness: f32,
    /// Strain stiffening of the warp, no unit, 0 or more: a strip that is stretched by a strain takes
    /// `warp_stiffness * (1 + warp_stiffening * strain)` for any more. 0 for most weaves, 10 and more for knits.
    #[reflect(@Parameter::not_negative("", (0.0, 200.0)).logarithmic(0.1).entered((0.0, 1e4)))]
    pub warp_stiffening: f32,
    /// Strain stiffening of the weft, no unit, 0 or more: a strip that is stretched by a strain takes
    /// `weft_stiffness * (1 + weft_stiffening * strain)` for any more. 0 for most weaves, 10 and more for knits.
    #[reflect(@Parameter::not_negative("", (0.0, 200.0)).logarithmic(0.1).entered((0.0, 1e4)))]
    pub weft_stiffening: f32,
    /// Stiffness under compression as a share of that under tension, no unit, 0 to 1. Less lets threads buckle where folds
    /// would be too small for the mesh.
    #[reflect(@Parameter::within("", (0.0, 1.0), (0.0, 1.0)))]
    pub compression: f32,
    /// Shear stiffness: force over width and shear angle, in N/m, 0 or more: how hard it is to pull the squares of the weave askew. 20 for a
    /// loose weave, 100 for a tight one; more for leather and rubber, which have no threads. At most what fits warp and
    /// weft: the product of their stiffnesses over their difference.
    #[reflect(@Parameter::not_negative("N/m", (0.0, 1e4)).logarithmic(0.1).entered((0.0, 1e8)))]
    pub shear_stiffness: f32,
    /// Bending rigidity in N·m, 0 or more: moment over width and curvature, how stiff it is against folds. 0.000003 for silk,
    /// 0.00002 for cotton, 0.00025 for leather.
    #[reflect(@Parameter::not_negative("N·m", (0.0, 1e-2)).logarithmic(1e-7).entered((0.0, 1.0)).shown_as("µN·m", 1e6))]
    pub bending_rigidity: f32,
    /// Inner damping of stretch and shear in s, 0 or more: its force over the stiffness and the rate of strain. 0 to 0.01. It
    /// calms trembling where cloth is pulled tight.
    #[reflect(@Parameter::not_negative("s", (0.0, 0.1)).logarithmic(1e-4).entered((0.0, 10.0)).shown_as("ms", 1e3))]
    pub stretch_damping: f32,
    /// Inner damping of bending in s, 0 or more: its moment over the rigidity and the rate of curvature. 0 to 0.1. It calms
    /// folds as they open and close.
    ///
    /// Cloth that moves twice a second loses as much as 0.02 (polyester) to 0.05 (cotton) would, by friction between its
    /// threads. It takes a tenth of a step, so the presets go without.
    #[reflect(@Parameter::not_negative("s", (0.0, 1.0)).logarithmic(1e-4).entered((0.0, 10.0)).shown_as("ms", 1e3))]
    pub bend_damping: f32,
    /// Damping of the velocity in 1/s, 0 or more: all motion fades to 37 % within 1/damping seconds. 0 to 2.
    #[reflect(@Parameter::not_negative("1/s", (0.0, 5.0)).entered((0.0, 1e4)))]
    pub damping: f32,
    /// Coulomb friction against obstacles, no unit, 0 or more. 0.2 for silk, 0.5 for cotton, 0.9 for rubber; 0 lets it slide
    /// off.
    #[reflect(@Parameter::not_negative("", (0.0, 1.5)).entered((0.0, 100.0)))]
    pub friction: f32,
    /// Drag coefficient, no unit, 0 or more: force of the air along its flow. About 1.2 for a plate; 0 and no lift for no air.
    #[reflect(@Parameter::not_negative("", (0.0, 3.0)).entered((0.0, 100.0)))]
    pub drag: f32,
    /// Lift coefficient, no unit, 0 or more: force of the air across its flow. 0 to 1; it makes flags flutter.
    #[reflect(@Parameter::not_negative("", (0.0, 2.0)).entered((0.0, 100.0)))]
    pub lift: f32,
}

impl Default for Fabric {
    /// Plain woven cotton.
    fn default() -> Self {
        Self::COTTON_WOVEN
    }
}

impl Fabric {
    /// The fields that plain springs take the place of.
    pub(crate) const ELASTIC: [&str; 9] = [
        "warp_stiffness",
        "weft_stiffness",
        "warp_stiffening",
        "weft_stiffening",
        "compression",
        "shear_stiffness",
        "bending_rigidity",
        "stretch_damping",
        "bend_damping",
    ];

    /// The constants as the solver reads them, if all are in their range.
    ///
    /// # Errors
    ///
    /// [`ClothError::InvalidParameter`] with the first field that is NaN, infinite, out of its range or doesn't fit the
    /// others.
    pub fn material(&self) -> Result<Material, ClothError> {
        check_parameters(self, |_| true)?;
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
        check_parameters(self, |field| !Self::ELASTIC.contains(&field))?;
        Ok(self.with(Elasticity::Springs(springs.constants()?)))
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
