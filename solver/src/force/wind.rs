//! The air: wind sources and the force of moving air on triangles.
//!
//! ```text
//!        n   u = air velocity - triangle velocity
//!      \ ^ /                     c = û·n >= 0
//!   ----\|/----  triangle, A     F = ½ ρ A |u|² c (drag û + lift (n - c û))
//! ```
//!
//! The normal is turned to the lee side, so c isn't negative; cloth edge-on to the wind has c = 0 and feels nothing.
//! Quadratic drag on a plate, with the lift perpendicular to the wind as in Wilson et al., "Simulating wind effects
//! on cloth and hair in Disney's Frozen" (2014).

use bevy_math::Vec3A;

use crate::{
    input::{StepContext, WindSource},
    particles::Particles,
    topology::Topology,
};

mod gusts;

/// The air around a cloth during a step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Air {
    /// Its velocity at each particle, m/s.
    velocity: Vec<Vec3A>,
    /// A third of its velocity as each particle feels it: less its own, m/s.
    relative: Vec<Vec3A>,
}

impl Air {
    /// Takes the velocity of the air at each particle, once a step.
    pub fn sample(&mut self, particles: &Particles, ctx: &StepContext) {
        if feels_air(ctx) {
            self.velocity.clear();
            self.velocity.resize(particles.len(), Vec3A::ZERO);
            self.relative.resize(particles.len(), Vec3A::ZERO);
            add_air_velocity(ctx.winds, &particles.position, &particles.position, &mut self.velocity);
        }
    }
}

/// Adds the velocity of all winds at each of `places` to `air`, as a cloth with particles at `position` feels it there.
pub fn add_air_velocity(winds: &[WindSource], position: &[Vec3A], places: &[Vec3A], air: &mut [Vec3A]) {
    for wind in winds {
        let field = gusts::GustField::sample(wind, position);
        for (air, &place) in air.iter_mut().zip(places) {
            let weight = wind.region.weight(place);
            if weight > 0.0 {
                *air += field.at(place) * weight;
            }
        }
    }
}

/// Adds the force of the air to the steady `force` (N), a third of each triangle's to each vertex.
///
/// The force stands for `interval` seconds. It is limited so that it can't turn a triangle's velocity against the
/// air around within that time, which is what makes light cloth in a storm stable.
pub(crate) fn apply_air(
    particles: &Particles,
    topology: &Topology,
    ctx: &StepContext,
    interval: f32,
    air: &mut Air,
    force: &mut [Vec3A],
) {
    let Air { velocity, relative: relative_air } = air;
    for ((relative, &air), &velocity) in relative_air.iter_mut().zip(&*velocity).zip(&particles.velocity) {
        *relative = (air - velocity) / 3.0;
    }
    let position = &particles.position;
    let (drag, lift) = (ctx.material.drag, ctx.material.lift);
    let half_density = 0.5 * ctx.fluid_density;
    let most_per_rest_area = ctx.material.density / (interval * (drag + lift));
    for (&[i, j, k], &rest_area) in topology.triangles.iter().zip(&topology.triangle_areas) {
        let (i, j, k) = (i as usize, j as usize, k as usize);
        // Twice the area along the normal.
        let normal = (position[j] - position[i]).cross(position[k] - position[i]);
        let u = relative_air[i] + relative_air[j] + relative_air[k];
        let (area, speed) = (normal.length(), u.length());
        if area * speed < 1e-12 {
            continue;
        }
        let flow = normal.dot(u);
        let per_area_speed = 1.0 / (area * speed);
        // |u|² c (drag û + lift (n - c û)) = |u·n| (drag u + lift (|u| n - (u·n) û)), with n towards the lee.
        let along = drag - lift * flow.abs() * per_area_speed;
        let across = lift * speed * speed * per_area_speed;
        let blown = u * along + normal * across.copysign(flow);
        let rate = (0.5 * half_density * flow.abs()).min(most_per_rest_area * rest_area);
        let share = blown * (rate / 3.0);
        force[i] += share;
        force[j] += share;
        force[k] += share;
    }
}

/// Whether the air acts on this cloth at all.
pub(crate) fn feels_air(ctx: &StepContext) -> bool {
    ctx.fluid_density > 0.0 && ctx.material.drag + ctx.material.lift > 0.0
}
