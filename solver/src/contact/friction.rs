//! The impulse of a contact: what moves by it, and Coulomb's rule at the level of positions.
//!
//! ```text
//!   lambda = penetration / w(normal)              w: effective inverse mass along a direction
//!   drag   = min(slide / w(along), mu lambda)     holds a slide as far as the normal impulse carries it
//! ```
//!
//! All are times h, so in kg m. Müller et al., "Detailed Rigid Body Simulation with Extended Position Based Dynamics" (2020),
//! section 3.5.

use bevy_math::Vec3A;

use crate::layout::number::Number;

/// Largest displacement of a particle as a multiple of that by which its features part, no unit. One that touches right beside a
/// pin would have to go any distance, since the pin doesn't move.
pub const MOST_LEVERAGE: f32 = 10.0;

/// Effective inverse mass of points that move by their `weights`, 1/kg: the sum of their inverse masses, by the squares of those.
/// No less than what moves each point by [`MOST_LEVERAGE`] times as much as it moves the features.
#[inline]
pub fn effective_inverse_mass<const N: usize>(weights: [f32; N], inverse_masses: [f32; N]) -> f32 {
    let (mut whole, mut most) = (0.0, 0.0_f32);
    for (weight, w) in weights.into_iter().zip(inverse_masses) {
        whole += weight * weight * w;
        most = most.max(weight.abs() * w);
    }
    whole.max(most / MOST_LEVERAGE)
}

/// Impulse of the friction that holds a slide, times h, kg m: `stopping` would stop it, and `lambda` is the normal impulse.
#[inline(always)]
pub fn drag<N: Number>(stopping: N, lambda: N, friction: f32) -> N {
    stopping.at_most(lambda * friction)
}

/// Impulse of one contact with friction, times h, kg m: of the normal impulse `lambda` along the unit vector `normal`, against
/// what of a `displacement` within the substep (m) slides across that.
#[inline]
pub fn impulse(
    [normal, displacement]: [Vec3A; 2],
    lambda: f32,
    friction: f32,
    effective_inverse_mass: impl Fn(Vec3A) -> f32,
) -> Vec3A {
    let (along, slide) = (displacement - normal * displacement.dot(normal)).normalize_and_length();
    let push = normal * lambda;
    if slide > 0.0 { push - along * drag(slide / effective_inverse_mass(along), lambda, friction) } else { push }
}
