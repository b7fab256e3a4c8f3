//! How a game pushes a cloth.

use bevy::{math::Vec3A, prelude::*};

use super::ClothState;

impl ClothState {
    /// Pushes a particle with `force` (N) during the next step. Forces add up until then, so push once a step: in the
    /// plugin's schedule, before [`ClothSystems::Simulate`](crate::prelude::ClothSystems::Simulate), or in any fixed one
    /// before it. A force that isn't finite is ignored.
    pub fn add_force(&mut self, particle: usize, force: Vec3) {
        if let Some(total) = self.particles.force.get_mut(particle)
            && force.is_finite()
        {
            *total += Vec3A::from(force);
            self.is_disturbed = true;
        }
    }

    /// Gives a particle an impulse (N·s) at once. Pinned particles and impulses that aren't finite are left alone.
    pub fn add_impulse(&mut self, particle: usize, impulse: Vec3) {
        if let Some(velocity) = self.particles.velocity.get_mut(particle)
            && impulse.is_finite()
        {
            *velocity += Vec3A::from(impulse) * self.particles.inverse_mass[particle];
            self.is_disturbed = true;
        }
    }

    /// Spreads `force` (N in all) during the next step over the free particles within `radius` (m) of the world
    /// position `centre`: by mass, and fading to nothing at the radius.
    pub fn add_force_in_radius(&mut self, centre: Vec3, radius: f32, force: Vec3) {
        self.spread(centre, radius, |state, particle, share| state.add_force(particle, force * share));
    }

    /// Spreads an impulse (N·s in all) at once, as [`add_force_in_radius`](Self::add_force_in_radius) does a force.
    pub fn add_impulse_in_radius(&mut self, centre: Vec3, radius: f32, impulse: Vec3) {
        self.spread(centre, radius, |state, particle, share| {
            state.add_impulse(particle, impulse * share);
        });
    }

    fn spread(&mut self, centre: Vec3, radius: f32, apply: impl Fn(&mut Self, usize, f32)) {
        if radius.is_nan() || radius <= 0.0 {
            return;
        }
        let centre = Vec3A::from(centre - self.origin);
        let weight = |state: &Self, particle: usize| {
            let closeness = 1.0 - state.particles.position[particle].distance(centre) / radius;
            let inverse_mass = state.particles.inverse_mass[particle];
            if closeness > 0.0 && inverse_mass > 0.0 { closeness / inverse_mass } else { 0.0 }
        };
        let total: f32 = (0..self.particles.len()).map(|i| weight(self, i)).sum();
        if total > 0.0 {
            for particle in 0..self.particles.len() {
                let share = weight(self, particle) / total;
                if share > 0.0 {
                    apply(self, particle, share);
                }
            }
        }
    }
}
