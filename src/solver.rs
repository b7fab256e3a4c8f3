//! The simulation of one cloth: plain data in, plain data out, no ECS.
//!
//! Everything here is in SI units and relative to one origin per cloth, so `f32` keeps its precision however far the
//! cloth is from the world's origin. [`step()`] is the whole of it; the other modules are what it is made of, in the
//! order in which a step uses them.

pub mod braid;
pub mod context;
pub mod effort;
pub mod lattice;
pub mod level;
pub mod material;
pub mod particles;
pub mod scratch;
pub mod simd;
pub mod topology;
pub mod weave;

mod crew;
mod imperfection;
mod integrate;
mod lanes;
mod order;
mod share;
mod step;

pub mod constraint;
pub mod contact;
pub mod explicit;
pub mod force;
pub mod measure;

pub use braid::StrandPack;
pub use constraint::{
    grab::{Grab, GrabTether},
    mount::{BodyAttachment, AttachedPin},
    tether::{Tether, Tethers},
};
pub use contact::{
    Body, Obstacle, BodyImpulse, Shape, BodyDisplacement,
    mesh::{MeshShape, TriangleMesh},
    solid::{Ellipsoid, Solid, TaperedCapsule},
};
pub use context::{PinMotion, Method, SelfCollision, StepContext, StepReport};
pub use effort::SubstepPolicy;
pub use force::wind::{WindRegion, WindSource};
pub(crate) use lanes::Lanes;
pub use lattice::{Lattice, StrandSet};
pub use level::{LinearWeights, Level, LevelPass, Prolongation, TransferOperator};
pub use material::{Elasticity, Material, Moduli, SpringConstants, SpringLaw};
pub use measure::{Energy, Strain};
pub use particles::Particles;
pub use scratch::Scratch;
pub use simd::SimdLevel;
pub use step::{MAX_TIME_STEP, Member, step, step_together};
pub use topology::{Bend, BendBatch, Face, Grain, Spring, SpringBatch, SpringKind, Topology};
pub use weave::MeshStructure;
