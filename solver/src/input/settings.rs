//! How a cloth is solved.

use crate::{
    input::{CollisionFilter, SubstepPolicy},
    topology::Topology,
};

/// The largest distance between parts of a cloth, as a multiple of the mean edge: beyond it, everything would be near everything.
const MOST_EDGES: f32 = 4.0;

/// How the springs are integrated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Extended position-based dynamics, with each strand of a regular mesh solved exactly and coarse levels for the long
    /// waves: stable at any stiffness, and stretched least. Sheets with moduli on meshes without rows and columns take linearised
    /// implicit steps instead.
    #[default]
    Strands,
    /// Extended position-based dynamics, spring by spring in colours: stable at any stiffness. Sheets without rows and columns as
    /// with [`Strands`](Self::Strands).
    Xpbd,
    /// Forces and symplectic Euler, the textbook form: accurate, and costly where springs are stiff.
    Explicit,
}

/// How a cloth is solved, whatever surrounds it: many steps, and many cloths, may share it.
#[derive(Clone, Debug, PartialEq)]
pub struct StepSettings {
    /// How the springs are integrated. [`Method::Strands`] by default.
    pub method: Method,
    /// Substeps a step, and passes of the coarse levels. [`Method::Explicit`] finds its own number of substeps, and
    /// [`Method::Xpbd`] has no levels. 8 substeps in every step and no levels by default.
    pub substep_policy: SubstepPolicy,
    /// The most substeps that [`Method::Explicit`] may take, 1 or more. Where stability needs more, stiffness and damping are
    /// cut down instead. 512 by default.
    pub max_substeps: u32,
    /// Largest speed of a particle relative to what holds the cloth, m/s, greater than 0. 50 by default: faster than any storm.
    pub max_velocity: f32,
    /// Share of its length by which a tether may be longer, no unit, 0 or more, beyond what its fabric is stretched by. 0.002
    /// to 0.01; 0.005 by default.
    pub tether_slack: f32,
    /// Distance that particles keep from obstacles beyond the cloth's thickness, m, 0 or more. 0.002 to 0.02; 0.005 by default.
    pub margin: f32,
    /// Largest speed at which a particle is pushed out of an obstacle, or of cloth, that it is inside of, m/s, greater than 0.
    /// 0.5 to 3; 1 by default.
    pub max_depenetration_velocity: f32,
    /// Whether the cloth collides with itself, and with other cloths that do too. No by default.
    pub self_collision: bool,
    /// Distance that parts of cloth keep from each other, m, greater than 0. 0.002 to 0.01; 0.004 by default.
    pub self_distance: f32,
    /// Coulomb friction of cloth on cloth, no unit, 0 or more. 0.1 for silk, 0.4 for wool; 0.3 by default.
    pub self_friction: f32,
    /// Which other cloths it meets. Obstacles aren't filtered here: a step is given those that count. The first layer, and a
    /// mask of all, by default.
    pub collision_filter: CollisionFilter,
}

impl Default for StepSettings {
    fn default() -> Self {
        Self {
            method: Method::Strands,
            substep_policy: SubstepPolicy::fixed(8, Vec::new()),
            max_substeps: 512,
            max_velocity: 50.0,
            tether_slack: 0.005,
            margin: 0.005,
            max_depenetration_velocity: 1.0,
            self_collision: false,
            self_distance: 0.004,
            self_friction: 0.3,
            collision_filter: CollisionFilter::default(),
        }
    }
}

impl StepSettings {
    /// Distance that parts of such a cloth keep from each other, m: [`self_distance`](Self::self_distance), but no more than four of
    /// its mean edges.
    pub fn self_distance_on(&self, topology: &Topology) -> f32 {
        self.self_distance.min(MOST_EDGES * topology.surface().mean_edge)
    }
}
