//! What can be wrong with a mesh.

use bevy::{
    mesh::{Indices, PrimitiveTopology, VertexAttributeValues},
    prelude::*,
};

use super::super::dice::Dice;

/// Points and triangles of a mesh, to be changed.
struct Parts {
    points: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    /// The longest side of the box around it.
    size: f32,
}

/// Does something to a mesh that is a list of triangles, and adds what to what is `told`.
pub fn harm(dice: &mut Dice, mesh: &mut Mesh, told: &mut String) {
    let Some(mut parts) = Parts::of(mesh) else { return };
    *told += &match dice.count(0..=19) {
        0..=3 => parts.jitter(dice),
        4..=6 => parts.double(dice),
        7 | 8 => parts.collapse(dice),
        9..=11 => parts.flatten(dice),
        12 | 13 => parts.turn_over(dice),
        14 | 15 => parts.merge(dice),
        16 | 17 => parts.join(dice),
        18 => parts.leave_out(dice),
        _ => parts.spoil(dice),
    };
    parts.write(mesh);
}

impl Parts {
    fn of(mesh: &Mesh) -> Option<Self> {
        let VertexAttributeValues::Float32x3(points) = mesh.attribute(Mesh::ATTRIBUTE_POSITION)? else { return None };
        if mesh.primitive_topology() != PrimitiveTopology::TriangleList {
            return None;
        }
        let points: Vec<Vec3> = points.iter().copied().map(Vec3::from).collect();
        let corners: Vec<u32> = mesh.indices()?.iter().map(|corner| corner as u32).collect();
        let low = points.iter().copied().reduce(Vec3::min)?;
        let high = points.iter().copied().reduce(Vec3::max)?;
        let triangles = corners.as_chunks().0.to_vec();
        (!triangles.is_empty()).then(|| Self { points, triangles, size: (high - low).max_element() })
    }

    fn write(self, mesh: &mut Mesh) {
        let points: Vec<[f32; 3]> = self.points.iter().map(Vec3::to_array).collect();
        mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, points);
        mesh.insert_indices(Indices::U32(self.triangles.as_flattened().to_vec()));
    }

    fn some_triangle(&self, dice: &mut Dice) -> [u32; 3] {
        let last = self.points.len() as u32 - 1;
        dice.any(&self.triangles).unwrap_or_default().map(|corner| corner.min(last))
    }

    fn some_vertex(&self, dice: &mut Dice) -> usize {
        dice.count(0..=self.points.len() as u32 - 1) as usize
    }

    /// Moves every point.
    fn jitter(&mut self, dice: &mut Dice) -> String {
        let most = self.size * dice.spread(1e-5, 0.3);
        self.points.iter_mut().for_each(|point| *point += dice.vector(most));
        ", jittered".into()
    }

    /// Has some triangles twice, the one way around or the other.
    fn double(&mut self, dice: &mut Dice) -> String {
        let all = dice.chance(0.3);
        let is_turned = dice.chance(0.5);
        let chosen: Vec<[u32; 3]> = self.triangles.iter().copied().filter(|_| all || dice.chance(0.2)).collect();
        self.triangles.extend(chosen.into_iter().map(|[a, b, c]| if is_turned { [a, c, b] } else { [b, c, a] }));
        ", doubled".into()
    }

    /// Has triangles that are a line or a point.
    fn collapse(&mut self, dice: &mut Dice) -> String {
        for _ in 0..dice.count(1..=5) {
            let [a, b, _] = self.some_triangle(dice);
            self.triangles.push(if dice.chance(0.5) { [a, a, b] } else { [a, a, a] });
        }
        ", with collapsed triangles".into()
    }

    /// Makes triangles slivers.
    fn flatten(&mut self, dice: &mut Dice) -> String {
        for _ in 0..dice.count(1..=5) {
            let [a, b, c] = self.some_triangle(dice).map(|corner| corner as usize);
            let on_side = self.points[a].lerp(self.points[b], dice.within(0.0, 1.0));
            let height = dice.spread(1e-8, 0.1);
            self.points[c] = on_side.lerp(self.points[c], height);
        }
        ", with slivers".into()
    }

    /// Winds some triangles the other way around.
    fn turn_over(&mut self, dice: &mut Dice) -> String {
        self.triangles.iter_mut().filter(|_| dice.chance(0.3)).for_each(|triangle| triangle.swap(0, 1));
        ", turned over in part".into()
    }

    /// Puts vertices where others are, or nearly so.
    fn merge(&mut self, dice: &mut Dice) -> String {
        for _ in 0..dice.count(1..=3) {
            let (one, other) = (self.some_vertex(dice), self.some_vertex(dice));
            let apart = if dice.chance(0.5) { Vec3::ZERO } else { dice.vector(self.size * 1e-5) };
            self.points[one] = self.points[other] + apart;
        }
        ", with merged vertices".into()
    }

    /// Joins vertices that have nothing to do with each other.
    fn join(&mut self, dice: &mut Dice) -> String {
        for _ in 0..dice.count(1..=4) {
            let corners = [(); 3].map(|()| self.some_vertex(dice) as u32);
            self.triangles.push(corners);
        }
        ", with fins".into()
    }

    /// Leaves out triangles, and so maybe vertices.
    fn leave_out(&mut self, dice: &mut Dice) -> String {
        let first = self.triangles[0];
        self.triangles.retain(|_| dice.chance(0.7));
        self.triangles.push(first);
        ", with holes".into()
    }

    /// Writes what can't be read.
    fn spoil(&mut self, dice: &mut Dice) -> String {
        if dice.chance(0.2) {
            self.triangles[0][1] = self.points.len() as u32 + dice.count(0..=9);
            return ", with an index past the last vertex".into();
        }
        let vertex = self.some_vertex(dice);
        let odd = dice.anything();
        self.points[vertex][dice.count(0..=2) as usize] = odd;
        format!(", with {odd} in the position of vertex {vertex}")
    }
}
