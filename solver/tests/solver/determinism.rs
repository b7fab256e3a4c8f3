//! The same input gives the same bits.

use std::sync::Arc;

use bevy_math::{Isometry3d, Vec3, Vec3A, primitives::Sphere};
use bevy_tasks::{TaskPool, TaskPoolBuilder};
use drape_solver::{Method, Obstacle, Solid};

use crate::{
    bench_bed::{ALL, Bed, bits},
    fixtures::{
        hand::{Grip, hand},
        material::{Fabric, Springs, bare, springs_in_air},
        mesh::{Grid, icosphere},
    },
};

fn scene(method: Method) -> Bed {
    let bed = Bed::lying(18, springs_in_air(Springs::default())).pinned([0, 17]).tethered(&[0, 17]).with_levels();
    let mut bed = Bed { method, ..bed };
    let pose = Isometry3d::from_translation(Vec3::new(0.0, -0.5, -0.3));
    bed.obstacles = vec![Obstacle::still(Solid::Sphere(Sphere::new(0.2)), pose)];
    bed.particles.force[200] = Vec3A::new(0.01, 0.02, 0.0);
    assert!(!bed.topology.levels.is_empty());
    bed
}

#[test]
fn two_runs_give_the_same_bits() {
    for method in ALL {
        let (mut a, mut b) = (scene(method), scene(method));
        a.run(1.0);
        b.run(1.0);
        assert_eq!(bits(&a.particles), bits(&b.particles), "{method:?}");
    }
}

#[test]
fn scratch_carries_nothing_from_one_cloth_to_another() {
    for method in ALL {
        // Larger with more levels, smaller without any, and without rows and columns.
        let material = springs_in_air(Springs { structural_damping: 0.01, ..Springs::default() });
        let others = [
            Bed::lying(40, material).pinned([5]).tethered(&[5]).with_levels(),
            Bed::new(Grid::new(1.0, 1.0, 3, 5), material).pinned([0, 2]),
            Bed::new(icosphere(0.3, 6), material),
        ];
        for other in others {
            let (mut a, mut b) = (scene(method), scene(method));
            a.run(0.2);
            let mut other = Bed { method, ..other };
            other.run(0.2);
            core::mem::swap(&mut b.scratch, &mut other.scratch);
            b.run(0.2);
            assert_eq!(bits(&a.particles), bits(&b.particles), "{method:?} after {}", other.particles.len());
        }
    }
}

/// A cloth that is large enough for several threads to share it, of a size that is no multiple of anything.
fn large(pins: impl Fn(Grid) -> Vec<u32>) -> Bed {
    let grid = Grid::new(1.0, 1.2, 101, 133).lying();
    let constants = Springs { shear_damping: 0.001, bend_damping: 0.001, ..Springs::default() };
    let pins = pins(grid);
    Bed::new(grid, springs_in_air(constants)).pinned(pins.clone()).tethered(&pins[..2]).with_substeps(4).with_levels()
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let two_corners = large(|grid| vec![grid.particle(0, 0), grid.particle(100, 0)]);
    let an_edge = large(|grid| (0..101).map(|column| grid.particle(column, 0)).collect());
    let mut pushed = two_corners.clone();
    pushed.fluid_density = 0.0;
    let in_a_vacuum = pushed.clone();
    pushed.particles.force[7000] = Vec3A::new(0.0, 0.02, 0.01);
    let mut held = an_edge.clone();
    held.grabs = vec![hand(&held, 9000, [0.2, 0.3, 0.5], Grip::default())];
    // A sheet has diagonals along the bias and bends, which go from band to band as well.
    let mut sheet = two_corners.clone();
    sheet.material = bare(Fabric { stretch_damping: 0.001, bend_damping: 0.01, ..Fabric::DENIM });
    let mut touched = two_corners.clone();
    touched.obstacles = scene(Method::Strands).obstacles;
    for (name, bed) in [
        ("two corners", two_corners),
        ("an edge", an_edge),
        ("a vacuum", in_a_vacuum),
        ("a push", pushed),
        ("a hand", held),
        ("an obstacle", touched),
        ("a sheet", sheet),
    ] {
        let run = |pool: Option<TaskPool>| {
            let mut bed = Bed { pool: pool.map(Arc::new), ..bed.clone() };
            bed.run(0.15);
            bits(&bed.particles)
        };
        let alone = run(None);
        for threads in [1, 3] {
            let shared = run(Some(TaskPoolBuilder::new().num_threads(threads).build()));
            assert!(alone == shared, "{name}, {threads} threads that help");
        }
    }
}
