//! Seeds geometric imperfections: a cloth that is flat to the last bit can't buckle.
//!
//! Pushed together within its plane, it would be crumpled there and stay so, since nothing ever leads out of the plane. Analyses
//! of buckling therefore start from a shape that is slightly off. Only planes across an axis are looked for: in any other,
//! rounding is imperfect enough. Whatever touches or blows at a cloth takes it out of its plane by itself; pins and hands
//! don't.

use bevy_math::Vec3A;

use crate::{input::StepContext, noise::noise, particles::Particles, topology::Topology};

/// How far particles may be off a plane that counts as flat, and how far off it they are put, m: less than a fibre is thick.
const IMPERFECTION: f32 = 1e-6;

/// Takes a cloth out of its plane that is flat and about to be jerked within it, the same particles by the same lengths each time.
pub(crate) fn seed(particles: &mut Particles, topology: &Topology, ctx: &StepContext) {
    for axis in [Vec3A::X, Vec3A::Y, Vec3A::Z] {
        if is_jerked_across(axis, topology, ctx) && is_flat_along(axis, &particles.position) {
            for (i, (place, &w)) in (0..).zip(particles.position.iter_mut().zip(&particles.inverse_mass)) {
                if w > 0.0 {
                    *place += axis * (IMPERFECTION * noise(i));
                }
            }
        }
    }
}

/// Whether a pin or a hand goes farther across an axis, in this step, than its particle's part of the cloth is wide.
fn is_jerked_across(axis: Vec3A, topology: &Topology, ctx: &StepContext) -> bool {
    let pins = ctx.pin_motions.iter().map(|pin| (pin.particle, pin.end - pin.start));
    let hands = ctx.grabs.iter().map(|grab| (grab.particles[0], grab.end - grab.start));
    pins.chain(hands)
        .any(|(particle, way)| way.reject_from_normalized(axis).length_squared() > topology.areas[particle as usize])
}

/// Whether particles are in one plane across an axis. Mostly the second of them already says no.
fn is_flat_along(axis: Vec3A, position: &[Vec3A]) -> bool {
    position.iter().all(|place| (place - position[0]).dot(axis).abs() < IMPERFECTION)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_in_one_plane_across_the_axis_is_flat() {
        let flat = [Vec3A::new(0.0, 2.0, 5.0), Vec3A::new(1.0, 2.0, 0.0), Vec3A::new(0.0, 2.0 + 0.5e-6, 1.0)];
        assert!(is_flat_along(Vec3A::Y, &flat));
        assert!(!is_flat_along(Vec3A::X, &flat));
        assert!(!is_flat_along(Vec3A::Z, &flat));
    }
}
