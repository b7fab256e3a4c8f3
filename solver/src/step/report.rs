//! What a step did, and why it took as many substeps.

use core::fmt;

use bevy_reflect::Reflect;

use crate::input::ContactRisk;

/// What a step did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepReport {
    /// Substeps taken: of cloths that are stepped together, as many as the one that needs most.
    pub substeps: u32,
    /// Why they were so many.
    pub reason: SubstepReason,
    /// Substeps that [`Method::Explicit`](crate::Method::Explicit) would have needed for the whole stiffness and damping; else
    /// those that this cloth asked for.
    pub needed_substeps: u32,
    /// Share of the asked stiffness and damping that was used, 0..=1. Below one when
    /// [`Method::Explicit`](crate::Method::Explicit) would have needed more than
    /// [`StepSettings::max_substeps`](crate::StepSettings::max_substeps) substeps for the whole.
    pub stiffness_scale: f32,
    /// Contacts in the last substep: of particles with obstacles, and of points, edges and faces with each other. Those of cloths
    /// that are stepped together count for the first.
    pub contacts: u32,
    /// Sum of the external forces and those of the air on all particles, whatever their direction, N.
    pub steady_force: f32,
}

/// Why a step took as many substeps as it did. Each is written out in a few words.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum SubstepReason {
    /// Nothing was stepped: there is no particle, or no time has passed.
    #[default]
    Nothing,
    /// The policy has a fixed number: it was set by hand, or is the default of XPBD.
    Fixed,
    /// So many hold the strain that is aimed at on this mesh.
    Strain,
    /// So many keep the explicit solver stable, as far as it may take them.
    Stability,
    /// No tethers hold it.
    Untethered,
    /// A hand holds it.
    Grabbed,
    /// It is pinned to a body that gives way.
    OnBody,
    /// An obstacle is near.
    Obstacle,
    /// Its triangles and edges may meet its own, or those of other cloth.
    SelfCollision,
    /// A solid with edges is near, or one that is thin.
    SharpEdge,
    /// A solid with a tip is near, or one that fits through a stretched cell.
    SharpTip,
    /// Another cloth that it may touch needs so many.
    OtherCloth,
    /// More were asked for than [`StepContext::substep_limit`](crate::StepContext::substep_limit) allows.
    Budget,
}

impl fmt::Display for SubstepReason {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Nothing => "nothing was stepped",
            Self::Fixed => "a fixed number",
            Self::Strain => "for the strain that is aimed at",
            Self::Stability => "for the explicit solver's stability",
            Self::Untethered => "no tethers hold it",
            Self::Grabbed => "a hand holds it",
            Self::OnBody => "it is pinned to a body",
            Self::Obstacle => "an obstacle is near",
            Self::SelfCollision => "self-collision",
            Self::SharpEdge => "something with edges, or thin, is near",
            Self::SharpTip => "something with a tip, or smaller than a cell, is near",
            Self::OtherCloth => "another cloth that it may touch needs them",
            Self::Budget => "cut by a budget",
        })
    }
}

impl SubstepReason {
    /// What a risk stands for, where it raises the number; `some` says which one of the lesser risks it is.
    pub(super) fn of_risk(risk: ContactRisk, some: Self) -> Self {
        match risk {
            ContactRisk::None => Self::Strain,
            ContactRisk::Limbs | ContactRisk::Some => some,
            ContactRisk::SelfCollision => Self::SelfCollision,
            ContactRisk::Edge(_) | ContactRisk::EdgeSolvedAlong(_) => Self::SharpEdge,
            ContactRisk::Tip(_) | ContactRisk::TipSolvedAlong(_) => Self::SharpTip,
        }
    }
}

impl StepReport {
    /// Of a step that did nothing.
    pub(super) const NOTHING: Self = Self {
        substeps: 0,
        reason: SubstepReason::Nothing,
        needed_substeps: 0,
        stiffness_scale: 1.0,
        contacts: 0,
        steady_force: 0.0,
    };
}
