//! Implicit steps of sheets on any triangles: no energy but what was put in, and rest.

use bevy_math::{Vec3, Vec3A, ops};
use drape_solver::{Elasticity, Material, Moduli, Scratch, SourceMesh, Topology, measure};
use proptest::prelude::*;

use crate::{
    bench_bed::{Bed, GRAVITY, bits, rms},
    fixtures::mesh::{Grid, assemble, ball, both, uneven},
};

/// Woven cotton, without damping.
fn cotton() -> Material {
    fabric(0.15, [4000.0; 2], 50.0, [0.0; 2], 18e-6)
}

/// Jersey: soft, and stiffer the more it is stretched.
fn jersey() -> Material {
    fabric(0.187, [33.0, 69.0], 37.0, [10.7, 63.0], 5e-6)
}

fn fabric(density: f32, pulled: [f32; 2], shear: f32, stiffening: [f32; 2], bending: f32) -> Material {
    let moduli = Moduli::from_strips(pulled, shear, stiffening, 1.0).expect("a sheet");
    Material::bare(density, Elasticity::Moduli(Moduli { bending, ..moduli }))
}

/// A cloth with four substeps a step, as a game has them, in a vacuum.
fn bed(mesh: SourceMesh, material: Material) -> Bed {
    let bed = Bed { fluid_density: 0.0, ..Bed::new(mesh, material) }.with_substeps(4);
    assert!(bed.topology.lattice.is_none() && bed.topology.two_grid.is_some());
    bed
}

/// The particles at the left side.
fn left(topology: &Topology) -> Vec<u32> {
    let left = topology.rest.iter().map(|p| p.x).fold(f32::INFINITY, f32::min);
    (0..).zip(&topology.rest).filter(|(_, p)| p.x < left + 1e-4).map(|(i, _)| i).collect()
}

/// An uneven flag of so many vertices a side, pinned at its left, with a ripple of a millimetre.
fn flag(side: u32, share: f32, material: Material) -> Bed {
    let mut mesh = uneven(Grid::new(1.0, 1.0, side, side), share);
    // One triangle less: no rows and columns, however even.
    mesh.triangles.pop();
    let bed = bed(mesh, material);
    let pins = left(&bed.topology);
    let mut bed = bed.pinned(pins);
    for (place, w) in bed.particles.position.iter_mut().zip(&bed.particles.inverse_mass) {
        if *w > 0.0 {
            place.z += 1e-3 * ops::sin(7.0 * place.x + 3.0 * place.y);
        }
    }
    bed
}

/// Kinetic and elastic energy and that in the field of gravity, J.
fn energy(bed: &Bed) -> f32 {
    measure::energy(&bed.particles, &bed.topology, &bed.material, bed.gravity).total()
}

/// Steps for so many seconds. Fails where the energy grows by more than the `rounding`, J, beyond the least so far.
fn run_down(bed: &mut Bed, seconds: f32, rounding: f32) {
    let mut least = energy(bed);
    for frame in 0..(seconds * 60.0) as u32 {
        bed.step(1.0 / 60.0);
        let now = energy(bed);
        assert!(now < least + rounding, "frame {frame}: {now} J after {least} J");
        least = least.min(now);
    }
}

/// Largest speed that is seen, and its root mean square, m/s: how far particles go in a frame.
fn seen(bed: &mut Bed) -> [f32; 2] {
    let before = bed.particles.clone();
    bed.step(1.0 / 60.0);
    let ways = before.position.iter().zip(&bed.particles.position).map(|(a, b)| a.distance(*b) * 60.0);
    [ways.fold(0.0, f32::max), rms(&bed.particles, &before) * 60.0]
}

#[test]
fn an_uneven_flag_gains_no_energy_and_comes_to_rest() {
    for (side, share, material) in [(24, 0.1, cotton()), (24, 0.25, cotton()), (16, 0.25, jersey())] {
        let mut bed = flag(side, share, Material { damping: 1.0, ..material });
        // Its weight times a metre is 1.5 J.
        run_down(&mut bed, 20.0, 1e-4);
        let [largest, rms] = seen(&mut bed);
        assert!(largest < 0.1 && rms < 0.02, "{side} {share}: {largest} m/s, {rms} m/s rms");
    }
}

#[test]
fn a_free_sheet_that_is_pushed_has_no_more_energy_than_that() {
    let mut bed = bed(uneven(Grid::new(1.0, 1.0, 12, 12), 0.25), cotton());
    bed.gravity = Vec3A::ZERO;
    for (velocity, place) in bed.particles.velocity.iter_mut().zip(&bed.particles.position) {
        if place.x > 0.3 {
            *velocity = Vec3A::new(0.3, 0.2, 0.9);
        }
    }
    let mass: f32 = bed.particles.inverse_mass.iter().map(|w| 1.0 / w).sum();
    let momentum = |bed: &Bed| -> Vec3A {
        bed.particles.velocity.iter().zip(&bed.particles.inverse_mass).map(|(v, w)| v / *w).sum()
    };
    let before = momentum(&bed);
    run_down(&mut bed, 3.0, 1e-6);
    // The cloth flies on with what it was given.
    let lost = (momentum(&bed) - before).length() / mass;
    assert!(lost < 1e-3, "{lost} m/s of {} m/s", before.length() / mass);
}

