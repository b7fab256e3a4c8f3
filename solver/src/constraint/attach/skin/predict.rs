//! Where particles will touch their limits in an implicit step, which solves that along with the cloth as it does contacts with
//! obstacles (`constraint/implicit/contact.rs`).

use bevy_math::Vec3A;

use crate::{
    constraint::{attach::skin::SkinSolver, implicit::contact::PredictedContact},
    input::FARTHEST,
    layout::simd::LANES,
    particles::lanes::Lanes,
};

impl SkinSolver<'_> {
    /// Finds the particles that a free fall, m, would take beyond their limits, from where they would be without it.
    pub fn predict(&self, lanes: &Lanes, free_fall: Vec3A, contacts: &mut Vec<PredictedContact>) {
        for slot in 0..self.limits.blocks().len() * LANES {
            let (limit, lane) = (&self.limits.blocks()[slot / LANES], slot % LANES);
            let inverse_mass = lanes.inverse_mass(slot);
            let [from, to] = self.points.way(slot);
            let is_near = [from, to].iter().all(|place| place.length_squared() <= FARTHEST * FARTHEST);
            if !limit.is_limited || inverse_mass == 0.0 || !is_near {
                continue;
            }
            let [target_before, target] = [self.span.start, self.span.end].map(|part| from.lerp(to, part));
            let (fallen, way) = (lanes.position.get(slot) + free_fall - target, target - target_before);
            let mut touch = |normal: Vec3A, friction: f32| {
                contacts.push(PredictedContact::of_particle(slot as u32, inverse_mass, [normal, way], friction));
            };
            let (direction, length) = fallen.normalize_and_length();
            if length > limit.max_distance[lane] {
                touch(-direction, 0.0);
            }
            let radius = limit.backstop_radius[lane];
            if radius > 0.0 {
                let normal = self.points.normal(slot, self.span.end).normalize_or_zero();
                let from_centre = fallen + normal * (limit.backstop_distance[lane] + radius);
                let (direction, length) = from_centre.normalize_and_length();
                if length < radius && normal != Vec3A::ZERO {
                    touch(direction, self.friction);
                }
            }
        }
    }
}
