//! Fabrics to begin with: what laboratories measured where they did, and what is plausible beside it.
//!
//! - Wang, O'Brien, Ramamoorthi, "Data-driven elastic models for cloth", 2011. Their shear carries an uncertainty of a
//!   factor of two. Their bending coefficients belong to an energy k θ² l²/(8 A), as ARCSim has it, where that of a plate
//!   is B θ² l²/(2 A): a rigidity is a quarter of them.
//! - The rigidities that Feng, Huang, Xu, Wang, "Learning-based bending stiffness parameter estimation by a drape tester",
//!   2022, found of 618 fabrics: the median of those of like weight, where a fabric's own isn't known.
//! - Penava, Šimić Penava, Knezić, "Determination of the elastic constants of plain woven fabrics by a tensile test in
//!   various directions", 2014.

use super::Fabric;

/// A fabric to begin with, and which of its constants have been measured.
#[derive(Clone, Debug, PartialEq)]
pub struct FabricPreset {
    /// Name of its file in the repository's `assets/fabrics`, without `.fabric.ron`.
    pub name: &'static str,
    /// Its constants.
    pub fabric: Fabric,
    /// Whose measurements they are, or what they were estimated from.
    pub source: &'static str,
    /// The fields of [`Fabric`] that were measured. All others are plausible.
    pub measured: &'static [&'static str],
}

impl FabricPreset {
    /// Which constants were measured, and by whom, in a few sentences.
    pub fn about(&self) -> String {
        let fields: Vec<String> = self.measured.iter().map(|field| field.replace('_', " ")).collect();
        let measured = match fields.split_last() {
            None => "All of it is plausible, nothing measured".into(),
            Some((only, [])) => format!("Measured: {only}; all else is plausible"),
            Some((last, others)) => format!("Measured: {} and {last}; all else is plausible", others.join(", ")),
        };
        format!("{measured}. {}", self.source)
    }
}

/// The sentence of the docs on what was measured.
macro_rules! measured {
    () => {
        "All of it is plausible, nothing measured"
    };
    ($first:ident $(, $other:ident)*) => {
        concat!("Measured: `", stringify!($first), "`" $(, ", `", stringify!($other), "`")*, "; all else is plausible")
    };
}

/// Makes a constant of each preset and the list of them, so that docs, panel and files say the same of it.
macro_rules! presets {
    ($(
        $(#[doc = $doc:literal])+
        $constant:ident = $name:literal, measured: [$($field:ident),*], source: $source:literal, { $($values:tt)* }
    )+) => {
        impl Fabric {
            $(
                $(#[doc = $doc])+
                #[doc = ""]
                #[doc = concat!(measured!($($field),*), ". ", $source)]
                pub const $constant: Self = Self { $($values)* ..Self::PLAIN };
            )+

            /// All presets.
            pub const PRESETS: [FabricPreset; 8] = [$(
                FabricPreset {
                    name: $name,
                    fabric: Self::$constant,
                    source: $source,
                    measured: &[$(stringify!($field)),*],
                },
            )+];
        }
    };
}

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
        bending_rigidity: 18e-6,
        stretch_damping: 0.0,
        bend_damping: 0.0,
        damping: 0.2,
        friction: 0.5,
        drag: 1.2,
        lift: 0.4,
    };
}

presets! {
    /// Cotton jersey, as in a T-shirt: it stretches, more along than across, and gets stiff where it does.
    COTTON_JERSEY = "cotton_jersey",
    measured: [
        density, warp_stiffness, weft_stiffness, warp_stiffening, weft_stiffening, shear_stiffness, bending_rigidity
    ],
    source: "Wang, O'Brien and Ramamoorthi 2011: interlock T-shirt, 60 % cotton.",
    {
        density: 0.187,
        thickness: 0.0006,
        warp_stiffness: 33.0,
        weft_stiffness: 69.0,
        warp_stiffening: 10.7,
        weft_stiffening: 63.0,
        shear_stiffness: 37.0,
        bending_rigidity: 5e-6,
    }

    /// Plain woven cotton, as in a shirt or a sheet. The default.
    COTTON_WOVEN = "cotton_woven",
    measured: [density, thickness, bending_rigidity],
    source: "Penava et al. 2014: plain woven cotton; its rigidity is the median of such weight of Feng et al. 2022.",
    {}

    /// Denim of 11 oz with a little elastane, as in jeans: folds are few and wide.
    DENIM = "denim",
    measured: [density, warp_stiffness, weft_stiffness, shear_stiffness, bending_rigidity],
    source: "Wang, O'Brien and Ramamoorthi 2011: denim of 11 oz, 99 % cotton; its rigidity is the median of such weight of \
             Feng et al. 2022.",
    {
        density: 0.324,
        thickness: 0.0008,
        warp_stiffness: 411.0,
        weft_stiffness: 2028.0,
        shear_stiffness: 53.0,
        bending_rigidity: 40e-6,
        friction: 0.6,
    }

    /// A tablecloth of polyester.
    POLYESTER_TABLECLOTH = "polyester_tablecloth",
    measured: [density, warp_stiffness, weft_stiffness, shear_stiffness, bending_rigidity],
    source: "Wang, O'Brien and Ramamoorthi 2011: polyester tablecloth. It is as thick as the polyester of Penava et al. \
             2014.",
    {
        density: 0.128,
        thickness: 0.000_25,
        warp_stiffness: 4004.0,
        weft_stiffness: 4055.0,
        shear_stiffness: 19.0,
        bending_rigidity: 10e-6,
        friction: 0.4,
    }

    /// Light woven silk: limp and smooth.
    SILK = "silk",
    measured: [density],
    source: "A silk of 21 momme, the trade's measure of its weight. Its rigidity is near the median of such weight of Feng et \
             al. 2022.",
    {
        density: 0.09,
        thickness: 0.000_15,
        warp_stiffness: 2000.0,
        weft_stiffness: 2000.0,
        shear_stiffness: 20.0,
        bending_rigidity: 3e-6,
        friction: 0.25,
    }

    /// Wool flannel: soft, and it gives.
    WOOL_FLANNEL = "wool_flannel",
    measured: [density, thickness],
    source: "Penava et al. 2014: plain woven wool.",
    {
        density: 0.235,
        thickness: 0.000_57,
        warp_stiffness: 2400.0,
        weft_stiffness: 1600.0,
        shear_stiffness: 45.0,
        bending_rigidity: 12e-6,
        friction: 0.45,
    }

    /// Leather of 1 mm, as in a saddlebag: it hardly folds.
    LEATHER = "leather",
    measured: [],
    source: "Its density is the one that Unreal Engine gives heavy leather; its rigidity goes with the thickness cubed from \
             garment leathers of 0.6 to 1 mm, Memon et al. 2021.",
    {
        density: 0.6,
        thickness: 0.001,
        warp_stiffness: 12_000.0,
        weft_stiffness: 12_000.0,
        shear_stiffness: 4000.0,
        bending_rigidity: 250e-6,
        friction: 0.6,
    }

    /// A rubber sheet of 1 mm: heavy and stretchy, and it sticks.
    RUBBER = "rubber",
    measured: [],
    source: "Estimated from a modulus of 1.5 MPa: times the thickness for the stiffness, a third of that for the shear, \
             times the thickness cubed over nine for the rigidity.",
    {
        density: 1.1,
        thickness: 0.001,
        warp_stiffness: 1500.0,
        weft_stiffness: 1500.0,
        shear_stiffness: 500.0,
        bending_rigidity: 150e-6,
        friction: 0.9,
    }
}
