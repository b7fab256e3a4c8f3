//! A skirt: closed rings from the waist down to the hem, a cone that is cut off at the top.

use core::f32::consts::TAU;

use bevy::{math::ops, prelude::*};

use super::{Sheet, Top};

/// Radius of the top ring, m.
const WAIST: f32 = 0.12;

/// Radius of the lowest ring, m.
const HEM: f32 = 0.35;

/// From waist to hem along the cloth, m.
const LENGTH: f32 = 0.6;

/// `n` particles around in `n` rings (three around and two rings at least), ring by ring from the waist.
///
/// As an exporter makes it, each ring has a vertex more than particles: its two ends share a place at the UV seam.
pub fn sheet(n: u32) -> Sheet {
    let (around, rings) = (n.max(3), n.max(2));
    let height = (LENGTH * LENGTH - (HEM - WAIST) * (HEM - WAIST)).sqrt();
    let mut positions = Vec::new();
    let mut uvs = Vec::new();
    for ring in 0..rings {
        for column in 0..=around {
            let uv = Vec2::new(column as f32 / around as f32, ring as f32 / (rings - 1) as f32);
            // The last column is the first again, to the bit.
            let angle = TAU * (column % around) as f32 / around as f32;
            let radius = WAIST + uv.y * (HEM - WAIST);
            positions.push(Vec3::new(radius * ops::cos(angle), height * (0.5 - uv.y), radius * ops::sin(angle)));
            uvs.push(uv);
        }
    }
    let mesh = super::assemble(positions, Some(uvs), &triangles(around, rings));
    Sheet { mesh, top: Top { direction: Vec3::Y, depth: Top::LEVEL, is_ring: true } }
}

/// Facing out. The diagonals alternate, as those of a grid do.
fn triangles(around: u32, rings: u32) -> Vec<[u32; 3]> {
    let cells = (0..rings - 1).flat_map(|ring| (0..around).map(move |column| (ring, column)));
    cells
        .flat_map(|(ring, column)| {
            let a = ring * (around + 1) + column;
            let (b, c, d) = (a + 1, a + around + 1, a + around + 2);
            if (ring + column) % 2 == 0 { [[a, b, c], [b, d, c]] } else { [[a, b, d], [a, d, c]] }
        })
        .collect()
}
