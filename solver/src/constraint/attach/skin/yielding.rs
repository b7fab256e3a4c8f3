//! What holds a cloth by its length gives way to its skin: skinning stretches meshes, by a quarter at the joints of common models.
//!
//! A tether becomes as long as the mesh asks for at least, from its pin to as far as the particle may be from its place,
//!
//! length = max(L, (|t - t_pin| - D) / (1 + slack))
//!
//! and where D is less than an edge there is none: the mesh itself says where the particle is. Levels leave such particles alone.

use bevy_math::Vec3A;

use crate::{
    constraint::attach::skin::SkinPoints,
    input::{Skin, SkinLimits, StepContext, Tethers},
    topology::{
        Topology,
        level::{Level, TransferOperator},
    },
};

/// The tethers of a cloth with a skin, in a step.
#[derive(Clone, Debug, Default)]
pub(crate) struct YieldingTethers {
    /// Whether these are those of the step.
    is_used: bool,
    tethers: Tethers,
}

impl YieldingTethers {
    /// Lengthens the tethers of a step for its skin, if it has one.
    pub fn begin(&mut self, ctx: &StepContext, topology: &Topology, points: &SkinPoints) {
        let both = points.of(ctx).zip(ctx.tethers);
        self.is_used = both.is_some();
        let Some((Skin { limits, .. }, built)) = both else { return };
        let (order, give) = (topology.order(), 1.0 + ctx.slack());
        self.tethers.copy_with_lengths(built, |level, slot, pin, length| {
            let (way, most) = match level {
                None => of_slot(slot, points, limits),
                Some(level) => of_node(&topology.levels[level], slot, points, limits),
            };
            if limits.is_tight(most) {
                return f32::INFINITY;
            }
            let pin = points.way(order.slot(pin));
            let farthest = way[0].distance(pin[0]).max(way[1].distance(pin[1])) - most;
            // The larger of a length and what is no number is the length.
            length.max(farthest / give)
        });
    }

    /// The tethers of the step.
    pub fn of<'a>(&'a self, ctx: &StepContext<'a>) -> Option<&'a Tethers> {
        if self.is_used { Some(&self.tethers) } else { ctx.tethers }
    }
}

/// Where the mesh has a node of a level at the start and the end of the step, m, and how far from there it may be, m.
fn of_node(level: &Level, node: usize, points: &SkinPoints, limits: &SkinLimits) -> ([Vec3A; 2], f32) {
    let corners = match &level.transfer {
        TransferOperator::Lattice { slots, .. } => {
            let slot = slots.as_flattened()[node];
            return if slot == Level::NOBODY {
                ([Vec3A::NAN; 2], f32::INFINITY)
            } else {
                of_slot(slot as usize, points, limits)
            };
        }
        TransferOperator::Chart { nodes, .. } => &nodes[node],
    };
    let (mut way, mut most) = ([Vec3A::ZERO; 2], 0.0);
    for (&corner, &weight) in corners.0.iter().zip(&corners.1).filter(|(_, weight)| **weight > 0.0) {
        let (of_corner, farthest) = of_slot(corner as usize, points, limits);
        way.iter_mut().zip(of_corner).for_each(|(sum, place)| *sum += place * weight);
        most += farthest * weight;
    }
    (way, most)
}

/// The same of a particle in a slot.
fn of_slot(slot: usize, points: &SkinPoints, limits: &SkinLimits) -> ([Vec3A; 2], f32) {
    (points.way(slot), limits.max_distance(slot))
}
