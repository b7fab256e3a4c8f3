//! Puts springs, triangles and areas of a rest shape together.

use bevy::{platform::collections::HashSet, prelude::*};

use super::{cells, coloring, edges::Edges, springs};
use crate::{error::ClothError, solver::Topology};

/// A triangle with less area than this share of its longest side squared is a sliver.
const SLIVER: f32 = 1e-6;

/// The topology of the particles at `rest` (m) joined by `triangles`.
///
/// Triangles that repeat others, as the back of a sheet modelled with two sides does, count once. Triangles without
/// area keep their edges as springs, and neither weigh nor catch wind.
pub(crate) fn build(rest: &[Vec3], triangles: &[[u32; 3]]) -> Result<Topology, ClothError> {
    let (triangles, slivers) = sort_out(rest, triangles);
    if triangles.is_empty() {
        return Err(ClothError::Empty);
    }
    let edges = Edges::new(&triangles);
    let cells = cells::find(rest, &triangles, &edges);
    let links = springs::find(rest, &triangles, &slivers, &edges, &cells);
    let (springs, batches) = coloring::batches(rest, &links);
    let areas = areas(rest, &triangles);
    Ok(Topology { rest: rest.to_vec(), springs, batches, triangles, areas, cells: cells.corners })
}

/// Splits triangles with distinct corners into those with an area and slivers, and drops repetitions.
fn sort_out(rest: &[Vec3], triangles: &[[u32; 3]]) -> (Vec<[u32; 3]>, Vec<[u32; 3]>) {
    let mut seen = HashSet::new();
    triangles
        .iter()
        .filter(|&&[i, j, k]| i != j && j != k && k != i)
        .filter(|&&triangle| {
            let mut corners = triangle;
            corners.sort_unstable();
            seen.insert(corners)
        })
        .partition(|triangle| {
            let [a, b, c] = triangle.map(|i| rest[i as usize]);
            let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
            area(a, b, c) > SLIVER * longest
        })
}

/// Area that each particle stands for, m². One without a triangle's area gets the mean, so that it isn't weightless.
fn areas(rest: &[Vec3], triangles: &[[u32; 3]]) -> Vec<f32> {
    let mut areas = vec![0.0; rest.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|i| rest[i as usize]);
        for &particle in triangle {
            areas[particle as usize] += area(a, b, c) / 3.0;
        }
    }
    let mean = areas.iter().sum::<f32>() / areas.len() as f32;
    for area in areas.iter_mut().filter(|area| **area == 0.0) {
        *area = mean;
    }
    areas
}

fn area(a: Vec3, b: Vec3, c: Vec3) -> f32 {
    0.5 * (b - a).cross(c - a).length()
}