#[test]
fn a_closed_ball_stays_as_it_is() {
    let mut bed = bed(ball(0.5, 3), cotton());
    bed.gravity = Vec3A::ZERO;
    let start = bed.particles.clone();
    bed.run(20.0);
    let way = start.position.iter().zip(&bed.particles.position).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
    assert!(way < 1e-4, "{way} m");
}

#[test]
fn what_falls_freely_falls_as_a_stone() {
    // Two pieces in one mesh, one of them closed.
    let pieces = both(uneven(Grid::new(0.5, 0.5, 10, 10), 0.25), {
        let mut ball = ball(0.2, 2);
        ball.positions.iter_mut().for_each(|place| *place += Vec3::X);
        ball.uvs = None;
        ball
    });
    let mut bed = bed(SourceMesh { uvs: None, normals: None, ..pieces }, cotton());
    let (start, shape) = (bed.centre(), bed.particles.clone());
    bed.run(0.5);
    let fall = start - bed.centre();
    // Symplectic: after n substeps of h, g h² n (n + 1) / 2.
    let h = 1.0 / 240.0;
    let expected = GRAVITY * h * h * 120.0 * 121.0 / 2.0;
    assert!((fall - Vec3A::Y * expected).length() < 1e-3, "{fall}");
    let mut moved = shape;
    moved.position.iter_mut().for_each(|place| *place -= fall);
    assert!(rms(&bed.particles, &moved) < 1e-4);
}

#[test]
fn a_narrow_triangle_is_no_reason_to_explode() {
    // Two triangles of a strip, one of which is a hundred times as long as it is high.
    let mut mesh = uneven(Grid::new(1.0, 1.0, 12, 12), 0.25);
    let (near, of) = (mesh.positions[65], mesh.positions[66]);
    mesh.positions[65] = of.lerp(near, 0.01);
    let mut bed = bed(mesh, Material { damping: 1.0, ..cotton() });
    let pins = left(&bed.topology);
    bed = bed.pinned(pins);
    bed.particles.position.iter_mut().for_each(|place| place.z += 1e-3 * place.x);
    run_down(&mut bed, 5.0, 1e-4);
}

#[test]
fn a_cloth_that_another_is_stepped_between_goes_on_as_if_alone() {
    // Factors are kept with the topology, and the rest of a step in memory that all share.
    let alone = |scratch: Option<Scratch>| {
        let mut bed = flag(16, 0.25, cotton());
        bed.scratch = scratch.unwrap_or_default();
        let pin = bed.pin_motions.clone();
        for frame in 0..60 {
            // Pins are let go and held again.
            let is_held = (frame / 15) % 2 == 0;
            for pin in &pin {
                let w = &mut bed.particles.inverse_mass[pin.particle as usize];
                *w = if is_held { 0.0 } else { 1.0 / (0.15 * bed.topology.areas[pin.particle as usize]) };
            }
            bed.pin_motions = if is_held { pin.clone() } else { Vec::new() };
            for held in &mut bed.pin_motions {
                let place = bed.particles.position[held.particle as usize];
                (held.start, held.end) = (place, place);
            }
            bed.step(1.0 / 60.0);
        }
        bits(&bed.particles)
    };
    let mut other = flag(24, 0.25, jersey());
    other.run(0.1);
    assert_eq!(alone(None), alone(Some(other.scratch)));
}

#[test]
fn triangles_without_area_hold_by_their_sides() {
    // Two squares that only a triangle in one line joins.
    let places =
        [(0.0, 0.0), (0.1, 0.0), (0.1, 0.1), (0.0, 0.1), (0.3, 0.0), (0.4, 0.0), (0.4, 0.1), (0.3, 0.1), (0.2, 0.0)];
    let places = places.map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec();
    let triangles = [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7], [1, 8, 4]];
    let mut bed = bed(assemble(places, &triangles), Material { damping: 2.0, ..cotton() }).pinned([0, 3]);
    bed.run(5.0);
    let [a, b] = [1, 4].map(|i| bed.particles.position[i]);
    assert!((a.distance(b) / 0.2 - 1.0).abs() < 0.02, "{} m", a.distance(b));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn whatever_is_crumpled_never_has_more_energy_than_it_had(
        side in 4_u32..14,
        share in 0.0_f32..0.45,
        noise in 0.0_f32..0.3,
        is_soft in any::<bool>(),
        pins in 0_u32..4,
        seed in any::<u64>(),
    ) {
        let mut random = fastrand::Rng::with_seed(seed);
        let mut mesh = uneven(Grid::new(1.0, 1.0, side, side), share);
        // One triangle less: no rows and columns, however even.
        mesh.triangles.pop();
        let mut bed = bed(mesh, if is_soft { jersey() } else { cotton() });
        for place in &mut bed.particles.position {
            *place += Vec3A::from([0; 3].map(|_| random.f32() - 0.5)) * noise;
        }
        let count = bed.particles.len() as u32;
        let mut bed = bed.pinned((0..pins).map(|pin| pin * 7 % count));
        let start = energy(&bed);
        let floor = -GRAVITY * 0.2;
        for frame in 0..60 {
            bed.step(1.0 / 60.0);
            // Of what was there above the floor that the cloth can fall to in that time.
            let now = energy(&bed);
            prop_assert!(now - floor < 1.01 * (start - floor), "frame {frame}: {now} J of {start} J");
        }
    }
}
