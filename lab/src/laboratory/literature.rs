//! Fabrics whose constants and drape coefficient were both measured.
//!
//! - Matsudaira, Masuda, Wada, Yokura, "Shape factor of flared skirts compared with that of circular fabrics", Journal of
//!   Textile Engineering 61 (2015), tables 1 and 2. Their rigidity is the slope of the moment beyond its hysteresis, HB. To
//!   a sheet without friction, its part of the moment is added as at a curvature of 40 /m: B + HB / 40. Shear isn't given.
//! - Petrak et al., Sustainability 17 (2025) 1388, tables 1 to 5, with shear; rigidity is the mean of warp and weft, and
//!   hysteresis isn't given: they can be expected to be stiffer than this.
//!
//! Both as others have copied them, without a look into the papers.

use bevy_drape::prelude::Fabric;

/// A fabric of a paper.
pub struct Published {
    pub name: &'static str,
    /// Areal density, kg/m².
    density: f32,
    /// Bending rigidity, µN·m.
    rigidity: f32,
    /// Shear modulus, N/m.
    shear: f32,
    /// Drape coefficient, %.
    pub coefficient: f64,
}

/// What stands in for a shear that wasn't given, N/m.
const SHEAR: f32 = 45.0;

const fn published(name: &'static str, density: f32, rigidity: f32, shear: f32, coefficient: f64) -> Published {
    Published { name, density, rigidity, shear, coefficient }
}

pub const PUBLISHED: [Published; 10] = [
    published("polyester faille, Matsudaira", 0.104, 2.7, SHEAR, 28.3),
    published("wool tropical, Matsudaira", 0.163, 10.6, SHEAR, 49.8),
    published("polyester tropical, Matsudaira", 0.117, 11.1, SHEAR, 50.7),
    published("cotton broadcloth, Matsudaira", 0.124, 27.0, SHEAR, 82.9),
    published("polyester twill, Petrak", 0.135, 1.28, 41.0, 22.3),
    published("polyester plain, Petrak", 0.084, 0.59, 46.0, 22.8),
    published("wool twill, Petrak", 0.179, 2.07, 50.0, 34.9),
    published("polyester viscose twill, Petrak", 0.286, 2.69, 61.0, 28.6),
    published("polyester elastane plain, Petrak", 0.242, 3.55, 57.0, 44.3),
    published("cotton polyester twill, Petrak", 0.253, 5.57, 126.0, 54.9),
];

impl Published {
    /// The fabric, as stiff against stretch as woven cotton.
    pub fn fabric(&self) -> Fabric {
        Fabric {
            density: self.density,
            bending_rigidity: self.rigidity * 1e-6,
            shear_stiffness: self.shear,
            ..Fabric::COTTON_WOVEN
        }
    }
}
