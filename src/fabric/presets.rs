//! Fabrics to begin with: what laboratories measured where they did, and what is plausible beside it.
//!
//! - Wang, O'Brien, Ramamoorthi, "Data-driven elastic models for cloth", 2011: jersey (their interlock T-shirt), denim,
//!   the polyester tablecloth. Their shear carries an uncertainty of a factor of two.
//! - Penava et al., "Determination of the elastic constants of plain woven fabrics", 2014: density and thickness of cotton
//!   and wool.

use super::Fabric;

impl Fabric {
    /// What the presets have in common.
    const PLAIN: Self = Self {
        density: 0.15,
        thickness: 0.000_32,
        warp_stiffness: 4000.0,
        weft_stiffness: 4000.0,
        warp_stiffening: 0.0,
        weft_stiffening: 0.0,
        compression: 1.0,
        shear_stiffness: 50.0,
        bending_rigidity: 40e-6,
        stretch_damping: 0.0,
        bend_damping: 0.0,
        damping: 0.2,
        friction: 0.5,
        drag: 1.2,
        lift: 0.4,
    };

    /// Cotton jersey, as in a T-shirt: it stretches, more across than along, and gets stiff where it does.
    pub const COTTON_JERSEY: Self = Self {
        density: 0.187,
        thickness: 0.0006,
        warp_stiffness: 33.0,
        weft_stiffness: 69.0,
        warp_stiffening: 10.7,
        weft_stiffening: 63.0,
        shear_stiffness: 37.0,
        bending_rigidity: 21e-6,
        friction: 0.5,
        ..Self::PLAIN
    };

    /// Plain woven cotton, as in a shirt or a sheet.
    pub const COTTON_WOVEN: Self = Self::PLAIN;

    /// Denim of 11 oz with a little elastane, as in jeans: folds are few and wide.
    pub const DENIM: Self = Self {
        density: 0.324,
        thickness: 0.0008,
        warp_stiffness: 411.0,
        weft_stiffness: 2028.0,
        shear_stiffness: 53.0,
        bending_rigidity: 77e-6,
        friction: 0.6,
        ..Self::PLAIN
    };

    /// A tablecloth of polyester.
    pub const POLYESTER_TABLECLOTH: Self = Self {
        density: 0.128,
        thickness: 0.000_25,
        warp_stiffness: 4004.0,
        weft_stiffness: 4055.0,
        shear_stiffness: 19.0,
        bending_rigidity: 41e-6,
        friction: 0.4,
        ..Self::PLAIN
    };

    /// Light woven silk: limp and smooth.
    pub const SILK: Self = Self {
        density: 0.09,
        thickness: 0.000_15,
        warp_stiffness: 2000.0,
        weft_stiffness: 2000.0,
        shear_stiffness: 20.0,
        bending_rigidity: 4e-6,
        friction: 0.25,
        ..Self::PLAIN
    };

    /// Wool flannel: soft, and it gives.
    pub const WOOL_FLANNEL: Self = Self {
        density: 0.235,
        thickness: 0.000_57,
        warp_stiffness: 1000.0,
        weft_stiffness: 1000.0,
        shear_stiffness: 40.0,
        bending_rigidity: 12e-6,
        friction: 0.45,
        ..Self::PLAIN
    };

    /// Leather of 1 mm, as in a saddlebag: it hardly folds.
    pub const LEATHER: Self = Self {
        density: 0.6,
        thickness: 0.001,
        warp_stiffness: 15_000.0,
        weft_stiffness: 15_000.0,
        shear_stiffness: 4000.0,
        bending_rigidity: 1e-3,
        friction: 0.6,
        ..Self::PLAIN
    };

    /// A rubber sheet of 1 mm: heavy and stretchy, and it sticks.
    pub const RUBBER: Self = Self {
        density: 1.1,
        thickness: 0.001,
        warp_stiffness: 1500.0,
        weft_stiffness: 1500.0,
        shear_stiffness: 500.0,
        bending_rigidity: 170e-6,
        friction: 0.9,
        ..Self::PLAIN
    };

    /// All presets, by the names of their files in the repository's `assets/fabrics`.
    pub const PRESETS: [(&'static str, Self); 8] = [
        ("cotton_jersey", Self::COTTON_JERSEY),
        ("cotton_woven", Self::COTTON_WOVEN),
        ("denim", Self::DENIM),
        ("polyester_tablecloth", Self::POLYESTER_TABLECLOTH),
        ("silk", Self::SILK),
        ("wool_flannel", Self::WOOL_FLANNEL),
        ("leather", Self::LEATHER),
        ("rubber", Self::RUBBER),
    ];
}
