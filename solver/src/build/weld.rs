//! Which render vertices are one particle.
//!
//! A mesh repeats a vertex wherever its UVs or normals jump. Cloth must not come apart there, so vertices that share a
//! position share a particle.

use core::iter::successors;

use bevy_math::{IVec3, Vec2, Vec3};
use bevy_platform::collections::HashMap;

/// Vertices nearer than this share of the mesh's size are one: exporters and generated seams round differently.
const TOLERANCE: f32 = 1e-5;

/// Side of the cells in which vertices are looked up, in tolerances: most look into one cell, and few are in each.
const CELL: f32 = 8.0;

/// In [`Welded::particle_of_vertex`]: the vertex is in no triangle and isn't simulated.
pub const NO_PARTICLE: u32 = u32::MAX;

/// The particles of a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Welded {
    /// Particle of each vertex, or [`NO_PARTICLE`].
    pub particle_of_vertex: Vec<u32>,
    /// One vertex of each particle, the first.
    pub vertex_of_particle: Vec<u32>,
}

impl Welded {
    /// Numbers the particles anew: the first is to be what is now number `order[0]`.
    pub fn reorder(&mut self, order: &[u32]) {
        let mut new_number = vec![NO_PARTICLE; order.len()];
        for (new, &old) in (0..).zip(order) {
            new_number[old as usize] = new;
        }
        for particle in self.particle_of_vertex.iter_mut().filter(|particle| **particle != NO_PARTICLE) {
            *particle = new_number[*particle as usize];
        }
        self.vertex_of_particle = order.iter().map(|&old| self.vertex_of_particle[old as usize]).collect();
    }

    /// One value for each particle, if its vertices have the same one.
    pub fn shared(&self, of_vertices: &[Vec2]) -> Option<Vec<Vec2>> {
        let values: Vec<Vec2> = self.vertex_of_particle.iter().map(|&vertex| of_vertices[vertex as usize]).collect();
        let of_particle = |particle: u32| values.get(particle as usize);
        let mut vertices = self.particle_of_vertex.iter().zip(of_vertices);
        vertices.all(|(&particle, value)| of_particle(particle).is_none_or(|of| of == value)).then_some(values)
    }
}

/// Welds the vertices that `triangles` use. Particles are numbered in the order of their first vertex.
pub fn weld(positions: &[Vec3], triangles: &[[u32; 3]]) -> Welded {
    let mut used = vec![false; positions.len()];
    for &vertex in triangles.as_flattened() {
        used[vertex as usize] = true;
    }
    let (low, high) = bounds(positions, &used);
    let tolerance = (low.distance(high) * TOLERANCE).max(f32::MIN_POSITIVE);
    let cell = |place: Vec3| (place / (CELL * tolerance)).floor().as_ivec3();
    // The latest particle in each cell, and the one before each in its cell.
    let mut latest: HashMap<IVec3, u32> = HashMap::default();
    let mut before: Vec<Option<u32>> = Vec::new();
    let mut welded = Welded { particle_of_vertex: vec![NO_PARTICLE; positions.len()], vertex_of_particle: Vec::new() };
    for vertex in (0..positions.len()).filter(|&v| used[v]) {
        let position = positions[vertex];
        let place = position - low;
        let is_near = |&particle: &u32| {
            let first = positions[welded.vertex_of_particle[particle as usize] as usize];
            first.distance(position) <= tolerance
        };
        let near = cells_between(cell(place - tolerance), cell(place + tolerance))
            .flat_map(|cell| successors(latest.get(&cell).copied(), |&particle| before[particle as usize]))
            .filter(is_near)
            .min();
        welded.particle_of_vertex[vertex] = near.unwrap_or_else(|| {
            let particle = welded.vertex_of_particle.len() as u32;
            welded.vertex_of_particle.push(vertex as u32);
            before.push(latest.insert(cell(place), particle));
            particle
        });
    }
    welded
}

/// Corners of the box around the `positions` that are used.
fn bounds(positions: &[Vec3], used: &[bool]) -> (Vec3, Vec3) {
    let used = || positions.iter().zip(used).filter(|&(_, &used)| used).map(|(&position, _)| position);
    (used().reduce(Vec3::min).unwrap_or_default(), used().reduce(Vec3::max).unwrap_or_default())
}

/// All cells from `low` to `high`, both among them.
fn cells_between(low: IVec3, high: IVec3) -> impl Iterator<Item = IVec3> {
    (low.x..=high.x)
        .flat_map(move |x| (low.y..=high.y).flat_map(move |y| (low.z..=high.z).map(move |z| IVec3::new(x, y, z))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_at_one_place_are_one_particle() {
        let p = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X + 1e-7, Vec3::Y, Vec3::ONE];
        let welded = weld(&p, &[[0, 1, 2], [3, 5, 4]]);
        assert_eq!(welded.particle_of_vertex, [0, 1, 2, 1, 2, 3]);
        assert_eq!(welded.vertex_of_particle, [0, 1, 2, 5]);
    }

    #[test]
    fn vertices_are_welded_across_the_cells_in_which_they_are_looked_up() {
        // Pairs closer than the tolerance at places all along a cell, and a triangle that gives the mesh its size.
        let place = |i: u32| Vec3::new(0.3 + i as f32 * 1e-6, 0.0, 0.0);
        for i in 0..100 {
            let p = [Vec3::ZERO, Vec3::X, Vec3::Y, place(i), place(i) + 8e-6];
            assert_eq!(weld(&p, &[[0, 1, 2], [3, 1, 2], [4, 1, 2]]).particle_of_vertex, [0, 1, 2, 3, 3]);
        }
    }

    #[test]
    fn vertices_without_a_triangle_are_no_particle() {
        let welded = weld(&[Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z], &[[0, 1, 3]]);
        assert_eq!(welded.particle_of_vertex, [0, 1, NO_PARTICLE, 2]);
    }
}
