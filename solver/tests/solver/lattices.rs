//! Meshes whose particles are in rows and columns are seen to be, and no others.

use std::collections::BTreeSet;

use bevy_math::{Mat3A, Vec3, ops};
use drape_solver::{SourceMesh, SpringKind, Topology, build};
use fastrand::Rng;

use crate::fixtures::mesh::{Grid, assemble, both, fan, icosphere, shaped, topology, triangle};

/// Rows and columns of the lattice, if there is one, the fewer first.
fn sides(topology: &Topology) -> Option<[usize; 2]> {
    let lattice = topology.lattice.as_ref()?;
    Some([lattice.rows.min(lattice.columns), lattice.rows.max(lattice.columns)])
}

/// Particles and rest length of every spring that the lattice has.
fn lattice_springs(topology: &Topology) -> BTreeSet<(u32, u32, u32)> {
    let lattice = topology.lattice.as_ref().expect("a lattice");
    let (rows, columns) = (lattice.rows, lattice.columns);
    let mut springs = BTreeSet::new();
    let mut add = |from: (usize, usize), to: (usize, usize), rest: f32| {
        if rest > 0.0 {
            assert!(from.0 < rows && from.1 < columns && to.0 < rows && to.1 < columns, "{from:?} to {to:?}");
            let [a, b] = [from, to].map(|(row, column)| (row * columns + column) as u32);
            assert!(springs.insert((a.min(b), a.max(b), rest.to_bits())), "twice from {from:?} to {to:?}");
        }
    };
    // Eight threads side by side, node after node.
    let along_rows = lattice.along_rows.nodes;
    for (steps, lengths) in [(1, &lattice.along_rows.stretch), (2, &lattice.along_rows.bend)] {
        for (i, lanes) in lengths.iter().enumerate() {
            for (l, &rest) in lanes.iter().enumerate() {
                let from = (i / along_rows * 8 + l, i % along_rows);
                let is_last_of_ring = lattice.along_rows.closed && steps == 1 && from.1 + 1 == columns;
                add(from, (from.0, if is_last_of_ring { 0 } else { from.1 + steps }), rest);
            }
        }
    }
    for (steps, lengths) in [(1, &lattice.along_columns.stretch), (2, &lattice.along_columns.bend)] {
        for (i, lanes) in lengths.iter().enumerate() {
            for (l, &rest) in lanes.iter().enumerate() {
                let from = (i % rows, i / rows * 8 + l);
                add(from, (from.0 + steps, from.1), rest);
            }
        }
    }
    for (is_falling, lengths) in [(true, &lattice.falling), (false, &lattice.rising)] {
        for (i, lanes) in lengths.iter().enumerate() {
            for (l, &rest) in lanes.iter().enumerate() {
                let (row, column) = (i % rows, i / rows * 8 + l);
                let (from, to) = if is_falling { (column, column + 1) } else { (column + 1, column) };
                add((row, from), (row + 1, to), rest);
            }
        }
    }
    springs
}

/// The lattice and the batches that aren't on_lattice have every spring once.
#[track_caller]
fn assert_shared_out(topology: &Topology) {
    let on_lattice = topology.batches.iter().filter(|batch| batch.on_strand);
    let on_lattice: BTreeSet<(u32, u32, u32)> = on_lattice
        .flat_map(|batch| &topology.springs[batch.range.clone()])
        .map(|spring| (spring.a.min(spring.b), spring.a.max(spring.b), spring.rest.to_bits()))
        .collect();
    assert_eq!(lattice_springs(topology), on_lattice);
}

#[test]
fn a_grid_of_any_size_is_a_lattice_with_all_its_springs() {
    for (columns, rows) in [(2, 2), (3, 50), (50, 3), (33, 20), (2, 9), (9, 2), (8, 8), (7, 17), (64, 5)] {
        let grid = Grid::new(1.5, 1.0, columns, rows);
        for grid in [grid, grid.lying()] {
            let topology = topology(grid);
            let lattice = topology.lattice.as_ref().unwrap_or_else(|| panic!("{columns} x {rows}"));
            assert_eq!((lattice.rows, lattice.columns), (rows as usize, columns as usize));
            assert_eq!(lattice_springs(&topology).len(), topology.springs.len());
            assert_shared_out(&topology);
        }
    }
}

