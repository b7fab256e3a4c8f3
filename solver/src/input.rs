//! What surrounds a cloth during one step.

use bevy_math::Vec3A;
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
use bevy_tasks::TaskPool;

use crate::{material::Material, topology::Topology};

mod body;
mod grab;
mod obstacle;
mod pin_motion;
mod substep_policy;
mod tether;
mod wind;

pub use crate::input::{
    body::{AttachedPin, Body, BodyAttachment, BodyDisplacement, BodyImpulse},
    grab::{Grab, GrabTether},
    obstacle::Obstacle,
    pin_motion::PinMotion,
    substep_policy::SubstepPolicy,
    tether::{Tether, Tethers},
    wind::{Gusts, WindRegion, WindSource},
};
pub(crate) use crate::input::{substep_policy::ContactRisk, tether::TetherBlock};

/// Distance between balls at the particles that nothing gets through, as a share of the mean edge: of a square cell, a corner is
/// 0.71 of its side from the middle, and the mean edge, diagonals too, is 1.14 of it.
const BALL: f32 = 0.65;

/// The largest distance between parts of a cloth, as a multiple of the mean edge.
const MOST_EDGES: f32 = 4.0;

/// Longest time step that is simulated, s. A longer one is cut down to it: after a stall the cloth falls behind the
/// clock instead of being thrown about.
pub const MAX_TIME_STEP: f32 = 0.1;

/// How the springs are integrated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Extended position-based dynamics, with each thread of a regular mesh solved exactly and coarse levels for the long
    /// waves: stable at any stiffness, and stretched least.
    #[default]
    Strands,
    /// Extended position-based dynamics, spring by spring in colours: stable at any stiffness.
    Xpbd,
    /// Forces and symplectic Euler, the textbook form: accurate, and costly where springs are stiff.
    Explicit,
}

/// How a cloth collides with itself and with other cloths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Reflect)]
#[reflect(Default, Debug, Clone, PartialEq)]
pub enum SelfCollision {
    /// Nothing: it passes through itself.
    #[default]
    Off,
    /// Its particles, as balls: fast, and good enough where nothing thin or quick comes between them.
    Particles,
    /// Its triangles and edges: folds, layers and knots stay apart.
    Robust,
}

impl SelfCollision {
    /// Distance that parts of a cloth keep from each other, m, where that of the settings is `distance`: balls at its
    /// particles are larger, so that nothing gets through between them. No distance is more than some edges long: everything
    /// would be near everything.
    pub fn distance_on(self, topology: &Topology, distance: f32) -> f32 {
        let edge = topology.surface().mean_edge;
        let least = match self {
            Self::Particles => BALL * edge,
            Self::Robust | Self::Off => 0.0,
        };
        distance.min(MOST_EDGES * edge).max(least)
    }
}

/// Settings and surroundings of one step.
#[derive(Clone, Debug)]
pub struct StepContext<'a> {
    /// Duration of the step, s. More than [`MAX_TIME_STEP`] is cut down to it.
    pub dt: f32,
    /// How the springs are integrated.
    pub method: Method,
    /// Substeps a step, and levels. [`Method::Explicit`] finds its own number, [`Method::Xpbd`] has no levels.
    pub effort: &'a SubstepPolicy,
    /// The most substeps that [`Method::Explicit`] may take.
    pub max_substeps: u32,
    /// What the cloth is made of.
    pub material: Material,
    /// Gravity, m/s².
    pub gravity: Vec3A,
    /// Fixed particles and their way.
    pub pin_motions: &'a [PinMotion],
    /// Bodies that pins are fixed to and that give way. On these there are no tethers.
    pub body_attachments: &'a [BodyAttachment],
    /// Which pins are fixed to which of them.
    pub attached_pins: &'a [AttachedPin],
    /// Hands that pull at the cloth.
    pub grabs: &'a [Grab],
    /// Largest speed of a particle relative to what holds the cloth, m/s.
    pub max_velocity: f32,
    /// Longest allowed distances to fixed particles. Not for [`Method::Explicit`].
    pub tethers: Option<&'a Tethers>,
    /// Share of its length by which a tether may be longer, no unit, beyond what its fabric is stretched by. 0.002 to 0.01.
    pub tether_slack: f32,
    /// Distance that particles keep from obstacles beyond the cloth's thickness, m.
    pub margin: f32,
    /// Largest speed at which a particle is pushed out of an obstacle, or of cloth, that it is inside of, m/s.
    pub max_depenetration_velocity: f32,
    /// How the cloth collides with itself and with other cloths.
    pub self_collision: SelfCollision,
    /// Layers that it is in for other cloths, one a bit.
    pub collision_layers: u32,
    /// Layers of the other cloths that it meets. Two meet where each is in the other's.
    pub collision_mask: u32,
    /// Distance that parts of cloth keep from each other, m.
    pub self_distance: f32,
    /// Friction of cloth on cloth, no unit.
    pub self_friction: f32,
    /// Obstacles and their way.
    pub obstacles: &'a [Obstacle],
    /// Density of the air, kg/m³. Zero for a vacuum.
    pub fluid_density: f32,
    /// All winds that may reach the cloth.
    pub winds: &'a [WindSource],
    /// Threads that may help with a large cloth. The bits are the same without.
    pub pool: Option<&'a TaskPool>,
}

impl StepContext<'_> {
    /// Share of its length by which a tether may be longer in all, no unit: fabric may be stretched by its weight.
    pub fn slack(&self) -> f32 {
        let longest = self.tethers.map_or(0.0, Tethers::longest);
        self.tether_slack + longest * self.material.give(self.gravity.length())
    }

    /// Distance that particles keep from obstacles, m.
    pub fn contact_distance(&self) -> f32 {
        self.material.thickness + self.margin
    }
}
