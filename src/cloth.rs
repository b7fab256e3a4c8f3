//! The component that makes a mesh cloth, and the settings that are in force.

use bevy::prelude::*;

use crate::{
    error::{ClothError, check},
    fabric::Fabric,
    pins::Pins,
    solver::{LevelPass, Method, SelfCollision, SubstepPolicy, Topology},
    state::{
        ClothAttachments, ClothGrabs, ClothReport, ClothState, ClothStatus, PendingBuild, Requests, StepInput, Warned,
    },
};

mod in_force;
pub(crate) mod margin;
pub(crate) mod resolution;
pub(crate) mod update;

pub(crate) use in_force::InForce;

/// How a cloth is moved on in time. All three read the same physical constants.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Default, Debug, Clone, PartialEq)]
pub enum ClothSolver {
    /// Each strand of a regular mesh solved exactly, and coarse levels for the long waves: the least stretch for the time
    /// that it takes, stable at any stiffness and time step. For games.
    #[default]
    Strands,
    /// Extended position-based dynamics, one constraint after the other: stable as well, and stretched more.
    Xpbd,
    /// Forces and symplectic Euler, the textbook form: the most accurate, and many times as costly. It takes the
    /// substeps that stability needs, up to [`Cloth::max_substeps`].
    Explicit,
}

impl From<ClothSolver> for Method {
    fn from(solver: ClothSolver) -> Self {
        match solver {
            ClothSolver::Strands => Self::Strands,
            ClothSolver::Xpbd => Self::Xpbd,
            ClothSolver::Explicit => Self::Explicit,
        }
    }
}

/// Makes the entity's [`Mesh3d`] cloth. All else comes with it: [`Fabric`], [`Pins`], state and status.
///
/// A mesh of up to 10,000 triangles is cloth from the next frame on. A larger one is worked on beside the frames, drawn
/// as it is, until [`ClothReady`] is sent; pins, fabric, settings and transform count as they are then.
///
/// Skins and morph targets aren't followed yet. The cloth is simulated and drawn from the mesh's bind pose, at the entity's
/// own transform, and one warning says so. Meanwhile the entity has neither `SkinnedMesh` nor `MeshMorphWeights`: they come
/// back when [`Mesh3d`] is set to another mesh.
///
/// Add, change or remove it at any time. Removing it leaves the mesh as it is drawn at that moment.
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, Clone, PartialEq)]
#[require(Fabric, Pins, Transform)]
#[require(ClothState, ClothAttachments, ClothGrabs, ClothReport, ClothStatus)]
#[require(InForce, PendingBuild, Requests, StepInput, Warned)]
pub struct Cloth {
    /// How it is moved on in time.
    pub solver: ClothSolver,
    /// Largest strain of threads that is aimed at, no unit, if their stiffness can hold it: 0.001 to 0.1. What
    /// [`ClothSolver::Strands`] chooses [`substeps`](Self::substeps) and [`levels`](Self::levels) by, where they aren't
    /// set by hand. The smaller, the more it costs, and the livelier the cloth.
    pub max_strain: f32,
    /// Substeps per step, at least 1. `None` for as many as [`max_strain`](Self::max_strain) needs; on a mesh without rows and
    /// columns at least 8, three for each ten vertices along a side, and up to 32 where triangles are narrow; at least 8 near
    /// obstacles, in a hand and without tethers; half as many more with [`SelfCollision::Robust`], 16 at least; three times
    /// as many, 32 at least, near solids with edges, and thin ones, and twice that near tips. With [`ClothSolver::Xpbd`] for 8.
    pub substeps: Option<u32>,
    /// Iterations of the coarse levels of [`ClothSolver::Strands`] in each substep, of which only cloth with tethers has
    /// any. `None` for those that [`max_strain`](Self::max_strain) or the [`substeps`](Self::substeps) need, an empty list
    /// for none of them.
    pub levels: Option<Vec<LevelPass>>,
    /// The most substeps that [`ClothSolver::Explicit`] may take per step. Where that isn't enough, stiffness and
    /// damping are cut down to what is stable, and one warning says so.
    pub max_substeps: u32,
    /// Factor on [`ClothGravity`], no unit. 0 floats, negative rises.
    pub gravity_scale: f32,
    /// By how much of its length a tether gives, no unit, 0 or more; 0.002 to 0.01 for cloth. `None` for no tethers. It
    /// comes on top of what the fabric's own weight stretches it, which shows with knits.
    ///
    /// Tethers keep every particle within the cloth's own length of its pins: the cure for cloth that stretches like
    /// rubber. [`ClothSolver::Explicit`] hasn't them.
    pub tether_slack: Option<f32>,
    /// Largest speed of a particle relative to what the cloth is pinned to, m/s, greater than 0. It keeps single
    /// particles from thrashing about; 50 is faster than any storm.
    pub max_velocity: f32,
    /// Density of the air around in kg/m³. 1.225 at sea level, 0 for a vacuum.
    pub fluid_density: f32,
    /// Distance in m that the cloth keeps from obstacles beyond its fabric's thickness, 0 or more. 0.002 to 0.02: the more the
    /// larger its triangles are, so that no corner of an obstacle shows between its particles. More than a quarter of the
    /// cloth's width counts as that, with one warning.
    pub collision_margin: f32,
    /// The most in m/s that cloth which finds itself inside of an obstacle, or too near to other cloth, leaves it by,
    /// greater than 0. 0.5 to 3: more gets out sooner, and looks like a blow.
    pub max_depenetration_velocity: f32,
    /// How the cloth collides with itself, and with other cloths for which this isn't off either. Off by default, since it costs.
    pub self_collision: SelfCollision,
    /// Distance in m that parts of cloth keep from each other, greater than 0. 0.002 to 0.01. Parts that are nearer to each
    /// other at rest stay so. More than four edges of the mesh count as four.
    pub self_distance: f32,
    /// Coulomb friction of cloth on cloth, no unit, 0 or more. 0.1 for silk, 0.4 for wool.
    pub self_friction: f32,
    /// Layers that the cloth is in for other cloths, one a bit. Two meet where each is in the other's mask.
    pub collision_layers: u32,
    /// Which obstacles and cloths the cloth meets: those whose
    /// [`ClothCollider::layers`](crate::prelude::ClothCollider::layers), or `collision_layers`, have a bit in common with
    /// it.
    pub collision_mask: u32,
}

