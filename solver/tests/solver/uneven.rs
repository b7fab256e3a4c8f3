//! Rows and columns whose cells aren't rectangles, as those of flared clothes, are the same sheet.

use core::f32::consts::FRAC_PI_4;

use bevy_math::{Mat3A, Vec3, Vec3A, ops};
use drape_solver::{Elasticity, Material, Method, Moduli, SimdLevel, SourceMesh, measure::energy};

use crate::{
    bench_bed::{Bed, GRAVITY, bits},
    fixtures::{
        material::{Fabric, bare},
        mesh::{Grid, shaped, topology},
    },
};

/// Flat sheets of uneven cells, from the unit square in x and y.
fn shapes() -> [(&'static str, fn(Vec3) -> Vec3); 5] {
    [
        // Columns fan out by half a right angle, and rows are arcs, three times as long at the hem.
        ("ring", |p| {
            let (radius, angle) = (0.3 + 0.6 * p.y, FRAC_PI_4 * p.x);
            Vec3::new(radius * ops::sin(angle), radius * ops::cos(angle), 0.0)
        }),
        // Rows stay straight, and columns lean by up to 17° to each side.
        ("trapezoid", |p| Vec3::new((p.x - 0.5) * (0.6 + 0.6 * p.y), p.y, 0.0)),
        // To one side only, by up to 27°.
        ("half a flare", |p| Vec3::new(p.x * (0.4 + 0.5 * p.y), p.y, 0.0)),
        // All columns by 14°.
        ("leaning", |p| Vec3::new(p.x + 0.25 * p.y, p.y, 0.0)),
        // Rows hang through, and draw closer towards one end.
        ("hanging rows", |p| Vec3::new(p.x, p.y * (0.5 + 0.5 * p.y) - 0.1 * ops::sin(3.1 * p.x), 0.0)),
    ]
}

fn square(cells: u32) -> Grid {
    Grid::new(1.0, 1.0, cells + 1, cells + 1)
}

fn made(shape: fn(Vec3) -> Vec3, cells: u32) -> SourceMesh {
    shaped(square(cells), |p| shape(p + Vec3::new(0.5, 0.5, 0.0)))
}

/// A sheet that is as stiff in all directions, as long as its threads are at right angles. No cell may be so long that its springs would
/// have to push apart.
fn isotropic() -> Material {
    let moduli = Moduli { stretch: [300.0; 2], shear: 100.0, compression: 1.0, ..Moduli::default() };
    Material::bare(0.1, Elasticity::Moduli(moduli))
}

#[test]
fn an_isotropic_sheet_takes_the_energy_of_its_strains_whatever_its_cells() {
    let strains = [
        ("along", Mat3A::from_diagonal(Vec3::new(1.01, 1.0, 1.0))),
        ("across", Mat3A::from_diagonal(Vec3::new(1.0, 1.01, 1.0))),
        ("both", Mat3A::from_diagonal(Vec3::new(1.01, 1.01, 1.0))),
        ("shear", Mat3A::from_cols(Vec3A::new(1.0, 0.005, 0.0), Vec3A::new(0.005, 1.0, 0.0), Vec3A::Z)),
    ];
    let expected = [150.0, 150.0, 400.0, 50.0].map(|modulus| modulus * 1e-4);
    for (name, shape) in shapes() {
        let bed = Bed::new(made(shape, 16), isotropic());
        assert!(bed.topology.lattice.is_some(), "{name}");
        let area: f32 = bed.topology.triangle_areas.iter().sum();
        for ((way, strain), expected) in strains.into_iter().zip(expected) {
            let mut strained = bed.particles.clone();
            strained.position.iter_mut().for_each(|place| *place = strain * *place);
            let found = energy(&strained, &bed.topology, &bed.material, Vec3A::ZERO).elastic / area;
            println!("{name}, {way}: {:.1} % off", 100.0 * (found / expected - 1.0));
            assert!((found / expected - 1.0).abs() < 0.1, "{name}, {way}: {found} for {expected} J/m²");
        }
    }
}

/// Radial way at the inner and the outer rim of a ring (radii in m) under a tension of `pull` N/m all around its outer rim, m: after
/// Lamé, for a Young's modulus of E N/m and Poisson's ratio ν, u(r) = (1 - ν) A r / E + (1 + ν) B / (E r) with A - B / r² = σ(r).
fn lame([inner, outer]: [f32; 2], pull: f32) -> [f32; 2] {
    let (young, ratio) = (300.0 * (1.0 - 1.0 / 9.0), 1.0 / 3.0);
    let a = pull * outer * outer / (outer * outer - inner * inner);
    let b = a * inner * inner;
    [inner, outer].map(|r| ((1.0 - ratio) * a * r + (1.0 + ratio) * b / r) / young)
}

#[test]
fn a_ring_that_is_pulled_all_around_gets_wider_as_on_paper() {
    let radii = [0.25, 0.5];
    let [around, rings] = [80, 11];
    // A tube that lies flat: its last column is its first.
    let mesh = shaped(Grid::new(1.0, 1.0, around + 1, rings), |p| {
        let (radius, angle) = (radii[1] + (radii[0] - radii[1]) * (0.5 - p.y), core::f32::consts::TAU * p.x);
        Vec3::new(radius * ops::cos(angle), 0.0, radius * ops::sin(angle))
    });
    let pull = 1.5;
    let expected = lame(radii, pull);
    // With few substeps a cloth is soft whose diagonals carry much of a pull, as those of knits.
    let efforts = [(Method::Strands, 8, 0.15), (Method::Strands, 32, 0.02), (Method::Explicit, 1, 0.01)];
    for (method, substeps, within) in efforts {
        let bed = Bed::new(mesh.clone(), Material { damping: 30.0, ..isotropic() });
        assert!(bed.topology.lattice.as_ref().is_some_and(|lattice| lattice.along_rows.closed));
        let mut bed = Bed { method, gravity: Vec3A::ZERO, fluid_density: 0.0, ..bed }.with_substeps(substeps);
        let rim = |bed: &Bed, radius: f32| -> Vec<usize> {
            let is_there = |i: &usize| (bed.topology.rest[*i].length() - radius).abs() < 1e-3;
            (0..bed.particles.len()).filter(is_there).collect()
        };
        let share = pull * core::f32::consts::TAU * radii[1] / around as f32;
        for i in rim(&bed, radii[1]) {
            bed.particles.force[i] = Vec3A::from(bed.topology.rest[i]).normalize() * share;
        }
        let forces = bed.particles.force.clone();
        for _ in 0..60 {
            bed.particles.force.clone_from(&forces);
            bed.step(1.0 / 60.0);
        }
        for (radius, expected) in radii.into_iter().zip(expected) {
            let some = rim(&bed, radius);
            let found =
                some.iter().map(|&i| bed.particles.position[i].length() - radius).sum::<f32>() / some.len() as f32;
            println!("{method:?}, {substeps} substeps, {radius} m: {found} for {expected} m");
            assert!((found / expected - 1.0).abs() < within, "{method:?}, {substeps}: {found} for {expected} m");
        }
    }
}

/// How far the end of a strip of so much width at its clamp and its end hangs below its clamp, over its length, if (B / (ρ g))^(1/3)
/// is `length` of it: the heavy elastica of a strip that isn't as wide everywhere.
fn droop(length: f64, widths: [f64; 2]) -> f64 {
    const STEPS: usize = 2000;
    let h = 1.0 / STEPS as f64;
    let width = |s: f64| widths[0] + (widths[1] - widths[0]) * s;
    let beyond = |s: f64| 0.5 * (width(s) + widths[1]) * (1.0 - s);
    let end = |moment: f64| {
        let (mut theta, mut moment, mut drop) = (0.0_f64, moment, 0.0);
        for i in 0..STEPS {
            let s = (i as f64 + 0.5) * h;
            let middle = theta + 0.5 * h * moment / width(s);
            moment -= h * beyond(s) * middle.cos() / length.powi(3);
            theta += h * moment / width(s);
            drop += h * middle.sin();
        }
        (moment, drop)
    };
    let (mut low, mut high) = (0.0, 4.0 * widths[0].max(widths[1]) / length.powi(3));
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if end(middle).0 > 0.0 { high = middle } else { low = middle }
    }
    end(low).1
}

