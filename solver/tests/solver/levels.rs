//! Coarse lattices over a cloth: they span it, carry pulls across it, and change nothing else.

use bevy_math::{Quat, Vec3, Vec3A};
use drape_solver::{LevelPass, Method, SourceMesh, SubstepPolicy, measure, topology::level::TransferOperator};

use crate::{
    bench_bed::Bed,
    fixtures::{
        material::{Springs, springs, springs_in_air},
        mesh::{Grid, topology},
    },
    lattices::strewn,
};

#[test]
fn levels_span_the_cloth_from_border_to_border() {
    for (columns, rows) in [(32, 32), (33, 20), (100, 9), (3, 50), (16, 16), (128, 128)] {
        let topology = topology(Grid::new(1.0, 1.0, columns, rows));
        let (width, height) = (columns as f32 - 1.0, rows as f32 - 1.0);
        assert!(!topology.levels.is_empty(), "{columns} x {rows}");
        assert!(topology.levels.is_sorted_by(|coarse, fine| coarse.stride == 2 * fine.stride));
        assert_eq!(topology.levels.last().map(|level| level.stride), Some(4));
        for level in &topology.levels {
            assert_eq!((level.rows[0], level.rows.last()), (0.0, Some(&height)));
            assert_eq!((level.columns[0], level.columns.last()), (0.0, Some(&width)));
            assert!(level.rows.is_sorted_by(|a, b| a < b) && level.columns.is_sorted_by(|a, b| a < b));
            // All threads are as long as the cloth.
            let lattice = &level.lattice;
            let (last_row, last_column) = (lattice.rows - 1, lattice.columns - 1);
            assert!((lattice.length_along_row(last_row, 0..last_column) - 1.0).abs() < 1e-5);
            assert!((lattice.length_along_column(last_column, 0..last_row) - 1.0).abs() < 1e-5);
        }
    }
    assert!(topology(Grid::new(1.0, 1.0, 15, 15)).levels.is_empty());
}

#[test]
fn levels_of_an_irregular_mesh_move_particles_between_their_nodes() {
    let topology = topology(strewn(40));
    assert!(topology.lattice.is_none() && topology.levels.len() > 1);
    for level in &topology.levels {
        let TransferOperator::Chart { nodes, particles } = &level.transfer else { panic!("{:?}", level.transfer) };
        for (corners, weights) in nodes.iter().filter(|(_, weights)| *weights != [0.0; 3]) {
            assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-5 && weights.iter().all(|&weight| weight >= 0.0));
            assert!(corners.iter().all(|&corner| (corner as usize) < topology.particle_count()));
        }
        assert_eq!(particles.len(), topology.particle_count());
        // What moves nodes evenly moves the particles just so: each is between its nodes.
        let place = |slot: u32| -> Vec3 {
            let (corners, weights) = nodes[slot as usize];
            corners.iter().zip(weights).map(|(&corner, weight)| topology.rest[corner as usize] * weight).sum()
        };
        for ((around, shares), rest) in particles.iter().zip(&topology.rest) {
            let between: Vec3 = around.iter().zip(shares).map(|(&slot, &share)| place(slot) * share).sum();
            assert!((shares.iter().sum::<f32>() - 1.0).abs() < 1e-5);
            assert!(between.distance(*rest) < 1e-4, "{rest} is moved as {between}");
        }
    }
}

/// A square metre that hangs by two corners, with all that a game gives it but air.
fn hung(mesh: SourceMesh) -> Bed {
    let mut bed = Bed::new(mesh, springs_in_air(Springs::default()));
    let corners = [Vec3::new(-0.5, 0.0, -0.5), Vec3::new(0.5, 0.0, -0.5), Vec3::ZERO, Vec3::X];
    let pins: Vec<u32> = (0..).zip(&bed.topology.rest).filter(|(_, p)| corners.contains(p)).map(|(i, _)| i).collect();
    assert_eq!(pins.len(), 2);
    bed.fluid_density = 0.0;
    bed.pinned(pins.iter().copied()).tethered(&pins)
}

fn grid(n: u32) -> SourceMesh {
    Grid::new(1.0, 1.0, n, n).lying().into()
}

fn largest_strain(bed: &Bed) -> f32 {
    measure::strain(&bed.particles, &bed.topology).largest
}

/// The same after three seconds in single steps.
fn swung(mut bed: Bed) -> Bed {
    bed.substep_policy = SubstepPolicy::fixed(1, bed.substep_policy.levels);
    bed.run(3.0);
    bed
}

#[test]
fn levels_leave_less_strain_in_one_substep() {
    for (name, mesh) in [("32 x 32", grid(32)), ("64 x 64", grid(64)), ("irregular", strewn(40))] {
        let bed = hung(mesh);
        let strains = [bed.clone(), bed.with_levels()].map(|bed| largest_strain(&swung(bed)));
        println!("{name}: {strains:?}");
        assert!(strains[1] < 0.5 * strains[0], "{name}: {strains:?}");
    }
}

