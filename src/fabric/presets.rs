//! Fabrics to begin with.
//!
//! All are plausible rather than measured: springs along threads, diagonals and bends can't carry what a laboratory
//! measures. Densities and frictions are rounded from literature, stiffnesses keep its order. The thickness is the
//! distance kept from obstacles, in the order of the true one and several times as large.
//!
//! - Wang, O'Brien, Ramamoorthi, "Data-driven elastic models for cloth", 2011: denim, and the order of bending.
//! - Penava et al., "Determination of the elastic constants of plain woven fabrics", 2014: cotton and wool.

use super::Fabric;

impl Fabric {
    /// Light woven silk: limp and smooth. Plausible rather than measured; modelled on plain silk of 0.09 kg/m².
    pub const SILK: Self = Self {
        density: 0.09,
        structural_stiffness: 2500.0,
        shear_stiffness: 250.0,
        bend_stiffness: 0.5,
        thickness: 0.002,
        friction: 0.25,
        ..Self::LIGHT_WEAVE
    };

    /// Plain woven cotton, as in a shirt or a sheet. Plausible rather than measured; density and thickness follow
    /// Penava's cotton of 0.15 kg/m² and 0.32 mm.
    pub const COTTON: Self = Self {
        density: 0.15,
        structural_stiffness: 4000.0,
        shear_stiffness: 400.0,
        bend_stiffness: 20.0,
        thickness: 0.003,
        friction: 0.5,
        ..Self::LIGHT_WEAVE
    };

    /// Denim as in jeans: folds are few and wide. Plausible rather than measured; density and bending follow Wang's
    /// denim of 11 oz, its stiffness is that of one without elastane.
    pub const DENIM: Self = Self {
        density: 0.32,
        structural_stiffness: 8000.0,
        shear_stiffness: 800.0,
        bend_stiffness: 40.0,
        thickness: 0.006,
        friction: 0.6,
        ..Self::LIGHT_WEAVE
    };

    /// Wool flannel: soft, and it gives. Plausible rather than measured; density and thickness follow Penava's wool of
    /// 0.235 kg/m² and 0.57 mm.
    pub const WOOL: Self = Self {
        density: 0.235,
        structural_stiffness: 1200.0,
        shear_stiffness: 120.0,
        bend_stiffness: 6.0,
        thickness: 0.004,
        friction: 0.45,
        ..Self::LIGHT_WEAVE
    };

    /// Heavy leather, as in a saddlebag: it hardly folds. Plausible rather than measured; modelled on a hide of 1 mm
    /// and 0.6 kg/m², whose diagonals are stiff, as it has no weave.
    pub const LEATHER: Self = Self {
        density: 0.6,
        structural_stiffness: 20_000.0,
        shear_stiffness: 4000.0,
        bend_stiffness: 500.0,
        thickness: 0.008,
        friction: 0.6,
        ..Self::LIGHT_WEAVE
    };

    /// A rubber sheet: heavy and stretchy, and it sticks. Plausible rather than measured; modelled on 1 mm with a
    /// Young's modulus of 1.5 MPa.
    pub const RUBBER: Self = Self {
        density: 1.1,
        structural_stiffness: 1500.0,
        shear_stiffness: 500.0,
        bend_stiffness: 85.0,
        thickness: 0.008,
        friction: 0.9,
        ..Self::LIGHT_WEAVE
    };

    /// All presets, by the names of their files in the repository's `assets/fabrics`.
    pub const PRESETS: [(&'static str, Self); 6] = [
        ("silk", Self::SILK),
        ("cotton", Self::COTTON),
        ("denim", Self::DENIM),
        ("wool", Self::WOOL),
        ("leather", Self::LEATHER),
        ("rubber", Self::RUBBER),
    ];
}
