//! Springs that carry a part of a sheet: sides of triangles without area, which have no strains. Few, one by one.

use bevy_math::Vec3A;

use crate::{
    constraint::strand::law::DirectionModuli,
    layout::simd::SHORTEST,
    topology::{Spring, Topology},
};

/// The springs of a topology that carry a part of a sheet.
pub(super) fn carrying(topology: &Topology) -> impl Iterator<Item = &Spring> {
    let batches = topology.batches.iter().filter(|batch| batch.carries);
    batches.flat_map(|batch| &topology.springs[batch.range.clone()]).filter(|spring| spring.share != [0.0; 3])
}

/// What the gradient and the second derivatives of a spring's energy are made of, times h².
#[derive(Clone, Copy, Debug)]
pub(super) struct EdgeTangent {
    ends: [u32; 2],
    /// From the one end to the other.
    along: Vec3A,
    /// Force, kg m, stiffness along the spring less that across it, and across it, kg.
    force: f32,
    stiffness: f32,
    tension: f32,
}

impl EdgeTangent {
    /// That of a spring between particles that are there `now`, and were there `before` the substep, m.
    pub fn new(spring: &Spring, [warp, weft]: &[DirectionModuli; 2], now: &[[f32; 4]], before: &[[f32; 4]]) -> Self {
        let span = |list: &[[f32; 4]]| {
            let [a, b] = [spring.a, spring.b].map(|i| Vec3A::from_slice(&list[i as usize]));
            b - a
        };
        let way = span(now);
        let length = way.length().max(SHORTEST);
        let along = way / length;
        let [u, v, g] = spring.share;
        let stiffness = (u * warp.stretch + v * weft.stretch + g * warp.shear).max(0.0);
        let rate = along.dot(way - span(before)) * warp.damping;
        let force = stiffness * (length - spring.rest + rate);
        let tension = force.max(0.0) / length;
        let stiffness = stiffness * (1.0 + warp.damping) - tension;
        Self { ends: [spring.a, spring.b], along, force, stiffness, tension }
    }

    /// Adds the gradient of the energy.
    pub fn pull(&self, sums: &mut [[f32; 4]]) {
        self.add(self.along * self.force, sums);
    }

    /// Adds the second derivatives times a direction.
    pub fn multiply(&self, direction: &[[f32; 4]], sums: &mut [[f32; 4]]) {
        let [a, b] = self.ends.map(|i| Vec3A::from_slice(&direction[i as usize]));
        let way = b - a;
        self.add(self.along * (self.along.dot(way) * self.stiffness) + way * self.tension, sums);
    }

    fn add(&self, pull: Vec3A, sums: &mut [[f32; 4]]) {
        for (end, pull) in self.ends.into_iter().zip([-pull, pull]) {
            let sum = &mut sums[end as usize];
            for (sum, pull) in sum.iter_mut().zip(pull.to_array()) {
                *sum += pull;
            }
        }
    }
}