/// The cells of a grid of a square metre, each cut along one of its diagonals.
fn cut_at_random(columns: u32, rows: u32, rng: &mut Rng) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let place = |i: u32| {
        let (row, column) = (i / columns, i % columns);
        Vec3::new(column as f32 / (columns - 1) as f32, 0.0, row as f32 / (rows - 1) as f32)
    };
    let cells = (0..rows - 1).flat_map(|row| (0..columns - 1).map(move |column| row * columns + column));
    let triangles = cells.flat_map(|a| {
        let (b, c, d) = (a + 1, a + columns, a + columns + 1);
        if rng.bool() { [[a, c, b], [b, c, d]] } else { [[a, c, d], [a, d, b]] }
    });
    let triangles = triangles.collect();
    ((0..columns * rows).map(place).collect(), triangles)
}

#[test]
fn quads_that_are_cut_along_any_diagonal_are_a_lattice() {
    for seed in 0..20 {
        let mut rng = Rng::with_seed(seed);
        let (columns, rows) = (rng.u32(2..24), rng.u32(2..24));
        let (positions, mut triangles) = cut_at_random(columns, rows, &mut rng);
        rng.shuffle(&mut triangles);
        let topology = topology(assemble(positions, &triangles));
        let lattice = topology.lattice.as_ref().unwrap_or_else(|| panic!("{columns} x {rows}, seed {seed}"));
        assert_eq!((lattice.rows, lattice.columns), (rows as usize, columns as usize));
        assert_shared_out(&topology);
    }
}

#[test]
fn a_grid_in_any_order_of_vertices_is_a_lattice() {
    for seed in 0..20 {
        let mut rng = Rng::with_seed(seed);
        let (columns, rows) = (rng.u32(2..24), rng.u32(2..24));
        let (positions, mut triangles) = cut_at_random(columns, rows, &mut rng);
        let mut order: Vec<u32> = (0..columns * rows).collect();
        rng.shuffle(&mut order);
        rng.shuffle(&mut triangles);
        let mut shuffled = vec![Vec3::ZERO; positions.len()];
        for (&to, position) in order.iter().zip(positions) {
            shuffled[to as usize] = position;
        }
        for triangle in &mut triangles {
            *triangle = triangle.map(|i| order[i as usize]);
            triangle.rotate_left(rng.usize(0..3));
        }
        let mesh = assemble(shuffled.clone(), &triangles);
        let (welded, topology) = build(&mesh, Mat3A::IDENTITY).expect("a mesh with an area");
        let expected = [rows.min(columns) as usize, rows.max(columns) as usize];
        assert_eq!(sides(&topology), Some(expected), "{columns} x {rows}, seed {seed}");
        assert_shared_out(&topology);
        for (particle, place) in welded.particle_of_vertex.into_iter().zip(shuffled) {
            assert_eq!(topology.rest[particle as usize], place);
        }
    }
}

/// A place on an open tube of so many particles around, or on a ring on the ground.
fn round(i: u32, around: u32, is_flat: bool) -> Vec3 {
    let (ring, column) = (i / around, i % around);
    let angle = core::f32::consts::TAU * column as f32 / around as f32;
    let (sin, cos) = (ops::sin(angle), ops::cos(angle));
    let out = if is_flat { 1.0 + 0.1 * ring as f32 } else { 0.3 };
    Vec3::new(out * cos, if is_flat { 0.0 } else { -0.05 * ring as f32 }, out * sin)
}

fn tube(around: u32, rings: u32, is_flat: bool) -> SourceMesh {
    let cells = (0..rings - 1).flat_map(|ring| (0..around).map(move |column| (ring, column)));
    let triangles: Vec<[u32; 3]> = cells
        .flat_map(|(ring, column)| {
            let (a, b) = (ring * around + column, ring * around + (column + 1) % around);
            [[a, b, a + around], [b, b + around, a + around]]
        })
        .collect();
    assemble((0..around * rings).map(|i| round(i, around, is_flat)).collect(), &triangles)
}

