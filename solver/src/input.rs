//! What surrounds a cloth during one step.

use bevy_math::Vec3A;
use bevy_tasks::TaskPool;

use crate::material::Material;

mod body;
mod collision;
mod grab;
mod obstacle;
mod pin_motion;
mod settings;
mod skin;
mod substep_policy;
mod tether;
mod wind;

pub use crate::input::{
    body::{AttachedPin, Body, BodyAttachment, BodyDisplacement, BodyImpulse},
    collision::CollisionFilter,
    grab::{Grab, GrabTether},
    obstacle::Obstacle,
    pin_motion::PinMotion,
    settings::{Method, StepSettings},
    skin::{Backstop, Skin, SkinLimit, SkinLimits, SkinPose},
    substep_policy::SubstepPolicy,
    tether::{Tether, Tethers},
    wind::{Gusts, WindRegion, WindSource},
};
pub(crate) use crate::input::{
    skin::{FARTHEST, SkinBlock},
    substep_policy::ContactRisk,
    tether::TetherBlock,
};

/// Longest time step that is simulated, s. A longer one is cut down to it: after a stall the cloth falls behind the
/// clock instead of being thrown about.
pub const MAX_TIME_STEP: f32 = 0.1;

/// Settings and surroundings of one step.
///
/// `StepContext { obstacles: &obstacles, ..StepContext::new(dt, &settings, material) }` has those obstacles around and nothing
/// else.
#[derive(Clone, Debug)]
pub struct StepContext<'a> {
    /// Duration of the step, s. More than [`MAX_TIME_STEP`] is cut down to it, and nothing happens in one that isn't positive.
    pub dt: f32,
    /// How the cloth is solved.
    pub settings: &'a StepSettings,
    /// What the cloth is made of.
    pub material: Material,
    /// Gravity, m/s². None by default.
    pub gravity: Vec3A,
    /// Density of the air, kg/m³, 0 or more. 1.225 at sea level; by default 0, a vacuum.
    pub fluid_density: f32,
    /// Fixed particles, and how they move. None by default: the cloth is free.
    pub pin_motions: &'a [PinMotion],
    /// Bodies that pins are fixed to and that the cloth pulls at. On these there are no tethers. None by default.
    pub body_attachments: &'a [BodyAttachment],
    /// Which pins are fixed to which of them. None by default.
    pub attached_pins: &'a [AttachedPin],
    /// Hands that pull at the cloth. None by default.
    pub grabs: &'a [Grab],
    /// Longest allowed distances to fixed particles. Not for [`Method::Explicit`]. None by default.
    pub tethers: Option<&'a Tethers>,
    /// What holds the cloth to an animated mesh. None by default.
    pub skin: Option<Skin<'a>>,
    /// Obstacles, and how they move. None by default.
    pub obstacles: &'a [Obstacle],
    /// All winds that may reach the cloth. None by default.
    pub winds: &'a [WindSource],
    /// The most substeps that the step may take, 1 or more, whatever asks for more: a budget. Not for [`Method::Explicit`], which
    /// has [`StepSettings::max_substeps`]. As many as are asked for, by default.
    pub substep_limit: u32,
    /// Threads that may help with a large cloth. The bits are the same without, as by default.
    pub pool: Option<&'a TaskPool>,
}

impl<'a> StepContext<'a> {
    /// A step of `dt` seconds with nothing around: no gravity, no air, nothing that holds the cloth or that it could touch, and
    /// one thread.
    pub const fn new(dt: f32, settings: &'a StepSettings, material: Material) -> Self {
        Self {
            dt,
            settings,
            material,
            gravity: Vec3A::ZERO,
            fluid_density: 0.0,
            pin_motions: &[],
            body_attachments: &[],
            attached_pins: &[],
            grabs: &[],
            tethers: None,
            skin: None,
            obstacles: &[],
            winds: &[],
            substep_limit: u32::MAX,
            pool: None,
        }
    }

    /// Share of its length by which a tether may be longer in all, no unit: fabric may be stretched by its weight.
    pub fn slack(&self) -> f32 {
        let longest = self.tethers.map_or(0.0, Tethers::longest);
        self.settings.tether_slack + longest * self.material.stretch_under_weight(self.gravity.length())
    }

    /// Distance that particles keep from obstacles, m.
    pub fn contact_distance(&self) -> f32 {
        self.material.thickness + self.settings.margin
    }
}
