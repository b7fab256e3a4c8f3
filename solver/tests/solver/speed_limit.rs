//! No particle gets away.

use bevy_math::Vec3A;
use drape_solver::{Material, Method};

use crate::{
    bench_bed::{Bed, STABLE},
    fixtures::material::{Springs, springs_in_air},
};

const FRAME: f32 = 1.0 / 60.0;

/// A cloth held by two corners that move at `carried` (m/s) and that moves along with them.
fn carried(method: Method, carried: Vec3A) -> Bed {
    let material = Material { damping: 0.0, ..springs_in_air(Springs::default()) };
    let bed = Bed::lying(16, material).pinned([0, 15]).tethered(&[0, 15]).with_levels();
    let mut bed = Bed { method, max_velocity: 50.0, fluid_density: 0.0, ..bed };
    bed.pin_motions.iter_mut().for_each(|anchor| anchor.end = anchor.start + carried * FRAME);
    bed.particles.velocity.fill(carried);
    bed
}

fn fastest_beside(bed: &Bed, carried: Vec3A) -> f32 {
    bed.particles.velocity.iter().map(|velocity| velocity.distance(carried)).fold(0.0, f32::max)
}

#[test]
fn a_particle_shot_at_a_thousand_metres_a_second_is_held_back() {
    for (method, pins) in STABLE.into_iter().flat_map(|method| [(method, Vec3A::ZERO), (method, Vec3A::X * 200.0)]) {
        // One that tethers hold as well, and one in the middle of a block.
        for particle in [255, 100] {
            let shot = |max_velocity: f32| {
                let mut bed = Bed { max_velocity, ..carried(method, pins) };
                bed.particles.velocity[particle] += Vec3A::new(600.0, 800.0, 0.0);
                bed.step(FRAME);
                assert!(bed.particles.is_finite());
                fastest_beside(&bed, pins)
            };
            let free = shot(f32::MAX);
            for most in [free / 2.0, free / 10.0] {
                let speed = shot(most);
                assert!(speed <= most * 1.00001, "{method:?}, pins at {pins} m/s: {speed} for {most} m/s");
            }
        }
    }
}

#[test]
fn a_cloth_without_tethers_or_pins_is_held_back_too() {
    for method in STABLE {
        let mut bed = carried(method, Vec3A::ZERO);
        (bed.tethers, bed.pin_motions) = (None, Vec::new());
        bed.particles.set_masses(&bed.topology, &bed.material, |_| false);
        bed.particles.velocity.fill(Vec3A::Z * 1000.0);
        bed.step(FRAME);
        let speed = bed.fastest();
        assert!((speed / 50.0 - 1.0).abs() < 1e-5, "{method:?}: {speed} m/s");
    }
}

#[test]
fn a_cloth_that_is_carried_faster_than_the_limit_comes_along() {
    for method in STABLE {
        let pins = Vec3A::X * 200.0;
        let mut bed = carried(method, pins);
        for _ in 0..60 {
            bed.step(FRAME);
            bed.pin_motions.iter_mut().for_each(|anchor| {
                let way = anchor.end - anchor.start;
                (anchor.start, anchor.end) = (anchor.end, anchor.end + way);
            });
        }
        // As if the pins stood still: the same swing, seen from a train.
        let mut still = carried(method, Vec3A::ZERO);
        still.run(1.0);
        let farthest = bed.particles.position.iter().zip(&still.particles.position);
        let farthest = farthest.map(|(p, q)| p.distance(*q + pins)).fold(0.0, f32::max);
        println!("{method:?}: {farthest} m");
        assert!(farthest < 0.05, "{method:?}: {farthest} m");
    }
}

#[test]
fn a_cloth_below_the_limit_does_not_feel_it() {
    for method in STABLE {
        let swung = |max_velocity| {
            let mut bed = Bed { max_velocity, ..carried(method, Vec3A::ZERO) };
            bed.run(0.25);
            bed
        };
        let (limited, free) = (swung(20.0), swung(f32::MAX));
        assert!(limited.fastest() > 1.0, "{method:?}: {} m/s", limited.fastest());
        assert_eq!(limited.particles, free.particles, "{method:?}");
    }
}
