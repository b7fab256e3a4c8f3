//! The default solver: threads as a whole, and no more substeps than is needed.

use bevy_math::{Isometry3d, Vec3, Vec3A, primitives::InfinitePlane3d};
use drape_solver::{Method, Obstacle, Solid, SpringKind, SubstepPolicy, measure};

use crate::{
    bench_bed::{ALL, Bed, GRAVITY, STABLE},
    fixtures::{
        material::{Springs, springs, springs_in_air},
        mesh::Grid,
    },
};

const FRAME: f32 = 1.0 / 60.0;

/// Springs of which only one kind is stiff, in N/m.
fn only(kind: SpringKind, stiffness: f32) -> Springs {
    let of = |other| if other == kind { stiffness } else { 0.0 };
    Springs {
        structural_stiffness: of(SpringKind::Structural),
        shear_stiffness: of(SpringKind::Shear),
        bend_stiffness: of(SpringKind::Bend),
        ..Springs::default()
    }
}

/// Two threads side by side that hang from their first particles, along the columns or along the rows of a grid, and
/// the particles of each from the top down.
fn threads(count: u32, are_columns: bool, constants: Springs) -> (Bed, [Vec<u32>; 2]) {
    let (columns, rows) = if are_columns { (2, count) } else { (count, 2) };
    let (width, height) = if are_columns { (0.05, 1.0) } else { (1.0, 0.05) };
    let grid = Grid::new(width, height, columns, rows);
    let threads = [0, 1].map(|side| -> Vec<u32> {
        (0..count).map(|i| if are_columns { grid.particle(side, i) } else { grid.particle(i, side) }).collect()
    });
    let mut bed = Bed::new(grid, springs(constants)).pinned(threads.iter().map(|thread| thread[0]));
    bed.gravity = GRAVITY * if are_columns { Vec3A::NEG_Y } else { Vec3A::X };
    bed.material.damping = 6.0;
    (bed, threads)
}

/// The largest error of a spring's stretch, as a share of what Hooke's law says, and above what rounding explains.
fn error_of_hooke(bed: &Bed, threads: &[Vec<u32>; 2], stiffness: f32) -> f32 {
    let mut largest = 0.0_f32;
    for thread in threads {
        let mut weight = 0.0;
        for ends in thread.windows(2).rev() {
            let [above, below] = [ends[0], ends[1]].map(|i| i as usize);
            weight += GRAVITY / bed.particles.inverse_mass[below];
            let length = bed.particles.position[above].distance(bed.particles.position[below]);
            let stretch = length - bed.topology.rest[above].distance(bed.topology.rest[below]);
            let expected = weight / stiffness;
            largest = largest.max(((stretch - expected).abs() - 1e-6) / expected);
        }
    }
    largest
}

