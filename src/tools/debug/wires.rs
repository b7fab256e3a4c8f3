//! Which edges of a mesh are drawn.

use std::sync::{Arc, Weak};

use crate::solver::TriangleMesh;

/// Lines to a mesh, at most.
const MOST: usize = 10_000;

/// Cosine of the angle from which on an edge is sharp: 30 degrees.
const SHARP: f32 = 0.866;

/// The edges that are drawn of meshes, worked out once for each.
#[derive(Debug, Default)]
pub(super) struct Wires(Vec<(Weak<TriangleMesh>, Vec<[u32; 2]>)>);

impl Wires {
    /// The edges that are drawn of a mesh, by the numbers of their ends.
    pub fn of(&mut self, mesh: &Arc<TriangleMesh>) -> &[[u32; 2]] {
        let is_it = |(known, _): &(Weak<TriangleMesh>, _)| core::ptr::eq(known.as_ptr(), Arc::as_ptr(mesh));
        let index = self.0.iter().position(is_it).unwrap_or_else(|| {
            // What isn't used any more goes when there is something new.
            self.0.retain(|(known, _)| known.strong_count() > 0);
            self.0.push((Arc::downgrade(mesh), edges(mesh)));
            self.0.len() - 1
        });
        &self.0[index].1
    }
}

/// All edges of a mesh, or, where they are too many, the sharp ones and some of the others.
fn edges(mesh: &TriangleMesh) -> Vec<[u32; 2]> {
    let mut sides: Vec<([u32; 2], usize)> = Vec::new();
    for (number, &[a, b, c]) in mesh.triangles().iter().enumerate() {
        sides.extend([[a, b], [b, c], [c, a]].map(|[a, b]| ([a.min(b), a.max(b)], number)));
    }
    sides.sort_unstable();
    let normal = |number: usize| {
        let [a, b, c] = mesh.triangles()[number].map(|i| mesh.points[i as usize]);
        (b - a).cross(c - a).normalize_or_zero()
    };
    let (mut sharp, mut smooth) = (Vec::new(), Vec::new());
    for sides in sides.chunk_by(|(one, _), (other, _)| one == other) {
        let is_smooth = matches!(*sides, [(_, a), (_, b)] if normal(a).dot(normal(b)) > SHARP);
        if is_smooth { &mut smooth } else { &mut sharp }.push(sides[0].0);
    }
    let mut drawn = thinned(sharp, MOST);
    let more = MOST - drawn.len();
    drawn.extend(thinned(smooth, more));
    drawn
}

/// At most so many of the edges, from all over.
fn thinned(edges: Vec<[u32; 2]>, most: usize) -> Vec<[u32; 2]> {
    let count = edges.len();
    let kept = count.min(most);
    (0..kept).map(|i| edges[i * count / kept]).collect()
}

#[cfg(test)]
mod tests {
    use bevy::math::Vec3A;

    use super::*;

    /// A square metre of so many cells, with a wall along one side.
    fn sheet(cells: u32) -> TriangleMesh {
        let row = cells + 1;
        let place = |i: u32| Vec3A::new((i % row) as f32, 0.0, (i / row) as f32) / cells as f32;
        let mut points: Vec<Vec3A> = (0..row * row).map(place).collect();
        points.push(Vec3A::Y);
        let cell = |i: u32| {
            let a = i / cells * row + i % cells;
            [[a, a + row, a + 1], [a + 1, a + row, a + row + 1]]
        };
        let mut triangles: Vec<[u32; 3]> = (0..cells * cells).flat_map(cell).collect();
        triangles.push([0, 1, row * row]);
        TriangleMesh::new(points, &triangles, false)
    }

    #[test]
    fn each_edge_is_drawn_once() {
        let mut drawn = edges(&sheet(4));
        assert_eq!(drawn.len(), 4 * 5 * 2 + 16 + 2);
        drawn.sort_unstable();
        drawn.dedup();
        assert_eq!(drawn.len(), 4 * 5 * 2 + 16 + 2);
    }

    #[test]
    fn of_too_many_edges_all_sharp_ones_are_drawn() {
        let mesh = sheet(100);
        let drawn = edges(&mesh);
        assert_eq!(drawn.len(), MOST);
        let wall = 101 * 101;
        for edge in [[0, 1], [0, wall], [1, wall], [7, 8], [101 * 7, 101 * 8]] {
            assert!(drawn.contains(&edge), "{edge:?}");
        }
        let far = drawn.iter().filter(|edge| edge[0] > 90 * 101).count();
        assert!((500..1500).contains(&far), "the others come from all over: {far}");
    }

    #[test]
    fn edges_are_worked_out_once_as_long_as_the_mesh_lives() {
        let mut wires = Wires::default();
        let [one, other] = [2, 3].map(|cells| Arc::new(sheet(cells)));
        let first = wires.of(&one).as_ptr();
        assert_ne!(wires.of(&other).len(), wires.of(&one).len());
        assert_eq!(wires.of(&one).as_ptr(), first);
        drop((one, other));
        wires.of(&Arc::new(sheet(1)));
        assert_eq!(wires.0.len(), 1);
    }
}
