//! The loop over the substeps.

use bevy::math::{Vec3A, ops};

use super::{
    Method, Particles, Scratch, StepContext, StepReport, Topology,
    constraint::{anchor, grab, spring, tether},
    contact, explicit,
    force::wind,
};

/// Longest time step that is simulated, s. A longer one is cut down to it: after a stall the cloth falls behind the
/// clock instead of being thrown about.
pub const MAX_TIME_STEP: f32 = 0.1;

/// How often the forces of the air are renewed within a step, Hz. They change more slowly than the springs.
const AIR_RATE: f32 = 160.0;

/// Advances one cloth by `ctx.dt`.
///
/// One substep of duration h integrates the velocities (symplectic Euler), moves the fixed particles, solves the
/// constraints and projects the particles out of the obstacles. Small substeps with one iteration each follow
/// Macklin et al., "Small Steps in Physics Simulation" (2019).
///
/// Nothing is allocated once `scratch` has seen a cloth of this size. The same input gives the same bits. A time step
/// that isn't positive does nothing.
pub fn step(particles: &mut Particles, topology: &Topology, ctx: &StepContext, scratch: &mut Scratch) -> StepReport {
    let dt = ctx.dt.min(MAX_TIME_STEP);
    if particles.is_empty() || ctx.dt.is_nan() || ctx.dt <= 0.0 {
        return StepReport { substeps: 0, needed_substeps: 0, stiffness_scale: 1.0, contacts: 0 };
    }
    scratch.fit(topology);
    grab::take_up(particles, ctx.grabs, &mut scratch.held);
    let (most, needed_substeps, stiffness_scale) = match ctx.method {
        Method::Xpbd => (u32::MAX, ctx.substeps.max(1), 1.0),
        Method::Explicit => {
            let (needed, scale) = explicit::stable_substeps(particles, topology, ctx, dt, scratch);
            (ctx.max_substeps.max(1), needed, scale)
        }
    };
    let substeps = needed_substeps.min(most);
    let h = dt / substeps as f32;
    let decay = ops::exp(-ctx.material.damping * h);
    let air_interval = ((1.0 / (AIR_RATE * h)) as u32).max(1);
    let mut contacts = 0;

    spring::weigh(particles, topology, &ctx.material, h, &mut scratch.spring_shares);
    wind::sample_air(particles, ctx, scratch);
    for substep in 0..substeps {
        let start = substep as f32 / substeps as f32;
        let end = (substep + 1) as f32 / substeps as f32;
        if substep % air_interval == 0 {
            wind::apply_air(particles, topology, ctx, h * air_interval as f32, scratch);
        }
        grab::carry(particles, ctx.grabs, start..end, h);
        match ctx.method {
            Method::Xpbd => {
                integrate(particles, &scratch.steady_force, ctx.gravity, decay, h);
                anchor::advance(particles, ctx.anchors, end, dt);
                spring::solve(particles, topology, &ctx.material, h, &scratch.spring_shares);
                grab::solve(particles, ctx.grabs, start..end, h);
                grab::solve_tethers(particles, ctx.grabs, ctx.tether_slack);
                // After those of the hands: where both can't hold, pins are stronger.
                tether::solve(particles, ctx.tethers, ctx.tether_slack);
            }
            Method::Explicit => {
                explicit::sum_forces(particles, topology, &ctx.material, stiffness_scale, scratch);
                integrate(particles, &scratch.force, ctx.gravity, decay, h);
                anchor::advance(particles, ctx.anchors, end, dt);
                grab::solve(particles, ctx.grabs, start..end, h);
            }
        }
        contacts = contact::project(particles, ctx.obstacles, &ctx.material, start..end);
        // Without a constraint the integrated velocity is the exact one: rounding stays out of it.
        if ctx.method == Method::Xpbd || contacts > 0 || !ctx.grabs.is_empty() {
            derive_velocities(particles, h);
        }
    }
    grab::put_down(particles, &scratch.held);
    StepReport { substeps, needed_substeps, stiffness_scale, contacts }
}

/// Symplectic Euler: velocities from forces (N) and gravity (m/s²), then positions from the new velocities.
fn integrate(particles: &mut Particles, force: &[Vec3A], gravity: Vec3A, decay: f32, h: f32) {
    let Particles { position, previous, velocity, inverse_mass, .. } = particles;
    let count = position.len();
    let (previous, velocity) = (&mut previous[..count], &mut velocity[..count]);
    let (inverse_mass, force) = (&inverse_mass[..count], &force[..count]);
    for i in 0..count {
        previous[i] = position[i];
        let w = inverse_mass[i];
        if w > 0.0 {
            velocity[i] = velocity[i] * decay + (gravity + force[i] * w) * h;
            position[i] += velocity[i] * h;
        }
    }
}

/// Velocities from the way that the particles went within the substep.
///
/// That is (position - previous) / h, written as what the constraints have added to the integrated velocity: a way of
/// g h² is lost to rounding when h is small, a change of speed of g h isn't.
fn derive_velocities(particles: &mut Particles, h: f32) {
    let Particles { position, previous, velocity, .. } = particles;
    let rate = 1.0 / h;
    let count = position.len();
    let (previous, velocity) = (&previous[..count], &mut velocity[..count]);
    for i in 0..count {
        let predicted = previous[i] + velocity[i] * h;
        velocity[i] += (position[i] - predicted) * rate;
    }
}