#[test]
fn a_large_hung_cloth_with_levels_comes_nearly_to_rest() {
    let mut bed = hung(grid(128)).like_a_game(Method::Strands);
    assert!(!bed.substep_policy.levels.is_empty());
    bed.material.damping = 1.0;
    bed.run(15.0);
    let frames: u16 = 30;
    let squares = (0..frames).map(|_| {
        let before = bed.particles.position.clone();
        bed.step(1.0 / 60.0);
        let ways = bed.particles.position.iter().zip(&before).map(|(p, q)| p.distance_squared(*q));
        ways.sum::<f32>() / before.len() as f32
    });
    let speed = 60.0 * (squares.sum::<f32>() / f32::from(frames)).sqrt();
    println!("{speed} m/s, root mean square");
    // Some 10 mm/s if nothing damps the nodes.
    assert!(speed < 0.003, "it moves at {speed} m/s");
}

#[test]
fn without_tethers_there_are_no_levels() {
    let loose = |bed: Bed| swung(Bed { tethers: None, ..bed });
    assert_eq!(loose(hung(grid(20))).particles, loose(hung(grid(20)).with_levels()).particles);
}

#[test]
fn levels_leave_a_cloth_alone_that_is_nowhere_too_long() {
    // Pressed together by a tenth, and turned: coarse threads are slack, and what is between them isn't stretched.
    let turn = Quat::from_rotation_z(0.3);
    let pressed = |bed: Bed| {
        let mut bed = Bed { gravity: Vec3A::ZERO, ..bed };
        bed.substep_policy = SubstepPolicy::fixed(1, bed.substep_policy.levels);
        bed.material = springs(Springs::default());
        bed.particles.position.iter_mut().for_each(|p| *p = turn * *p * 0.9);
        for anchor in &mut bed.pin_motions {
            anchor.start = bed.particles.position[anchor.particle as usize];
            anchor.end = anchor.start;
        }
        bed.step(1.0 / 60.0);
        bed
    };
    let (without, with) = (pressed(hung(grid(32))), pressed(hung(grid(32)).with_levels()));
    assert!(!with.substep_policy.levels.is_empty() && with.fastest() > 0.1);
    assert_eq!(without.particles, with.particles);
}

#[test]
fn the_substeps_to_hold_a_strain_leave_a_soft_cloth_without_tethers_the_stretch_of_its_weight() {
    // Hung by its whole upper edge: nothing but the weight below stretches it.
    let sunk = |bed: Bed| {
        let mut bed = bed.pinned(0..32);
        bed.material.damping = 3.0;
        bed.run(6.0);
        -0.5 - bed.particles.position.iter().map(|p| p.y).fold(f32::MAX, f32::min)
    };
    let mut failures = Vec::new();
    for stiffness in [50.0, 500.0] {
        let constants = Springs {
            structural_stiffness: stiffness,
            shear_stiffness: stiffness / 10.0,
            bend_stiffness: 1.0,
            ..Springs::default()
        };
        let bed = Bed::new(Grid::new(1.0, 1.0, 32, 32), springs(constants));
        let expected = sunk(Bed { method: Method::Explicit, ..bed.clone() });
        for max_strain in [0.005, 0.001] {
            let substep_policy = SubstepPolicy::to_hold(max_strain, &bed.topology, bed.material.moduli());
            let (substeps, levels) = (substep_policy.substeps, substep_policy.levels.len());
            let depth = sunk(Bed { substep_policy, ..bed.clone() });
            let case = format!("{stiffness} N/m, {substeps} substeps, {levels} levels: {depth} for {expected} m");
            println!("{case}");
            failures.extend(((depth / expected - 1.0).abs() > 0.1).then_some(case));
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn a_level_that_the_cloth_has_not_or_of_no_iterations_changes_nothing() {
    let after = |levels: Vec<LevelPass>| {
        let mut bed = hung(grid(20));
        bed.substep_policy = SubstepPolicy::fixed(2, levels);
        bed.run(0.5);
        bed.particles
    };
    let pass = |stride, iterations| LevelPass { stride, iterations };
    let without = after(Vec::new());
    for levels in [vec![pass(4, 0)], vec![pass(5, 8), pass(0, 8), pass(u32::MAX, 8)]] {
        assert_eq!(after(levels.clone()), without, "{levels:?}");
    }
    assert_ne!(after(vec![pass(4, 1)]), without);
    assert_eq!(after(vec![pass(4, 2), pass(4, 5)]), after(vec![pass(4, 2)]), "the first of a stride counts");
}
