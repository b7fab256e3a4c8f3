//! What strands are made of, scaled to a substep.

use crate::{
    constraint::strand::law::{DirectionModuli, Scaled, TensionOnly},
    material::{Elasticity, Material},
    topology::SpringKind,
};

/// What strands are made of.
#[derive(Clone, Copy, Debug)]
pub(crate) enum StrandMaterial {
    /// Springs that are alike.
    Alike {
        stretch: Scaled,
        /// Between every other node. None where nothing bends.
        bend: Option<Scaled>,
    },
    /// Springs of a level, which only pull.
    LevelSprings(TensionOnly),
    /// The strands of a sheet.
    SheetStrands {
        /// By [`Grain::index`](crate::topology::Grain::index).
        stretch: [DirectionModuli; 2],
        /// B h² and its damping. None where nothing bends.
        rigidity: Option<Scaled>,
    },
}

impl StrandMaterial {
    pub fn new(material: &Material, h: f32) -> Self {
        match &material.elasticity {
            Elasticity::Springs(constants) => {
                let scaled = |kind: SpringKind| Scaled::new(constants[kind.index()], h);
                let bend = Some(scaled(SpringKind::Bend)).filter(Scaled::acts);
                Self::Alike { stretch: scaled(SpringKind::Structural), bend }
            }
            Elasticity::Moduli(moduli) => Self::SheetStrands {
                stretch: DirectionModuli::both(moduli, h),
                rigidity: Some(Scaled::new(moduli.rigidity(), h)).filter(Scaled::acts),
            },
        }
    }

    /// Whether it needs to know where the particles were before the substep.
    pub fn is_damped(&self) -> bool {
        let is_bend_damped = match self {
            Self::Alike { bend, .. } | Self::SheetStrands { rigidity: bend, .. } => {
                bend.is_some_and(|bend| bend.c > 0.0)
            }
            Self::LevelSprings(_) => false,
        };
        is_bend_damped || self.is_stretch_damped()
    }

    /// Constants of stretch alone.
    pub fn is_stretch_damped(&self) -> bool {
        match self {
            Self::Alike { stretch, bend } => stretch.c > 0.0 || bend.is_some_and(|bend| bend.c > 0.0),
            Self::LevelSprings(_) => false,
            Self::SheetStrands { stretch: [warp, _], .. } => warp.damping > 0.0,
        }
    }
}
