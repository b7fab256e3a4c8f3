//! The state of a cloth: what a step reads and writes.

use core::ops::Range;

use bevy_math::Vec3A;

use crate::{material::Material, particles::contact_load::ContactLoad, topology::Topology};

pub(crate) mod contact_load;
pub(crate) mod gathered;
pub(crate) mod lanes;

/// Positions, velocities and masses of all particles of one cloth, one entry a particle in each array.
///
/// Positions are in metres, relative to the cloth's origin.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Particles {
    /// Position, m.
    pub position: Vec<Vec3A>,
    /// Velocity, m/s. A fixed particle has the velocity of its pin.
    pub velocity: Vec<Vec3A>,
    /// Inverse mass, 1/kg. Zero for a fixed particle, which no force and no constraint moves.
    pub inverse_mass: Vec<f32>,
    /// External force, N, constant over a step. The step doesn't clear it.
    pub force: Vec<Vec3A>,
    /// Normal forces of contacts at the end of the latest step.
    pub contact_load: ContactLoad,
}

impl Particles {
    /// Free particles at rest at `position` (m), with the masses that `material` gives to their share of the cloth.
    pub fn at_rest(position: Vec<Vec3A>, topology: &Topology, material: &Material) -> Self {
        let count = position.len();
        let mut particles = Self {
            position,
            velocity: vec![Vec3A::ZERO; count],
            inverse_mass: vec![0.0; count],
            force: vec![Vec3A::ZERO; count],
            contact_load: ContactLoad::default(),
        };
        particles.set_masses(topology, material, |_| false);
        particles
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// True for a cloth without particles.
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }

    /// Gives every particle the mass `density * area`, except the fixed ones, which become immovable.
    pub fn set_masses(&mut self, topology: &Topology, material: &Material, is_fixed: impl Fn(usize) -> bool) {
        for (i, inverse_mass) in self.inverse_mass.iter_mut().enumerate() {
            *inverse_mass = if is_fixed(i) { 0.0 } else { 1.0 / (material.density * topology.areas[i]) };
        }
    }

    /// Whether an external force acts on any of some particles.
    pub(crate) fn is_pushed(&self, some: Range<usize>) -> bool {
        // Many at a time: mostly there is none, and all are looked at.
        let sum = |forces: &[Vec3A]| forces.iter().fold(Vec3A::ZERO, |sum, force| sum + force.abs());
        self.force[some].chunks(64).any(|forces| sum(forces) != Vec3A::ZERO)
    }

    /// Whether every position and velocity is a finite number.
    pub fn is_finite(&self) -> bool {
        let finite = |values: &[Vec3A]| values.iter().all(|v| v.is_finite());
        finite(&self.position) && finite(&self.velocity)
    }
}