#[test]
fn a_flared_strip_hangs_over_an_edge_as_the_elastica_does() {
    let fabric = Fabric::COTTON_WOVEN;
    let natural = (fabric.bending_rigidity / (fabric.density * GRAVITY)).cbrt();
    let (cells, length) = (16, 2.0 * natural);
    let cell = length / (cells as f32 + 0.5);
    // Columns lean by up to 12° to each side.
    for widths in [[0.6 * length, length], [length, 0.6 * length]] {
        let grid = Grid::new(1.0, cell * (cells + 1) as f32, 13, cells + 2).lying();
        let top = -0.5 * cell * (cells + 1) as f32;
        let mesh = shaped(grid, |p| {
            let along = (p.z - top - 0.5 * cell) / length;
            Vec3::new(p.x * (widths[0] + (widths[1] - widths[0]) * along), 0.0, p.z)
        });
        let material = Material { damping: 12.0, ..bare(fabric.clone()) };
        let mut bed = Bed { fluid_density: 0.0, ..Bed::new(mesh, material).pinned(0..26) };
        assert!(bed.topology.lattice.is_some());
        bed.run(4.0);
        assert!(bed.fastest() < 5e-3, "it still moves");
        let last = bed.particles.len() - 13;
        let drop = -bed.particles.position[last..].iter().map(|p| p.y).sum::<f32>() / 13.0 / length;
        let expected = droop(f64::from(natural / length), widths.map(f64::from)) as f32;
        println!("{widths:?}: {drop} for {expected}");
        assert!((drop / expected - 1.0).abs() < 0.06, "{widths:?}: {drop} for {expected}");
    }
}

