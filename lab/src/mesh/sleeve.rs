//! A sleeve of equilateral triangles: closed rings of which each is turned by half a triangle against the next.

use core::f32::consts::TAU;

use bevy::{math::ops, prelude::*};

use super::{Sheet, Top};

/// Length of the sleeve, and of the way around it, m.
const SIZE: f32 = 0.7;

/// About `n` x `n` particles, ring by ring from the upper end.
pub fn sheet(n: u32) -> Sheet {
    let slope = 0.75_f32.sqrt();
    let around = ((n as f32 * slope.sqrt()).round() as u32).max(3);
    let rings = (around as f32 / slope).round() as u32 + 1;
    let place = |i: u32| {
        let (ring, column) = (i / around, i % around);
        let angle = TAU * (column as f32 + 0.5 * (ring % 2) as f32) / around as f32;
        let radius = SIZE / TAU;
        let height = SIZE * (0.5 - ring as f32 / (rings - 1) as f32);
        Vec3::new(radius * ops::cos(angle), height, radius * ops::sin(angle))
    };
    let cells = (0..rings - 1).flat_map(|ring| (0..around).map(move |column| (ring, column)));
    let triangles: Vec<[u32; 3]> = cells
        .flat_map(|(ring, column)| {
            let at = |down: u32, along: u32| (ring + down) * around + (column + along) % around;
            let [a, b, c, d] = [at(0, 0), at(0, 1), at(1, 0), at(1, 1)];
            if ring % 2 == 0 { [[a, b, c], [b, d, c]] } else { [[a, d, c], [a, b, d]] }
        })
        .collect();
    let mesh = super::assemble((0..around * rings).map(place).collect(), None, &triangles);
    Sheet { mesh, top: Top { direction: Vec3::Y, depth: Top::LEVEL, is_ring: true } }
}
