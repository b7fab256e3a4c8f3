//! Contact: particles stay outside of obstacles, slide on them with friction, and let go without sticking.
//!
//! Particles are projected once a substep, as its last act, so that none ends a step inside an obstacle; where obstacles
//! overlap or pinch the cloth, the last one has its way. Friction is
//! Coulomb's at the level of positions: the way along the surface is cut by at most `friction` times the way that the
//! contact pushed (Müller et al., "Position Based Dynamics", 2007, section 3.6, with the normal push in place of a
//! damping constant). There is no restitution.
//! Where implicit steps solve the cloth (`constraint/implicit/contact.rs`), contacts are also predicted before it is solved.

pub(crate) mod body;
pub(crate) mod broad_phase;
pub(crate) mod feature;
pub(crate) mod friction;
pub(crate) mod mesh;
pub(crate) mod particle;

pub use crate::contact::broad_phase::StepReach;
pub(crate) use crate::contact::{
    broad_phase::near_obstacles,
    particle::{predict, project},
};
