//! Sheets bend as a plate of their rigidity does.

use bevy::{math::Vec3A, prelude::*};
use bevy_drape::{
    prelude::{ClothGrid, Fabric},
    solver::Method,
};

use crate::bench_bed::{Bed, GRAVITY, bare};

/// How far the end of a strip hangs below the edge that it sticks out of, over its length, if (B / (ρ g))^(1/3) is `length`
/// of it.
///
/// The heavy elastica: with the slope θ below the horizontal at s along a strip of length 1, θ'' = -(1 - s) cos θ / length³,
/// clamped at s = 0, θ'(1) = 0. Solved by shooting.
fn droop(length: f64) -> f64 {
    const STEPS: usize = 2000;
    let end = |curvature: f64| {
        let (mut theta, mut kappa, mut drop) = (0.0, curvature, 0.0);
        let h = 1.0 / STEPS as f64;
        for i in 0..STEPS {
            let s = (i as f64 + 0.5) * h;
            let middle = theta + 0.5 * h * kappa;
            kappa -= h * (1.0 - s) * f64::cos(middle) / length.powi(3);
            let after = middle + 0.5 * h * kappa;
            drop += h * f64::sin(middle);
            theta = after;
        }
        (kappa, drop)
    };
    let (mut low, mut high) = (0.0, 1.0 / length.powi(3));
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if end(middle).0 > 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    end(low).1
}

/// The same of a cloth: a strip of `cells` cells along, which are as long as wide, lies still on an edge.
fn measured(fabric: Fabric, length: f32, cells: u32, across: u32, substeps: u32, method: Method) -> f32 {
    let cell = length / cells as f32;
    // Two more rows of particles, which are clamped.
    let grid = ClothGrid::new(cell * across as f32, cell * (cells + 1) as f32, across + 1, cells + 2);
    let material = bevy_drape::solver::Material { damping: 12.0, ..bare(fabric) };
    let bed = Bed::new(grid.lying(), material).pinned(0..2 * (across + 1));
    let mut bed = Bed { method, fluid_density: 0.0, ..bed }.with_substeps(substeps);
    bed.run(4.0);
    let last = bed.particles.len() - 1;
    let drop = -bed.particles.position[last].y / length;
    println!("{cells} cells, {substeps} substeps {method:?}: {drop}, {} m/s", bed.fastest());
    drop
}

#[test]
fn a_strip_hangs_over_an_edge_as_the_elastica_does() {
    for fabric in [Fabric::COTTON_WOVEN, Fabric::LEATHER, Fabric::SILK] {
        let natural = (fabric.bending_rigidity / (fabric.density * GRAVITY)).cbrt();
        for overhang in [1.5, 2.5] {
            let expected = droop(1.0 / f64::from(overhang)) as f32;
            println!("{overhang}: {expected}");
            for (cells, substeps) in [(10, 8), (10, 32), (20, 2), (20, 8), (20, 32), (40, 8)] {
                let drop = measured(fabric.clone(), overhang * natural, cells, 4, substeps, Method::Strands);
                println!("   error {}", drop / expected - 1.0);
            }
        }
    }
}