#[test]
fn each_spring_of_a_hanging_thread_is_stretched_by_the_weight_below() {
    let mut failures = Vec::new();
    // As soft as that, springs give by much of their length within a substep where those are few. The longest goes through
    // several bands of rows.
    for (count, stiffness) in [(10, 20.0), (40, 20.0), (150, 300.0)] {
        let few = if count > 64 { 24 } else { 8 };
        for (are_columns, substeps) in [(true, few), (false, few), (true, 24)] {
            let (bed, threads) = threads(count, are_columns, only(SpringKind::Structural, stiffness));
            let mut bed = bed.with_substeps(substeps);
            bed.run(8.0);
            let error = error_of_hooke(&bed, &threads, stiffness);
            let case = format!("{count} particles, columns {are_columns}, {substeps} substeps: off by {error}");
            println!("{case}, {} m/s", bed.fastest());
            failures.extend((error > 0.003).then_some(case));
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn a_weight_on_a_spring_of_any_kind_stretches_it_by_hookes_law() {
    const STIFFNESS: f32 = 20.0;
    for (method, kind) in ALL.into_iter().flat_map(|method| SpringKind::ALL.map(|kind| (method, kind))) {
        // All but the last of three rows are fixed: each of its particles hangs on what is above it.
        let columns = 9;
        let grid = Grid::new(0.8, 0.2, columns, 3);
        let bed = Bed::new(grid, springs(only(kind, STIFFNESS))).pinned(0..2 * columns).with_substeps(8);
        let mut bed = Bed { method, ..bed };
        bed.material.damping = 6.0;
        bed.run(8.0);
        // The outermost have a diagonal to one side only.
        for column in 1..columns - 1 {
            let particle = grid.particle(column, 2) as usize;
            let springs: Vec<_> = bed
                .topology
                .springs_of(kind)
                .filter(|spring| [spring.a, spring.b].contains(&(particle as u32)))
                .filter(|spring| spring.a.min(spring.b) < 2 * columns)
                .collect();
            let place = bed.particles.position[particle];
            let lifted: Vec3A = springs
                .iter()
                .map(|spring| {
                    let other = if spring.a as usize == particle { spring.b } else { spring.a };
                    let up = bed.particles.position[other as usize] - place;
                    up.normalize() * (up.length() - spring.rest) * STIFFNESS
                })
                .sum();
            let weight = GRAVITY / bed.particles.inverse_mass[particle];
            assert_eq!(springs.len(), if kind == SpringKind::Shear { 2 } else { 1 });
            let error = lifted.distance(Vec3A::Y * weight) / weight;
            assert!(error < 0.005, "{method:?}, {kind:?}, column {column}: {lifted} for {weight} N");
        }
    }
}

/// A square metre of `n` x `n` particles that hangs by two corners, with all that a game gives it but air.
fn hung(n: u32) -> Bed {
    let corners = [0, n - 1];
    let mut bed = Bed::lying(n, springs_in_air(Springs::default())).pinned(corners).tethered(&corners);
    bed.fluid_density = 0.0;
    bed
}

fn largest_strain(bed: &Bed) -> f32 {
    measure::strain(&bed.particles, &bed.topology).largest
}

#[test]
fn the_substeps_to_hold_a_strain_hold_it() {
    let mut failures = Vec::new();
    for (n, max_strain) in [(32, 0.01), (64, 0.01), (32, 0.005)] {
        let mut bed = hung(n);
        bed.substep_policy = SubstepPolicy::to_hold(max_strain, &bed.topology, bed.material.moduli());
        bed.run(4.0);
        // The mean over a second, as the lab measures it.
        let strains = (0..60).map(|_| {
            bed.step(FRAME);
            largest_strain(&bed)
        });
        let strain = strains.sum::<f32>() / 60.0;
        let substeps = bed.substep_policy.substeps;
        let case = format!("{n} x {n}, {substeps} substeps: {strain} for {max_strain}");
        println!("{case}");
        failures.extend((strain > max_strain).then_some(case));
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn a_hung_cloth_comes_to_rest() {
    let mut failures = Vec::new();
    for (method, n) in STABLE.into_iter().flat_map(|method| [(method, 32), (method, 64)]) {
        let mut bed = hung(n).like_a_game(method);
        bed.material.damping = 1.0;
        bed.run(15.0);
        // Taut threads near a pin tremble, by less than anyone sees.
        let mut farthest = 0.0_f32;
        for _ in 0..60 {
            let before = bed.particles.position.clone();
            bed.step(FRAME);
            let ways = bed.particles.position.iter().zip(&before).map(|(p, q)| p.distance(*q));
            farthest = ways.fold(farthest, f32::max);
        }
        let case =
            format!("{method:?}, {n} x {n}, {} substeps: still {farthest} m a frame", bed.substep_policy.substeps);
        println!("{case}");
        failures.extend((farthest > 0.001).then_some(case));
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn less_strain_takes_no_fewer_substeps_and_a_finer_mesh_neither() {
    let substeps = |n, max_strain| {
        let bed = hung(n);
        SubstepPolicy::to_hold(max_strain, &bed.topology, bed.material.moduli()).substeps
    };
    let by_strain = [0.1, 0.02, 0.01, 0.005, 0.001, 1e-6].map(|max_strain| substeps(32, max_strain));
    assert!(by_strain.is_sorted() && by_strain[0] == 2 && by_strain[4] > 2 * by_strain[2], "{by_strain:?}");
    let by_size = [2, 16, 64, 128].map(|n| substeps(n, 0.005));
    assert!(by_size.is_sorted() && by_size[3] > by_size[1], "{by_size:?}");
}

#[test]
fn more_substeps_are_taken_near_an_obstacle_and_without_tethers() {
    let ground = |height: f32| {
        let pose = Isometry3d::from_translation(Vec3::Y * height);
        let shape = Solid::HalfSpace(InfinitePlane3d::default());
        vec![Obstacle::still(shape, pose)]
    };
    let mut bed = hung(16);
    bed.substep_policy = SubstepPolicy::to_hold(0.1, &bed.topology, bed.material.moduli());
    bed.obstacles = ground(-3.0);
    assert_eq!(bed.step(FRAME).substeps, 2);
    let tethers = bed.tethers.take();
    assert_eq!(bed.step(FRAME).substeps, 8, "nothing but springs holds the cloth");
    bed.tethers = tethers;
    bed.obstacles = ground(-0.5);
    let mut last_before_contact = 0;
    for _ in 0..120 {
        let report = bed.step(FRAME);
        if report.contacts > 0 {
            assert_eq!(report.substeps, 8);
            break;
        }
        last_before_contact = report.substeps;
    }
    assert_eq!(last_before_contact, 8, "they are more before it touches");
    bed.substep_policy = SubstepPolicy::fixed(2, bed.substep_policy.levels);
    assert_eq!(bed.step(FRAME).substeps, 2, "by hand they are as many everywhere");
    bed.method = Method::Xpbd;
    assert_eq!(bed.step(FRAME).substeps, 2);
}

#[test]
fn a_tall_cloth_sways_like_a_wide_one_that_is_turned() {
    // The tall one is cut into bands of rows, the wide one isn't.
    let (long, short) = (70, 9);
    let place = |is_tall: bool| {
        let (columns, rows) = if is_tall { (short, long) } else { (long, short) };
        let grid = Grid::new(0.1 * columns as f32, 0.1 * rows as f32, columns, rows);
        let particle = |along: u32, across: u32| {
            if is_tall { grid.particle(across, along) } else { grid.particle(along, across) }
        };
        let bed = Bed::new(grid, springs(Springs::default())).pinned((0..short).map(|across| particle(0, across)));
        let (down, aside) = if is_tall { (Vec3A::NEG_Y, Vec3A::X) } else { (Vec3A::X, Vec3A::NEG_Y) };
        let mut bed = bed.with_substeps(16);
        bed.material.damping = 4.0;
        bed.gravity = 2.0 * down + aside;
        bed.run(4.0);
        (0..long)
            .flat_map(|along| (0..short).map(move |across| particle(along, across) as usize))
            .map(|i| bed.particles.position[i] - Vec3A::from(bed.topology.rest[i]))
            .map(|way| [way.dot(down), way.dot(aside)])
            .collect::<Vec<_>>()
    };
    let (tall, wide) = (place(true), place(false));
    let largest = tall.iter().flatten().fold(0.0_f32, |most, way| most.max(way.abs()));
    let apart = tall.iter().flatten().zip(wide.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    println!("they move by {largest} m, and are {apart} m apart");
    assert!(largest > 0.1 && apart < 0.002, "{largest} m, {apart} m apart");
}
