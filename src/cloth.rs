//! The component that makes a mesh cloth, and the settings that are in force.

use bevy::prelude::*;

use crate::{
    error::ClothError,
    fabric::Fabric,
    parameter::{Parameter, check_parameters},
    pins::Pins,
    solver::{LevelPass, Method, Moduli, SubstepPolicy, Topology},
    state::{
        ClothAttachments, ClothGrabs, ClothReport, ClothState, ClothStatus, PendingBuild, Requests, Skinning, Sleep,
        StepInput, Warned,
    },
};

mod in_force;
pub(crate) mod margin;
pub(crate) mod resolution;
pub(crate) mod timing;
pub(crate) mod update;

pub(crate) use in_force::InForce;
pub use timing::ClothTiming;

/// Time integrator and constraint solver of a cloth. All three read the same physical constants.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Default, Debug, Clone, PartialEq)]
pub enum ClothSolver {
    /// Solves each strand of rows and columns exactly, and coarse levels for the long waves: the least stretch for the time
    /// that it takes, stable at any stiffness and time step. Fabrics on all other triangles take implicit steps, which gain no
    /// energy. For games.
    #[default]
    Strands,
    /// Extended position-based dynamics (XPBD), one constraint after the other: stable as well, and stretched more. Fabrics on
    /// triangles without rows and columns take implicit steps here too.
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
/// On an entity without a `Mesh3d` it makes one cloth of all meshes below it in the hierarchy, sewn where they meet: a garment
/// ([`ClothPartOf`](crate::prelude::ClothPartOf)).
///
/// A mesh of up to 10,000 triangles is cloth from the next frame on. A larger one is worked on beside the frames, drawn
/// as it is, until [`ClothReady`](crate::prelude::ClothReady) is sent; pins, fabric, settings and transform count as they are then.
///
/// On a skinned mesh it is worn: it follows the skeleton as its [`Pins`] and [`ClothSkin`](crate::prelude::ClothSkin) say. Morph
/// targets aren't followed: meanwhile the entity has no `MeshMorphWeights`, and one warning says so; they come back when [`Mesh3d`] is
/// set to another mesh.
///
/// Add, change or remove it at any time. Removing it leaves the mesh as it is drawn at that moment.
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, Clone, PartialEq)]
#[require(Fabric, Pins, Transform)]
#[require(ClothState, ClothAttachments, ClothGrabs, ClothReport, ClothStatus)]
#[require(InForce, PendingBuild, Requests, Skinning, Sleep, StepInput, Warned)]
pub struct Cloth {
    /// Time integrator and constraint solver, [`ClothSolver::Strands`] by default.
    pub solver: ClothSolver,
    /// When in a frame it steps, [`ClothTiming::Auto`] by default: in the plugin's schedule, or late, with what is drawn.
    pub timing: ClothTiming,
    /// Target for the largest strain of springs along warp and weft, if their stiffness can hold it, no unit, greater than 0,
    /// 0.01 by default. 0.001 to 0.1. Substeps follow from it where they aren't set by hand. The smaller, the more it costs,
    /// and the livelier the cloth.
    ///
    /// [`ClothSolver::Strands`] chooses [`substeps`](Self::substeps) and [`levels`](Self::levels) by it.
    #[reflect(@Parameter::positive("", (0.001, 0.1)).logarithmic(0.001).entered((0.0001, 1.0)))]
    pub max_strain: f32,
    /// Substeps per step, 1 to 10 000, `None` by default: as many as it takes. 2 to 8 for strands, 8 and more for XPBD. Twice
    /// as many cost twice the time and let cloth stretch half to a third as much.
    ///
    /// `None` is for as many as [`max_strain`](Self::max_strain) needs, 4 by default for implicit steps; with
    /// [`ClothSprings`](crate::prelude::ClothSprings) on a mesh without rows and columns at least 8, three for each ten vertices
    /// along a side, and up to 32 where triangles are narrow; at least 8 near obstacles, in a hand and without tethers, but 6
    /// where rows and columns are near the capsules of a [`ClothBody`](crate::prelude::ClothBody) alone; half as many more with
    /// `self_collision`, 16 at least; three times as many, 32 at least, near solids with edges, and thin ones, and twice that near tips. Implicit steps take no more near edges, and 32 near tips. With [`ClothSolver::Xpbd`] for 8.
    #[reflect(@Parameter::within("", (1.0, 10_000.0), (1.0, 64.0)).whole().entered((1.0, 1000.0)))]
    pub substeps: Option<u32>,
    /// Multigrid passes of [`ClothSolver::Strands`] in each substep: stride and iterations of each coarse level. Only cloth
    /// with tethers has any. `None`, the default, for those that [`max_strain`](Self::max_strain) or the
    /// [`substeps`](Self::substeps) need; an empty list for no levels.
    pub levels: Option<Vec<LevelPass>>,
    /// Largest number of substeps per step that [`ClothSolver::Explicit`] may take, 1 to 10 000, 512 by default. 100 to 2000. Where
    /// that isn't enough, stiffness and damping are cut down to what is stable, and one warning says so.
    #[reflect(@Parameter::within("", (1.0, 10_000.0), (1.0, 2000.0)).whole())]
    pub max_substeps: u32,
    /// The most work of a step, in particles times substeps per step, greater than 0, `None` by default: as much as is asked for. Where
    /// that is more, there are fewer substeps, but one at least: the cloth stretches more, and lets small obstacles through sooner. The same
    /// on every machine, other than [`ClothBudget`](crate::prelude::ClothBudget). A hung cloth of 64 x 64 particles asks for 40,960.
    /// It doesn't count what looking for contact costs, and [`ClothSolver::Explicit`] has `max_substeps` instead.
    #[reflect(@Parameter::within("", (1.0, 1e9), (1000.0, 1e6)).whole())]
    pub max_work: Option<u32>,
    /// Factor on [`ClothGravity`](crate::prelude::ClothGravity) for this cloth, no unit, 1 by default. 0 floats, negative rises.
    #[reflect(@Parameter::finite("", (-1.0, 3.0)).entered((-1e3, 1e3)))]
    pub gravity_scale: f32,
    /// Share of its length by which a tether may be longer, no unit, 0 or more, 0.005 by default, `None` for no tethers. 0.002 to 0.01
    /// for cloth: more lets it stretch, less makes it tremble.
    ///
    /// It comes on top of what the fabric's own weight stretches it, which shows with knits. Tethers keep every particle
    /// within the cloth's own length of its pins: the cure for cloth that stretches like rubber. [`ClothSolver::Explicit`]
    /// hasn't them.
    #[reflect(@Parameter::not_negative("", (0.0, 0.05)).entered((0.0, 10.0)))]
    pub tether_slack: Option<f32>,
    /// Largest speed of a particle relative to what the cloth is pinned to, in m/s, greater than 0, 50 by default, which is
    /// faster than any storm. Less calms single particles that thrash about.
    #[reflect(@Parameter::positive("m/s", (1.0, 100.0)).logarithmic(1.0).entered((0.01, 10_000.0)))]
    pub max_velocity: f32,
    /// Density of the air around in kg/m³, 0 or more, 1.225 by default: how hard wind pushes and how much still air brakes.
    /// 1.225 at sea level, 0 for a vacuum.
    #[reflect(@Parameter::not_negative("kg/m³", (0.0, 3.0)).entered((0.0, 1e3)))]
    pub fluid_density: f32,
    /// Distance in m that the cloth keeps from obstacles beyond its fabric's thickness, 0 or more, 0.005 by default. 0.002 to
    /// 0.02: the more the larger its triangles are, so that no corner of an obstacle shows between its particles. More than a
    /// quarter of the cloth's width counts as that, with one warning.
    #[reflect(@Parameter::not_negative("m", (0.0, 0.05)).entered((0.0, 10.0)).shown_as("mm", 1e3))]
    pub collision_margin: f32,
    /// Largest push-out speed of cloth that is inside an obstacle, or too near to other cloth, in m/s, greater than 0, 1 by
    /// default. 0.5 to 3: more gets out sooner, and looks like a blow.
    #[reflect(@Parameter::positive("m/s", (0.1, 5.0)).logarithmic(0.1).entered((0.001, 1000.0)).titled("Leaving speed"))]
    pub max_depenetration_velocity: f32,
    /// Whether the cloth collides with itself, and with other cloths of the same [`timing`](Self::timing) that do too: triangles and
    /// edges stay apart, in folds, layers and knots. No by default, since it costs.
    pub self_collision: bool,
    /// Distance in m that parts of cloth keep from each other, greater than 0, 0.004 by default. 0.002 to 0.01: less lies
    /// closer, more is safer in a rush. Parts that are nearer to each other at rest stay so. More than four edges of the mesh
    /// count as four.
    #[reflect(@Parameter::positive("m", (0.001, 0.02)).entered((0.000_01, 10.0)).shown_as("mm", 1e3))]
    pub self_distance: f32,
    /// Coulomb friction of cloth on cloth, no unit, 0 or more, 0.3 by default. 0.1 for silk, 0.4 for wool.
    #[reflect(@Parameter::not_negative("", (0.0, 1.0)).entered((0.0, 100.0)))]
    pub self_friction: f32,
    /// Collision layers of the cloth for other cloths, one a bit, the first by default. Two cloths meet where each is in the
    /// other's mask.
    pub collision_layers: u32,
    /// Collision mask: the cloth meets obstacles and cloths whose
    /// [`ClothCollider::layers`](crate::prelude::ClothCollider::layers), or `collision_layers`, have a bit in common with
    /// it. All by default.
    pub collision_mask: u32,
}

