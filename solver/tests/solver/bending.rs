//! Sheets bend as a plate of their rigidity does.

use bevy_math::{Vec3, Vec3A, ops};
use drape_solver::{Bend, Material, Method, measure::energy};

use crate::{
    bench_bed::{self, Bed, GRAVITY},
    fixtures::{
        material::{Fabric, bare},
        mesh::{Grid, shaped},
    },
};

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

/// The same of a cloth: a strip of `cells` cells along, clamped from the middle of one more.
///
/// Bends are in the nodes, each for half a cell to either side: of two clamped nodes, the second still gives for both of
/// its halves.
fn measured(fabric: Fabric, length: f32, cells: u32, method: Method, substeps: u32) -> f32 {
    let cell = length / (cells as f32 + 0.5);
    let grid = Grid::new(4.0 * cell, cell * (cells + 1) as f32, 5, cells + 2);
    let material = Material { damping: 12.0, ..bare(fabric) };
    let bed = Bed::new(grid.lying(), material).pinned(0..10);
    let mut bed = Bed { method, fluid_density: 0.0, ..bed }.with_substeps(substeps);
    bed.run(4.0);
    assert!(bed.fastest() < 5e-3, "it still moves");
    let last = bed.particles.len() - 1;
    -bed.particles.position[last].y / length
}

#[test]
fn a_strip_hangs_over_an_edge_as_the_elastica_does() {
    for fabric in [Fabric::COTTON_WOVEN, Fabric::LEATHER, Fabric::SILK] {
        let natural = (fabric.bending_rigidity / (fabric.density * GRAVITY)).cbrt();
        for overhang in [1.5, 2.5] {
            let expected = droop(1.0 / f64::from(overhang)) as f32;
            for (cells, substeps) in [(10, 8), (10, 32), (20, 2), (20, 8), (20, 32), (40, 8)] {
                let drop = measured(fabric.clone(), overhang * natural, cells, Method::Strands, substeps);
                println!("{overhang} {cells} {substeps}: {}", drop / expected - 1.0);
                assert!((drop / expected - 1.0).abs() < 0.035, "{drop} for {expected}");
            }
        }
    }
}

#[test]
fn other_methods_bend_as_strands_do() {
    let fabric = Fabric::COTTON_WOVEN;
    let natural = (fabric.bending_rigidity / (fabric.density * GRAVITY)).cbrt();
    let expected = droop(1.0 / 2.0) as f32;
    for method in [Method::Xpbd, Method::Explicit] {
        let drop = measured(Fabric { warp_stiffness: 400.0, ..fabric.clone() }, 2.0 * natural, 10, method, 16);
        println!("{method:?}: {}", drop / expected - 1.0);
        assert!((drop / expected - 1.0).abs() < 0.03, "{method:?}: {drop} for {expected}");
    }
}

#[test]
fn a_plate_bends_as_easily_in_any_direction() {
    let fabric = Fabric { bending_rigidity: 1e-3, ..Fabric::default() };
    let grid = Grid::new(0.4, 0.4, 41, 41).lying();
    let flat = Bed::new(grid, bare(fabric));
    for degrees in [0.0_f32, 20.0, 45.0, 90.0] {
        let (curvature, direction) = (0.1, Vec3A::X.rotate_y(degrees.to_radians()));
        let mut bent = flat.particles.clone();
        for place in &mut bent.position {
            place.y = 0.5 * curvature * place.dot(direction).powi(2);
        }
        let area = flat.topology.triangle_areas.iter().sum::<f32>();
        let expected = 0.5 * 1e-3 * curvature * curvature * area;
        let bends = &flat.topology.bends;
        let sum = |bend: &Bend| {
            let sum =
                bend.particles.iter().zip(bend.weights).map(|(&i, w)| bent.position[i as usize] * w).sum::<Vec3A>();
            0.5 * 1e-3 * sum.length_squared()
        };
        let energy: f32 = bends.iter().map(sum).sum();
        // Nothing bends at the border.
        assert!((energy / expected - 1.0).abs() < 0.06, "{degrees} degrees: {}", energy / expected);
    }
}

#[test]
fn what_is_curved_at_rest_keeps_its_form() {
    let roll =
        |radius: f32| move |p: Vec3| Vec3::new(radius * ops::sin(p.x / radius), p.y, radius * ops::cos(p.x / radius));
    let fabric = Fabric { bending_rigidity: 1e-3, ..Fabric::default() };
    for mesh in [
        shaped(Grid::new(0.4, 0.2, 37, 19), roll(0.15)),
        shaped(Grid::new(0.4, 0.2, 37, 19), |p| roll(0.15)(Vec3::new(p.y, p.x, 0.0))),
        // A tube: its last column is its first.
        shaped(Grid::new(core::f32::consts::TAU * 0.1, 0.2, 33, 17), roll(0.1)),
        // Pleats.
        shaped(Grid::new(0.4, 0.2, 65, 17), |p| Vec3::new(p.x, p.y, 0.01 * ops::sin(p.x * 60.0))),
    ] {
        let bed = Bed::new(mesh.clone(), bare(fabric.clone()));
        assert!(bed.topology.lattice.as_ref().is_some_and(|lattice| lattice.curl.is_some()));
        let mut still = Bed { gravity: Vec3A::ZERO, fluid_density: 0.0, ..bed.clone() };
        still.run(1.0);
        let moved = bench_bed::rms(&still.particles, &bed.particles);
        assert!(moved < 5e-5, "it moved by {moved} m without a force");
        // Pressed, it comes back.
        let mut pressed = Bed { gravity: Vec3A::ZERO, fluid_density: 0.0, ..bed.clone() };
        pressed.material.damping = 2.0;
        for place in &mut pressed.particles.position {
            place.z *= 0.9;
        }
        let elastic = |bed: &Bed| energy(&bed.particles, &bed.topology, &bed.material, Vec3A::ZERO).elastic;
        let at_first = elastic(&pressed);
        pressed.run(3.0);
        let left = elastic(&pressed) / at_first;
        println!("{left}");
        assert!(left < 1e-3, "it keeps {left} of what it was pressed with");
    }
}
