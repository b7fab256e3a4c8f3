//! A body and what is fixed to it, as one.

use bevy_math::{Mat3A, Vec3A};

use crate::input::Body;

/// A body with the cloth's own mass at its pins.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CombinedBody {
    /// Number of pins, and how far the farthest is from the body's centre of mass, m.
    pub pin_count: f32,
    pub reach: f32,
    /// Inverse mass of all, 1/kg.
    pub inverse_mass: f32,
    /// Inverse of the tensor of inertia of all about their centre of mass, 1/(kg m²).
    pub inverse_inertia: Mat3A,
    /// From the body's centre of mass to that of all, m.
    pub offset: Vec3A,
    /// What the body itself has of an angular momentum of all.
    pub part: Mat3A,
}

impl CombinedBody {
    /// Of a body and `masses` (kg) at arms (m) from its centre of mass.
    pub fn new<I: Iterator<Item = (Vec3A, f32)>>(body: &Body, masses: impl Fn() -> I) -> Self {
        let (count, mass, moment) = masses().fold((0.0, 0.0, Vec3A::ZERO), |(count, sum, moment), (arm, mass)| {
            (count + 1.0, sum + mass, moment + arm * mass)
        });
        let inverse_mass = body.inverse_mass / (1.0 + body.inverse_mass * mass);
        let offset = moment * inverse_mass;
        let added = masses()
            .fold(around(offset) * body.inverse_mass.recip(), |added, (arm, mass)| added + around(arm - offset) * mass);
        // (I + added)^-1, where only I^-1 is known and may have no inverse: I^-1 (1 + added I^-1)^-1.
        let part = (Mat3A::IDENTITY + added * body.inverse_inertia).inverse();
        let reach = masses().map(|(arm, _)| arm.length()).fold(0.0, f32::max);
        Self { pin_count: count, reach, inverse_mass, inverse_inertia: body.inverse_inertia * part, offset, part }
    }

    /// Largest velocity that a push of 1 N s at `arm` (m) from the body's centre of mass gives it there, m/s.
    pub fn effective_inverse_mass(&self, arm: Vec3A) -> f32 {
        let arm = arm - self.offset;
        let turned = |axis: Vec3A| (self.inverse_inertia * arm.cross(axis)).cross(arm).length_squared();
        // No axis of a matrix gives more than all together.
        self.inverse_mass + Vec3A::AXES.map(turned).iter().sum::<f32>().sqrt()
    }
}

/// Tensor of inertia of 1 kg at `arm`, kg m².
fn around(arm: Vec3A) -> Mat3A {
    let column = |axis: Vec3A| axis * arm.length_squared() - arm * arm.dot(axis);
    Mat3A::from_cols(column(Vec3A::X), column(Vec3A::Y), column(Vec3A::Z))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ball() -> Body {
        let inverse_inertia = Mat3A::from_diagonal(Vec3A::splat(4.0).into());
        Body { inverse_mass: 0.5, inverse_inertia, centre: Vec3A::ZERO }
    }

    #[test]
    fn a_push_gives_what_the_body_has_there() {
        let load = CombinedBody::new(&ball(), || [].into_iter());
        assert_eq!(load.effective_inverse_mass(Vec3A::ZERO), 0.5);
        // Across the arm: 1 / M + r² / I.
        let across = 0.5 + 4.0 * 0.09;
        let given = load.effective_inverse_mass(Vec3A::X * 0.3);
        assert!((across..1.5 * across).contains(&given), "{given}");
    }

    #[test]
    fn two_of_a_mass_turn_about_their_middle() {
        let point = Body { inverse_inertia: Mat3A::from_diagonal(Vec3A::splat(1e6).into()), ..ball() };
        let load = CombinedBody::new(&point, || [(Vec3A::X, 2.0)].into_iter());
        assert_eq!(load.inverse_mass, 0.25);
        assert_eq!(load.offset, Vec3A::X * 0.5);
        // 2 kg each half a metre away.
        assert!((load.inverse_inertia.z_axis.z - 1.0).abs() < 1e-3, "{}", load.inverse_inertia);
        assert!(load.part.z_axis.z < 1e-3, "the body itself hardly turns: {}", load.part);
    }

    #[test]
    fn what_cannot_turn_does_not_turn_with_a_load() {
        let locked = Body { inverse_inertia: Mat3A::ZERO, ..ball() };
        let load = CombinedBody::new(&locked, || [(Vec3A::X, 2.0)].into_iter());
        assert_eq!(load.inverse_inertia, Mat3A::ZERO);
        assert!(load.part.is_finite());
    }
}
