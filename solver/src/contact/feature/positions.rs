//! Where particles are, from all cloths and back to them.

use core::ops::Range;

use bevy_math::Vec3A;

use crate::{
    contact::feature::{ClothInStep, FeatureContacts},
    layout::{order::Order, points::Points, simd::SimdLevel},
    particles::lanes::Lanes,
    shape::Shape,
};

impl FeatureContacts {
    /// Reads where all particles are, and where they were when the substep began.
    pub(crate) fn take_places(&mut self, cloths: &[impl ClothInStep]) {
        self.first.clear();
        self.first.push(0);
        for cloth in cloths {
            let first = self.first[self.first.len() - 1];
            self.first.push(first + cloth.topology().particle_count() as u32);
        }
        let count = self.particle_count() + self.fixed.len();
        for (i, cloth) in cloths.iter().enumerate() {
            let particles = self.particles(i);
            let Lanes { order, position, previous, .. } = &cloth.lanes();
            for (values, of) in [(&mut self.points.position, position), (&mut self.points.previous, previous)] {
                values.resize(count, Vec3A::ZERO);
                of.store(*order, &mut values[particles.clone()], cloth.simd_level());
                if cloth.offset() != Vec3A::ZERO {
                    values[particles.clone()].iter_mut().for_each(|p| *p += cloth.offset());
                }
            }
        }
    }

    /// Number of all particles.
    pub(crate) fn particle_count(&self) -> usize {
        self.first[self.first.len() - 1] as usize
    }

    /// Numbers of the particles of a cloth.
    pub(crate) fn particles(&self, cloth: usize) -> Range<usize> {
        self.first[cloth] as usize..self.first[cloth + 1] as usize
    }

    /// Hands back where particles are, and, where pairs have parted, where they were when the part `span` of the step began.
    pub(crate) fn give_places(&mut self, cloths: &mut [impl ClothInStep], span: Range<f32>) {
        for (i, cloth) in cloths.iter_mut().enumerate() {
            let particles = self.particles(i);
            if self.points.has_parted {
                let now = &mut self.points.position[particles.clone()];
                let before = &mut self.points.previous[particles.clone()];
                keep_out(cloth, now, before, &span);
                let (offset, simd_level) = (cloth.offset(), cloth.simd_level());
                let Lanes { order, previous, .. } = cloth.lanes_mut();
                put(before, offset, previous, *order, simd_level);
            }
            let (offset, simd_level) = (cloth.offset(), cloth.simd_level());
            let Lanes { order, position, .. } = cloth.lanes_mut();
            put(&mut self.points.position[particles], offset, position, *order, simd_level);
        }
    }
}

fn put(places: &mut [Vec3A], offset: Vec3A, lanes: &mut Points, order: Order, simd_level: SimdLevel) {
    if offset != Vec3A::ZERO {
        places.iter_mut().for_each(|p| *p -= offset);
    }
    lanes.load(order, places, simd_level);
}

/// Takes particles that parted into a solid back to its surface, without a change of speed: those that were outside at the start
/// of the substep stay so, and aren't taken for ones that have begun inside.
fn keep_out(cloth: &impl ClothInStep, now: &mut [Vec3A], before: &mut [Vec3A], span: &Range<f32>) {
    let Lanes { order, previous, .. } = &cloth.lanes();
    for (i, obstacle) in cloth.ctx().obstacles.iter().enumerate() {
        let Shape::Solid(solid) = &obstacle.shape else { continue };
        let distance = cloth.ctx().contact_distance() + obstacle.rounding;
        let [pose, _] = cloth.bodies().poses(cloth.ctx(), i, span.clone());
        let to_local = pose.inverse();
        let depth_at = |place: Vec3A| {
            let surface = solid.surface(to_local.transform_point(place));
            (distance - surface.distance, surface.normal)
        };
        for (particle, (place, now)) in before.iter_mut().zip(&mut *now).enumerate() {
            let from = previous.get(order.slot(particle as u32));
            if *place - cloth.offset() == from {
                continue;
            }
            let (depth, normal) = depth_at(*place - cloth.offset());
            let penetration = depth.max(0.0) - depth_at(from).0.max(0.0);
            if penetration > 0.0 {
                let out = pose.rotation * normal * penetration;
                *place += out;
                *now += out;
            }
        }
    }
}
