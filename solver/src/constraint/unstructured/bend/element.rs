//! One bend at a time.

use bevy_math::Vec3A;

use crate::{layout::simd::SHORTEST, material::Moduli, topology::Bend};

/// One bend: what the forces of the textbook and the energy follow.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BendElement {
    edge: Vec3A,
    span: Vec3A,
    /// s, no unit.
    sum: Vec3A,
}

impl BendElement {
    /// Between four points.
    pub fn new(bend: &Bend, [p0, p1, p2, p3]: [Vec3A; 4]) -> Self {
        let [_, w1, w2, w3] = bend.weights;
        Self { edge: p1 - p0, span: p3 - p2, sum: (p1 - p0) * w1 + (p2 - p0) * w2 + (p3 - p0) * w3 }
    }

    /// The frame's directions along the edge, across it, and normal.
    fn frame(&self) -> [Vec3A; 3] {
        let along = self.edge.normalize_or_zero();
        let across = (self.span - along * self.span.dot(along)).normalize_or_zero();
        [along, across, along.cross(across)]
    }

    /// s - R r.
    fn change(&self, bend: &Bend) -> Vec3A {
        let [along, across, normal] = self.frame();
        let [x, y, z] = bend.rest;
        self.sum - (along * x + across * y + normal * z)
    }

    /// Energy over the rigidity, no unit.
    pub fn energy(&self, bend: &Bend) -> f32 {
        0.5 * self.change(bend).length_squared()
    }

    /// Forces on its particles, N, with `rates` from their velocities (m/s).
    pub fn forces(&self, bend: &Bend, moduli: &Moduli, rates: &Self) -> [Vec3A; 4] {
        let [along, across, normal] = self.frame();
        let per = |length: f32| if length > SHORTEST { length.recip() } else { 0.0 };
        let skew = self.span.dot(along);
        let (per_length, per_width) = (per(self.edge.length()), per((self.span - along * skew).length()));
        let rise = normal.dot(rates.edge) * per_length;
        let turn = along * ((normal.dot(rates.span) - skew * rise) * per_width) - across * rise
            + normal * (across.dot(rates.edge) * per_length);
        let rate = rates.sum - turn.cross(self.sum);
        let stress = (self.change(bend) + rate * moduli.bend_damping) * moduli.bending;
        let torque = self.sum.cross(stress);
        let about_along = torque.dot(along) * per_width;
        let on_edge = across * (torque.dot(normal) * per_length)
            - normal * ((torque.dot(across) + about_along * skew) * per_length);
        let on_span = normal * about_along;
        let [_, w1, w2, w3] = bend.weights;
        let [one, two, three] = [on_edge - stress * w1, -on_span - stress * w2, on_span - stress * w3];
        [-(one + two + three), one, two, three]
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use proptest::{collection, prop_assert, proptest, test_runner::Config};

    use super::*;

    /// A hinge of two triangles that fold along the x axis, curved at rest.
    pub fn hinge() -> Bend {
        Bend { particles: [0, 1, 2, 3], weights: [7.0, 5.0, -8.0, -4.0], rest: [0.02, 0.05, 0.3] }
    }

    /// Its points and velocities, away from rest by random numbers.
    pub fn state(noise: &[f32]) -> ([Vec3A; 4], [Vec3A; 4]) {
        let places = [Vec3A::ZERO, Vec3A::X, Vec3A::new(0.4, -0.9, 0.2), Vec3A::new(0.6, 1.1, 0.1)];
        let by = |i: usize| Vec3A::from_slice(&noise[3 * i..]);
        ([0, 1, 2, 3].map(|i| places[i] + by(i) * 0.2), [4, 5, 6, 7].map(by))
    }

    proptest! {
        #![proptest_config(Config { failure_persistence: None, ..Config::default() })]

        #[test]
        fn forces_are_the_slope_of_the_energy_and_turn_nothing(noise in collection::vec(-1.0_f32..1.0, 24)) {
            let (points, velocities) = state(&noise);
            let bend = hinge();
            let moduli = Moduli { bending: 1.0, ..Moduli::default() };
            let forces = BendElement::new(&bend, points).forces(&bend, &moduli, &BendElement::new(&bend, velocities));
            let size: f32 = forces.iter().map(|force| force.length()).sum();
            for i in 0..4 {
                for axis in [Vec3A::X, Vec3A::Y, Vec3A::Z] {
                    let energy = |way: f32| {
                        let mut points = points;
                        points[i] += axis * way;
                        BendElement::new(&bend, points).energy(&bend)
                    };
                    let slope = (energy(4e-3) - energy(-4e-3)) / 8e-3;
                    prop_assert!((slope + forces[i].dot(axis)).abs() < 0.01 * size, "{slope} {}", forces[i]);
                }
            }
            let torque: Vec3A = points.iter().zip(&forces).map(|(p, force)| p.cross(*force)).sum();
            prop_assert!(torque.length() < 1e-3 * size, "{torque}");
            // The same where everything is damped, and a turn of the whole isn't.
            let damped = Moduli { bend_damping: 0.5, ..moduli };
            let with = |rates: [Vec3A; 4]| BendElement::new(&bend, points).forces(&bend, &damped, &BendElement::new(&bend, rates));
            let more = with(velocities);
            let torque: Vec3A = points.iter().zip(&more).map(|(p, force)| p.cross(*force)).sum();
            prop_assert!(torque.length() < 1e-3 * more.iter().map(|force| force.length()).sum::<f32>(), "{torque}");
            let work: f32 = (0..4).map(|i| (more[i] - forces[i]).dot(velocities[i])).sum();
            prop_assert!(work <= 1e-3, "{work}");
            let turning = with(points.map(|p| velocities[0].cross(p)));
            for i in 0..4 {
                prop_assert!((turning[i] - forces[i]).length() < 1e-3 * (size + velocities[0].length() * 20.0));
            }
        }
    }

    #[test]
    fn nothing_is_infinite_where_points_fall_together() {
        let moduli = Moduli { bending: 1e9, bend_damping: 1.0, ..Moduli::default() };
        for points in [[Vec3A::ZERO; 4], [Vec3A::ZERO, Vec3A::X, Vec3A::X, Vec3A::X]] {
            let bent = BendElement::new(&hinge(), points);
            assert!(bent.energy(&hinge()).is_finite());
            assert!(bent.forces(&hinge(), &moduli, &bent).iter().all(|force| force.is_finite()));
        }
    }
}
