//! Whether a cloth runs, and what is announced of that.

use bevy::prelude::*;

use crate::error::ClothError;

/// Whether an entity's cloth runs, and if not, why not.
#[derive(Component, Clone, Debug, Default, PartialEq, Reflect)]
#[component(clone_behavior = Ignore)]
#[reflect(Component, Default, Debug, Clone, PartialEq)]
pub enum ClothStatus {
    /// The mesh isn't there yet; the cloth is built as soon as it is.
    #[default]
    Waiting,
    /// The mesh is large and is made into cloth beside the frames. It is drawn as it is until that is done.
    Building,
    /// The cloth is simulated. Where its mesh is changed or it is reset, it stays so until the new cloth is done.
    Ready,
    /// The cloth has come to rest, for half a second by no more than 0.1 mm, and costs next to nothing until something changes:
    /// an obstacle, a pin, a hand, a force, a setting, gravity, its transform, cloth nearby. Then it is [`Ready`](Self::Ready) in
    /// the same step. It stays awake in any wind, and near bodies that cloth pushes.
    /// [`ClothSleepingDisabled`](crate::prelude::ClothSleepingDisabled) keeps it awake always.
    Asleep,
    /// The cloth can't be built. It is tried again when the mesh or any of the cloth's components change.
    Failed(ClothError),
}

impl ClothStatus {
    /// Whether the mesh is cloth by now, awake or asleep: there are particles to look at.
    pub fn is_running(&self) -> bool {
        matches!(self, Self::Ready | Self::Asleep)
    }
}

/// A mesh has become cloth. Its [`ClothState`](crate::prelude::ClothState) can be read from now on.
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClothReady {
    /// The cloth.
    pub entity: Entity,
}

/// A mesh can't become cloth.
#[derive(EntityEvent, Clone, Debug, PartialEq)]
pub struct ClothFailed {
    /// The cloth.
    pub entity: Entity,
    /// Why.
    pub error: ClothError,
}

/// A cloth has been put back.
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClothReset {
    /// The cloth.
    pub entity: Entity,
    /// Why, and to which pose.
    pub cause: ResetCause,
}

/// Why a cloth has been put back.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Reflect)]
#[reflect(Debug, Clone, PartialEq)]
pub enum ResetCause {
    /// [`reset_cloth`](crate::prelude::ClothCommands::reset_cloth): it is back in its rest shape.
    Requested,
    /// Its mesh has changed: it is in its new rest shape.
    Rebuilt,
    /// A position or velocity was no longer finite: it is in its last finite pose, at rest.
    NotFinite,
}