impl Default for Cloth {
    fn default() -> Self {
        Self {
            solver: ClothSolver::default(),
            timing: ClothTiming::default(),
            max_strain: 0.01,
            substeps: None,
            levels: None,
            max_substeps: 512,
            max_work: None,
            gravity_scale: 1.0,
            tether_slack: Some(0.005),
            max_velocity: 50.0,
            fluid_density: 1.225,
            collision_margin: 0.005,
            max_depenetration_velocity: 1.0,
            self_collision: false,
            self_distance: 0.004,
            self_friction: 0.3,
            collision_layers: 1,
            collision_mask: u32::MAX,
        }
    }
}

/// A step of more iterations of a level than this, as one of more substeps than are accepted, would look like a program that
/// hangs.
const MOST_ITERATIONS: u32 = 1000;

/// Substeps of [`ClothSolver::Xpbd`], where they aren't set.
const XPBD_SUBSTEPS: u32 = 8;

impl Cloth {
    /// Substeps and levels for a mesh, of a sheet with `moduli` or of plain springs.
    pub(crate) fn substep_policy(&self, topology: &Topology, moduli: Option<&Moduli>) -> SubstepPolicy {
        let has_strands = self.solver == ClothSolver::Strands;
        let mut policy = match self.substeps {
            Some(substeps) if has_strands => {
                SubstepPolicy::fixed(substeps, SubstepPolicy::levels_for(substeps, topology))
            }
            None if has_strands => SubstepPolicy::to_hold(self.max_strain, topology, moduli),
            substeps => SubstepPolicy::fixed(substeps.unwrap_or(XPBD_SUBSTEPS), Vec::new()),
        };
        if let Some(levels) = &self.levels {
            policy.levels.clone_from(levels);
            policy.contact_levels.clone_from(levels);
        }
        policy
    }

    /// The most substeps of a step that so many particles have within [`max_work`](Self::max_work).
    pub(crate) fn substep_limit(&self, particles: usize) -> u32 {
        self.max_work.map_or(u32::MAX, |work| (work / (particles as u32).max(1)).max(1))
    }

    /// Checks the ranges of all settings.
    ///
    /// # Errors
    ///
    /// [`ClothError::InvalidParameter`] with the first field that is out of its range.
    pub fn validate(&self) -> Result<(), ClothError> {
        check_parameters(self, |_| true)?;
        let iterations = self.levels.iter().flatten().map(|level| level.iterations).max().unwrap_or(0);
        if iterations > MOST_ITERATIONS {
            let (value, rule) = (iterations as f32, format!("0 to {MOST_ITERATIONS} iterations"));
            return Err(ClothError::InvalidParameter { name: "Cloth::levels".into(), value, rule });
        }
        Ok(())
    }
}
