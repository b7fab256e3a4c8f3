//! Buffers that a step needs and nobody keeps: reused from step to step, so a step doesn't allocate.

use bevy::math::Vec3A;

use super::Topology;

/// Working memory of [`step`](super::step()). One can serve any number of cloths in turn.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    /// Velocity of the air at each particle, m/s.
    pub(super) air_velocity: Vec<Vec3A>,
    /// A third of the air's velocity as each particle feels it: less its own, m/s.
    pub(super) relative_air: Vec<Vec3A>,
    /// External force and force of the air on each particle, N: constant over some substeps.
    pub(crate) steady_force: Vec<Vec3A>,
    /// The steady force and the force of the springs on each particle, N.
    pub(super) force: Vec<Vec3A>,
    /// How much of each spring's push its two ends take, 1/kg.
    pub(super) spring_shares: Vec<[f32; 2]>,
    /// Sum of (stiffness in N/m, damping in N·s/m) of the springs at each particle.
    pub(super) spring_sums: Vec<(f32, f32)>,
    /// Held particles and their inverse masses without the hands, 1/kg.
    pub(super) held: Vec<(u32, f32)>,
}

impl Scratch {
    /// Makes room for a cloth; allocates only when it is larger than all before.
    pub(super) fn fit(&mut self, topology: &Topology) {
        let particles = topology.particle_count();
        self.air_velocity.resize(particles, Vec3A::ZERO);
        self.relative_air.resize(particles, Vec3A::ZERO);
        self.steady_force.resize(particles, Vec3A::ZERO);
        self.force.resize(particles, Vec3A::ZERO);
        self.spring_shares.resize(topology.springs.len(), [0.0; 2]);
        self.spring_sums.resize(particles, (0.0, 0.0));
    }
}
