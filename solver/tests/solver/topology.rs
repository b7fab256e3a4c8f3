//! Meshes become the springs that a textbook draws.

use std::collections::BTreeSet;

use bevy_math::{Mat3A, Vec3};
use drape_solver::{SourceMesh, SpringKind, Topology, build};
use proptest::prelude::*;

use crate::fixtures::mesh::{Grid, assemble, both, fan, icosphere, scaled_topology, topology, turned_over};

fn pairs(topology: &Topology, kind: SpringKind) -> BTreeSet<(u32, u32)> {
    topology.springs_of(kind).map(|spring| (spring.a.min(spring.b), spring.a.max(spring.b))).collect()
}

/// Springs of a grid by its rows and columns: one and two steps along them, and the diagonals.
fn grid_pairs(columns: u32, rows: u32, kind: SpringKind) -> BTreeSet<(u32, u32)> {
    let steps: &[(i32, i32)] = match kind {
        SpringKind::Structural => &[(1, 0), (0, 1)],
        SpringKind::Shear => &[(1, 1), (-1, 1)],
        SpringKind::Bend => &[(2, 0), (0, 2)],
    };
    let mut pairs = BTreeSet::new();
    for row in 0..rows as i32 {
        for column in 0..columns as i32 {
            for (right, down) in steps {
                let (c, r) = (column + right, row + down);
                if (0..columns as i32).contains(&c) && r < rows as i32 {
                    let vertex = |c: i32, r: i32| r as u32 * columns + c as u32;
                    pairs.insert((vertex(column, row), vertex(c, r)));
                }
            }
        }
    }
    pairs
}

#[test]
fn a_grid_has_twelve_neighbours_inside_and_fewer_at_the_border() {
    for mesh in [Grid::new(1.5, 1.0, 7, 5).into(), one_way_diagonals(7, 5)] {
        let topology = topology(mesh);
        for kind in SpringKind::ALL {
            assert_eq!(pairs(&topology, kind), grid_pairs(7, 5, kind), "{kind:?}");
        }
        let neighbours = |particle: u32| topology.springs.iter().filter(|s| s.a == particle || s.b == particle).count();
        assert_eq!(neighbours(2 * 7 + 3), 12);
        assert_eq!(neighbours(0), 5);
    }
}

/// A grid as a modelling tool exports it: all diagonals one way.
fn one_way_diagonals(columns: u32, rows: u32) -> SourceMesh {
    let SourceMesh { positions, .. } = Grid::new(1.5, 1.0, columns, rows).into();
    let mut triangles = Vec::new();
    for row in 0..rows - 1 {
        for column in 0..columns - 1 {
            let a = row * columns + column;
            let (b, c, d) = (a + 1, a + columns, a + columns + 1);
            triangles.extend([[a, c, b], [b, c, d]]);
        }
    }
    assemble(positions, &triangles)
}

#[test]
fn a_grid_whose_triangles_share_no_vertices_has_the_same_springs() {
    let mesh = SourceMesh::from(Grid::new(1.0, 1.0, 6, 6));
    let corners = mesh.triangles.as_flattened().iter().map(|&vertex| mesh.positions[vertex as usize]).collect();
    let own: Vec<[u32; 3]> = (0..mesh.triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let [indexed, unindexed] = [mesh, assemble(corners, &own)].map(topology);
    assert_eq!(indexed.particle_count(), unindexed.particle_count());
    for kind in SpringKind::ALL {
        // Particles are numbered differently, so springs are compared by where they are.
        let places = |topology: &Topology| {
            let key = |p: Vec3| (p * 1e4).round().as_ivec3().to_array();
            let rest = |i: u32| key(topology.rest[i as usize]);
            pairs(topology, kind).iter().map(|&(a, b)| BTreeSet::from([rest(a), rest(b)])).collect::<BTreeSet<_>>()
        };
        assert_eq!(places(&indexed), places(&unindexed), "{kind:?}");
    }
}

#[test]
fn equilateral_triangles_bend_across_their_edges_and_have_no_cells() {
    let h = 0.75_f32.sqrt();
    let places = [[0.0, 0.0], [1.0, 0.0], [0.5, h], [1.5, h]].map(|[x, y]| Vec3::new(x, y, 0.0));
    let topology = topology(assemble(places.to_vec(), &[[0, 1, 2], [2, 1, 3]]));
    assert_eq!(pairs(&topology, SpringKind::Structural).len(), 5);
    assert_eq!(pairs(&topology, SpringKind::Shear).len(), 0);
    assert_eq!(pairs(&topology, SpringKind::Bend), BTreeSet::from([(0, 3)]));
}

#[test]
fn rest_lengths_and_areas_are_in_world_scale() {
    let scale = Mat3A::from_diagonal(Vec3::new(2.0, -3.0, 1.0));
    let topology = scaled_topology(Grid::new(1.0, 1.0, 5, 5), scale);
    let longest = topology.springs_of(SpringKind::Structural).map(|s| s.rest).fold(0.0, f32::max);
    assert!((longest - 0.75).abs() < 1e-6);
    assert!((topology.areas.iter().sum::<f32>() - 6.0).abs() < 1e-5);
}

#[test]
fn a_sheet_modelled_with_two_sides_is_one_sheet() {
    let front = SourceMesh::from(Grid::new(1.0, 1.0, 4, 4));
    let sides = both(front.clone(), turned_over(front.clone()));
    let [one, two] = [front, sides].map(topology);
    assert_eq!(one, two);
}

#[test]
fn within_a_batch_no_two_springs_share_a_particle() {
    for mesh in [Grid::new(1.0, 1.0, 9, 7).into(), icosphere(1.0, 6), fan(32)] {
        let topology = topology(mesh);
        let mut count = 0;
        for batch in &topology.batches {
            let mut seen = BTreeSet::new();
            for spring in &topology.springs[batch.range.clone()] {
                assert!(seen.insert(spring.a) && seen.insert(spring.b), "{batch:?}");
                count += 1;
            }
        }
        assert_eq!(count, topology.springs.len());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_soup_of_triangles_gives_sound_springs_or_an_error(
        points in prop::collection::vec(prop::array::uniform3(-1.0_f32..1.0), 3..40),
        corners in prop::collection::vec(prop::array::uniform3(0_usize..40), 1..60),
    ) {
        let count = points.len();
        let triangles: Vec<[u32; 3]> = corners.iter().map(|t| t.map(|i| (i % count) as u32)).collect();
        let mesh = assemble(points.into_iter().map(Vec3::from).collect(), &triangles);
        if let Ok((_, topology)) = build(&mesh, Mat3A::IDENTITY) {
            let count = topology.particle_count() as u32;
            prop_assert!(topology.areas.iter().all(|&area| area > 0.0));
            let mut seen = BTreeSet::new();
            for spring in &topology.springs {
                prop_assert!(spring.a < count && spring.b < count && spring.a != spring.b);
                prop_assert!(spring.rest.is_finite());
                prop_assert!(seen.insert((spring.a.min(spring.b), spring.a.max(spring.b))), "joined twice");
            }
        }
    }
}