/// A sheet whose top rows are drawn together and folded over a shoulder, as those of a cape at its collar.
fn collared() -> SourceMesh {
    shaped(Grid::new(0.8, 1.2, 25, 33), |p| {
        let up = (p.y - 0.5).max(0.0) / 0.1;
        let lean = 0.05 * up * p.x / 0.4;
        Vec3::new(p.x - lean, p.y - 0.02 * up * (p.x / 0.4).powi(2), 0.03 * up)
    })
}

#[test]
fn a_few_cells_that_lean_far_leave_rows_and_columns_what_they_are() {
    let mesh = collared();
    let topology = topology(mesh.clone());
    let corner = |at: u32| {
        let [a, b, c] = [at, at + 1, at + 25].map(|i| mesh.positions[i as usize]);
        (b - a).angle_between(c - a).to_degrees()
    };
    let leaning = (0..31)
        .flat_map(|row| (0..24).map(move |column| row * 25 + column))
        .filter(|&at| !(70.0..=110.0).contains(&corner(at)));
    let leaning: Vec<u32> = leaning.collect();
    assert!(leaning.len() > 4 && leaning.len() < 76, "{} cells", leaning.len());
    let lattice = topology.lattice.expect("rows and columns");
    assert_eq!((lattice.rows, lattice.columns), (33, 25));
}

#[test]
fn what_leans_far_everywhere_is_no_lattice() {
    let zigzag = |p: Vec3| {
        let row = ((0.5 - p.y) * 12.0).round() as i32;
        Vec3::new(p.x + if row % 2 == 0 { 0.0 } else { 0.5 / 12.0 }, p.y, 0.0)
    };
    let leaning = |p: Vec3| Vec3::new(p.x + 0.6 * p.y, p.y, 0.0);
    assert!(topology(shaped(square(12), zigzag)).lattice.is_none());
    assert!(topology(shaped(square(12), leaning)).lattice.is_none());
}

#[test]
fn a_flared_sheet_in_the_wind_moves_the_same_with_all_instructions() {
    let [best, plain] = [SimdLevel::Best, SimdLevel::Baseline].map(|simd_level| {
        let mut bed = Bed::new(collared(), Fabric::DENIM.material()).pinned(0..25).with_substeps(6);
        bed.scratch.simd_level = simd_level;
        bed.particles.velocity.iter_mut().enumerate().for_each(|(i, v)| *v = Vec3A::Z * (i % 7) as f32 * 0.1);
        bed.run(1.0);
        assert!(bed.particles.is_finite());
        bits(&bed.particles)
    });
    assert!(best == plain);
}