#[test]
fn an_open_tube_is_a_lattice_of_rings() {
    for (around, rings) in [(12, 9), (40, 5), (12, 30), (16, 2)] {
        for is_flat in [false, true] {
            let topology = topology(tube(around, rings, is_flat));
            let expected = [around.min(rings) as usize, around.max(rings) as usize];
            assert_eq!(sides(&topology), Some(expected), "{around} x {rings}");
            assert!(topology.lattice.as_ref().is_some_and(|lattice| lattice.along_rows.closed), "{around} x {rings}");
            assert_shared_out(&topology);
            let loose = |kind| topology.batches.iter().filter(move |batch| batch.kind == kind && !batch.on_strand);
            let count = |kind| loose(kind).map(|batch| batch.range.len()).sum::<usize>() as u32;
            assert_eq!(count(SpringKind::Structural), 0, "rings are closed");
            assert_eq!(count(SpringKind::Shear), 2 * (rings - 1), "two diagonals of each cell at the seam");
            assert_eq!(count(SpringKind::Bend), 2 * rings, "two across the seam of each ring");
        }
    }
}

/// Equilateral triangles with a side of 1 m in `n` rows of `n` particles, lying.
pub fn hexagons(n: u32) -> SourceMesh {
    let place = |i: u32| {
        let (row, column) = ((i / n) as f32, (i % n) as f32);
        Vec3::new(column + 0.5 * (row % 2.0), 0.0, row * 0.75_f32.sqrt())
    };
    let cells = (0..n - 1).flat_map(|row| (0..n - 1).map(move |column| (row, row * n + column)));
    let triangles: Vec<[u32; 3]> = cells
        .flat_map(|(row, a)| {
            let (b, c, d) = (a + 1, a + n, a + n + 1);
            if row % 2 == 0 { [[a, c, b], [b, c, d]] } else { [[a, c, d], [a, d, b]] }
        })
        .collect();
    assemble((0..n * n).map(place).collect(), &triangles)
}

/// A square metre of so many points a side, moved at random inside, joined by Delaunay's triangulation. The first two
/// are corners.
pub fn strewn(side: u32) -> SourceMesh {
    let mut rng = Rng::with_seed(3);
    let cell = 1.0 / (side - 1) as f32;
    let mut points: Vec<Vec3> = vec![Vec3::ZERO, Vec3::X];
    for (x, z) in
        (0..side).flat_map(|z| (0..side).map(move |x| (x, z))).filter(|&(x, z)| z > 0 || x > 0 && x < side - 1)
    {
        let moved = |along: u32, rng: &mut Rng| {
            let is_inside = along > 0 && along < side - 1;
            (along as f32 + if is_inside { rng.f32() - 0.5 } else { 0.0 }) * cell
        };
        points.push(Vec3::new(moved(x, &mut rng), 0.0, moved(z, &mut rng)));
    }
    let corners: Vec<_> = points.iter().map(|p| delaunator::Point { x: p.x.into(), y: p.z.into() }).collect();
    let triangles: Vec<[u32; 3]> =
        delaunator::triangulate(&corners).triangles.as_chunks().0.iter().map(|t| t.map(|i| i as u32)).collect();
    assemble(points, &triangles)
}

#[test]
fn a_mesh_without_rows_and_columns_is_no_lattice() {
    let mut holed = cut_at_random(9, 9, &mut Rng::with_seed(1));
    holed.1.drain(60..62);
    let sheet = Grid::new(1.0, 1.0, 4, 4);
    let meshes = [
        ("equilateral", hexagons(8)),
        ("Delaunay's", strewn(14)),
        ("a ball", icosphere(1.0, 6)),
        ("a disc", fan(32)),
        ("with a hole", assemble(holed.0, &holed.1)),
        ("in two pieces", both(sheet, shaped(sheet, |p| p + Vec3::X * 5.0))),
        ("one triangle", triangle()),
    ];
    for (name, mesh) in meshes {
        let topology = topology(mesh);
        assert_eq!(sides(&topology), None, "{name}");
    }
}