impl Default for Cloth {
    fn default() -> Self {
        Self {
            solver: ClothSolver::default(),
            max_strain: 0.01,
            substeps: None,
            levels: None,
            max_substeps: 512,
            gravity_scale: 1.0,
            tether_slack: Some(0.005),
            max_velocity: 50.0,
            fluid_density: 1.225,
            collision_margin: 0.005,
            max_depenetration_velocity: 1.0,
            self_collision: SelfCollision::Off,
            self_distance: 0.004,
            self_friction: 0.3,
            collision_layers: 1,
            collision_mask: u32::MAX,
        }
    }
}

/// A step of more substeps than this would look like a program that hangs.
const MOST_SUBSTEPS: u32 = 10_000;

/// The same for the iterations of a level.
const MOST_ITERATIONS: u32 = 1000;

/// Substeps of [`ClothSolver::Xpbd`], where they aren't set.
const XPBD_SUBSTEPS: u32 = 8;

impl Cloth {
    /// Substeps and levels for a mesh.
    pub(crate) fn substep_policy(&self, topology: &Topology) -> SubstepPolicy {
        let has_strands = self.solver == ClothSolver::Strands;
        let mut policy = match self.substeps {
            Some(substeps) if has_strands => {
                SubstepPolicy::fixed(substeps, SubstepPolicy::levels_for(substeps, topology))
            }
            None if has_strands => SubstepPolicy::to_hold(self.max_strain, topology),
            substeps => SubstepPolicy::fixed(substeps.unwrap_or(XPBD_SUBSTEPS), Vec::new()),
        };
        if let Some(levels) = &self.levels {
            policy.levels.clone_from(levels);
            policy.contact_levels.clone_from(levels);
        }
        policy
    }

    /// Checks the ranges of all settings.
    ///
    /// # Errors
    ///
    /// [`ClothError::InvalidParameter`] with the first field that is out of its range.
    pub fn validate(&self) -> Result<(), ClothError> {
        let count = |name, value: u32| check(name, value as f32, (1..=MOST_SUBSTEPS).contains(&value), "1 to 10000");
        let strain = self.max_strain;
        check("Cloth::max_strain", strain, strain > 0.0, "greater than 0")?;
        count("Cloth::substeps", self.substeps.unwrap_or(1))?;
        let iterations = self.levels.iter().flatten().map(|level| level.iterations).max().unwrap_or(0);
        check("Cloth::levels", iterations as f32, iterations <= MOST_ITERATIONS, "0 to 1000 iterations")?;
        count("Cloth::max_substeps", self.max_substeps)?;
        check("Cloth::gravity_scale", self.gravity_scale, true, "finite")?;
        let slack = self.tether_slack.unwrap_or_default();
        check("Cloth::tether_slack", slack, slack >= 0.0, "0 or greater, or `None`")?;
        check("Cloth::max_velocity", self.max_velocity, self.max_velocity > 0.0, "greater than 0 m/s")?;
        let air = self.fluid_density;
        check("Cloth::fluid_density", air, air >= 0.0, "0 kg/m³ or greater")?;
        check("Cloth::collision_margin", self.collision_margin, self.collision_margin >= 0.0, "0 m or greater")?;
        let leaving = self.max_depenetration_velocity;
        check("Cloth::max_depenetration_velocity", leaving, leaving > 0.0, "greater than 0 m/s")?;
        check("Cloth::self_distance", self.self_distance, self.self_distance > 0.0, "greater than 0 m")?;
        check("Cloth::self_friction", self.self_friction, self.self_friction >= 0.0, "0 or greater")
    }
}
