//! The component that makes a mesh cloth, what it reports, and what it announces.

use bevy::prelude::*;

use crate::{
    error::{ClothError, check},
    fabric::Fabric,
    pins::Pins,
    solver::Method,
    state::ClothState,
};

/// How the springs are integrated. Both read the same physical constants.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Default, Debug, Clone, PartialEq)]
pub enum ClothSolver {
    /// Extended position-based dynamics: stable at any stiffness and time step. For games.
    #[default]
    Xpbd,
    /// Forces and symplectic Euler, the textbook form: the most accurate, and many times as costly. It takes the
    /// substeps that stability needs, up to [`Cloth::max_substeps`].
    Explicit,
}

impl From<ClothSolver> for Method {
    fn from(solver: ClothSolver) -> Self {
        match solver {
            ClothSolver::Xpbd => Self::Xpbd,
            ClothSolver::Explicit => Self::Explicit,
        }
    }
}

/// Makes the entity's [`Mesh3d`] cloth. All else comes with it: [`Fabric`], [`Pins`], state and status.
///
/// Add, change or remove it at any time. Removing it leaves the mesh as it is drawn at that moment.
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, Clone, PartialEq)]
#[require(Fabric, Pins, ClothState, ClothStatus, Transform)]
pub struct Cloth {
    /// How the springs are integrated.
    pub solver: ClothSolver,
    /// Substeps per step of [`ClothSolver::Xpbd`]: at least 1. 8 for most, 16 and more for fine meshes.
    pub substeps: u32,
    /// The most substeps that [`ClothSolver::Explicit`] may take per step. Where that isn't enough, stiffness and
    /// damping are cut down to what is stable, and one warning says so.
    pub max_substeps: u32,
    /// Factor on [`ClothGravity`], no unit. 0 floats, negative rises.
    pub gravity_scale: f32,
    /// By how much of its length a tether gives, no unit, 0 or more; 0.002 to 0.01 for cloth. `None` for no tethers.
    ///
    /// Tethers keep every particle within the cloth's own length of its pins: the cure for cloth that stretches like
    /// rubber. Only [`ClothSolver::Xpbd`] has them.
    pub tether_slack: Option<f32>,
    /// Density of the air around in kg/m³. 1.225 at sea level, 0 for a vacuum.
    pub fluid_density: f32,
    /// Which obstacles the cloth meets: those whose [`ClothCollider::layers`](crate::prelude::ClothCollider::layers)
    /// have a bit in common with it.
    pub collision_mask: u32,
}

impl Default for Cloth {
    fn default() -> Self {
        Self {
            solver: ClothSolver::default(),
            substeps: 8,
            max_substeps: 512,
            gravity_scale: 1.0,
            tether_slack: Some(0.005),
            fluid_density: 1.225,
            collision_mask: u32::MAX,
        }
    }
}

/// A step of more substeps than this would look like a program that hangs.
const MOST_SUBSTEPS: u32 = 10_000;

impl Cloth {
    /// Checks the ranges of all settings.
    ///
    /// # Errors
    ///
    /// [`ClothError::InvalidParameter`] with the first field that is out of its range.
    pub fn validate(&self) -> Result<(), ClothError> {
        let count = |name, value: u32| check(name, value as f32, (1..=MOST_SUBSTEPS).contains(&value), "1 to 10000");
        count("Cloth::substeps", self.substeps)?;
        count("Cloth::max_substeps", self.max_substeps)?;
        check("Cloth::gravity_scale", self.gravity_scale, true, "finite")?;
        let slack = self.tether_slack.unwrap_or_default();
        check("Cloth::tether_slack", slack, slack >= 0.0, "0 or greater, or `None`")?;
        let air = self.fluid_density;
        check("Cloth::fluid_density", air, air >= 0.0, "0 kg/m³ or greater")
    }
}

/// Whether an entity's cloth runs, and if not, why not.
#[derive(Component, Clone, Debug, Default, PartialEq, Reflect)]
#[component(clone_behavior = Ignore)]
#[reflect(Component, Default, Debug, Clone, PartialEq)]
pub enum ClothStatus {
    /// The mesh isn't there yet; the cloth is built as soon as it is.
    #[default]
    Waiting,
    /// The cloth is simulated.
    Ready,
    /// The cloth can't be built. It is tried again when the mesh or any of the cloth's components change.
    Failed(ClothError),
}

/// Gravity on all cloth, m/s². Earth's along -Y by default. None while it isn't finite, with one warning.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Resource, Default, Debug, Clone, PartialEq)]
pub struct ClothGravity(pub Vec3);

impl Default for ClothGravity {
    fn default() -> Self {
        Self(Vec3::NEG_Y * 9.81)
    }
}

/// A mesh has become cloth. Its [`ClothState`] can be read from now on.
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
