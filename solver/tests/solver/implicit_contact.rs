//! Implicit steps of sheets that lie on obstacles: they rest there, slide as Coulomb says, and gain no energy.

use bevy_math::{
    Dir3, Isometry3d, Quat, Vec3, Vec3A, ops,
    primitives::{Capsule3d, InfinitePlane3d, Sphere},
};
use drape_solver::{Elasticity, Material, Moduli, Obstacle, Solid, measure};

use crate::{
    bench_bed::{Bed, GRAVITY, rms},
    fixtures::mesh::{Grid, uneven},
};

/// A piece of woven cotton of so many vertices along a side, which lies at height 0.
fn cotton(length: f32, side: u32, damping: f32, friction: f32) -> Bed {
    let moduli = Moduli::from_strips([4000.0; 2], 50.0, [0.0; 2], 1.0).expect("a sheet");
    let sheet = Elasticity::Moduli(Moduli { bending: 18e-6, ..moduli });
    let mesh = uneven(Grid::new(length, length, side, side).lying(), 0.25);
    let bed = Bed::new(mesh, Material { damping, friction, ..Material::bare(0.15, sheet) });
    assert!(bed.topology.two_grid.is_some() && bed.topology.lattice.is_none());
    Bed { fluid_density: 0.0, ..bed }
}

#[test]
fn a_sheet_that_falls_on_something_round_loses_energy_all_the_time_and_comes_to_rest() {
    let ball = (Solid::Sphere(Sphere::new(0.4)), Vec3::NEG_Y * 0.45, Quat::IDENTITY);
    let bar = (Solid::Capsule(Capsule3d::new(0.1, 0.6)), Vec3::NEG_Y * 0.15, Quat::from_rotation_z(1.5));
    for (name, (solid, place, turn)) in [("ball", ball), ("bar", bar)] {
        let mut bed = cotton(1.0, 48, 0.2, 0.5);
        // As a game has it: so deep, triangles may cut into the ball between their corners.
        bed.margin = 5e-3;
        bed.obstacles = vec![Obstacle::still(solid, Isometry3d::new(place, turn))];
        let energy = |bed: &Bed| measure::energy(&bed.particles, &bed.topology, &bed.material, bed.gravity).total();
        let (begun, mut least, mut gained) = (energy(&bed), f32::INFINITY, 0.0);
        for _ in 0..360 {
            bed.step(1.0 / 60.0);
            let now = energy(&bed);
            gained += (now - least).max(0.0);
            least = now;
        }
        let before = bed.particles.clone();
        bed.step(1.0 / 60.0);
        let (seen, lost) = (rms(&bed.particles, &before) * 60.0, begun - energy(&bed));
        let strain = measure::strain(&bed.particles, &bed.topology).largest;
        println!("{name}: {seen} m/s rms, gained {gained} J of {lost} J, strain {strain}");
        // Where contact came after the step only, 0.1 to 0.4 m/s, and as much gained as lost.
        assert!(seen < 5e-3, "{name}: {seen} m/s rms");
        assert!(gained < 0.01 * lost, "{name}: {gained} J of {lost} J");
        assert!(strain < 0.1, "{name}: {strain}");
    }
}

#[test]
fn a_sheet_on_a_slope_stays_or_slides_as_coulomb_says() {
    // It slides from 26.6 degrees on.
    const FRICTION: f32 = 0.5;
    for degrees in [10.0_f32, 20.0, 30.0, 45.0, 60.0] {
        let slope = degrees.to_radians();
        let mut bed = cotton(0.5, 20, 0.0, FRICTION);
        let ground = Solid::HalfSpace(InfinitePlane3d { normal: Dir3::Y });
        let below = Isometry3d::from_translation(Vec3::NEG_Y * 1e-3);
        bed.obstacles = vec![Obstacle::still(ground, below)];
        bed.gravity = Vec3A::new(ops::sin(slope), -ops::cos(slope), 0.0) * GRAVITY;
        bed.run(0.5);
        let along = |bed: &Bed| {
            let sum = |points: &[Vec3A]| points.iter().sum::<Vec3A>().x / points.len() as f32;
            [sum(&bed.particles.position), sum(&bed.particles.velocity)]
        };
        let [from, speed] = along(&bed);
        bed.run(1.0);
        let [to, faster] = along(&bed);
        let expected = GRAVITY * (ops::sin(slope) - FRICTION * ops::cos(slope));
        println!("{degrees}: by {} m, {} m/s², expected {expected}", to - from, faster - speed);
        if expected < 0.0 {
            assert!((to - from).abs() < 1e-5, "{degrees}: it creeps by {} m", to - from);
        } else {
            assert!((faster - speed - expected).abs() < 0.02 * expected + 0.02, "{degrees}: {} m/s²", faster - speed);
        }
    }
}

#[test]
fn a_sheet_that_a_board_lifts_goes_with_it() {
    let mut bed = cotton(0.5, 20, 0.0, 0.5);
    let board = |height: f32| {
        let solid = Solid::HalfSpace(InfinitePlane3d { normal: Dir3::Y });
        Obstacle::still(solid, Isometry3d::from_translation(Vec3::Y * height))
    };
    bed.obstacles = vec![board(-1e-3)];
    bed.run(0.5);
    for frame in 0..60 {
        let [from, to] = [frame, frame + 1].map(|frame| board(-1e-3 + frame as f32 / 60.0).start);
        bed.obstacles[0].start = from;
        bed.obstacles[0].end = to;
        bed.step(1.0 / 60.0);
    }
    for (place, velocity) in bed.particles.position.iter().zip(&bed.particles.velocity) {
        assert!((place.y - 1.0).abs() < 2e-3, "at {place}");
        assert!((velocity.y - 1.0).abs() < 0.02, "{velocity}");
    }
}
