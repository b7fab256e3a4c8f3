//! The result doesn't hang on the time step or the number of substeps more than a game would notice.

use drape_solver::{Material, Method, SubstepPolicy};

use crate::{
    bench_bed::{Bed, STABLE, rms},
    fixtures::material::{Springs, springs_in_air},
};

/// A cloth that hangs by two corners and has come to rest, with the levels that go with so many substeps.
fn hung(method: Method, rate: f32, substeps: u32) -> Bed {
    let material = Material { damping: 3.0, ..springs_in_air(Springs::default()) };
    let bed = Bed::lying(16, material).pinned([0, 15]).tethered(&[0, 15]);
    let substep_policy = SubstepPolicy::fixed(substeps, SubstepPolicy::levels_for(substeps, &bed.topology));
    let mut bed = Bed { method, substep_policy, ..bed };
    for _ in 0..(8.0 * rate) as u32 {
        bed.step(1.0 / rate);
    }
    bed
}

#[test]
fn a_hung_cloth_rests_in_the_same_place_at_any_rate() {
    for method in STABLE {
        let reference = hung(method, 60.0, 16);
        for (rate, substeps) in [(30.0, 16), (60.0, 8), (60.0, 32), (144.0, 8)] {
            let distance = rms(&hung(method, rate, substeps).particles, &reference.particles);
            println!("{method:?}, {rate} Hz, {substeps} substeps: {distance} m");
            assert!(distance < 0.01, "{method:?}, {rate} Hz, {substeps} substeps: {distance} m");
        }
    }
}

#[test]
fn strands_rest_in_the_same_place_with_few_substeps_as_with_many() {
    let reference = hung(Method::Strands, 60.0, 16);
    for substeps in [1, 2, 4] {
        let distance = rms(&hung(Method::Strands, 60.0, substeps).particles, &reference.particles);
        println!("{substeps} substeps: {distance} m");
        assert!(distance < 0.01, "{substeps} substeps: {distance} m");
    }
}

#[test]
fn a_step_of_ten_seconds_is_cut_down_and_stays_finite() {
    for method in STABLE {
        let mut bed = hung(method, 60.0, 8);
        for _ in 0..20 {
            bed.step(10.0);
        }
        assert!(bed.particles.is_finite() && bed.fastest() < 20.0, "{method:?}: {} m/s", bed.fastest());
    }
}

#[test]
fn a_step_of_no_time_does_nothing() {
    for method in STABLE {
        let mut bed = hung(method, 60.0, 8);
        let before = bed.particles.clone();
        for dt in [0.0, -1.0, f32::NAN] {
            bed.step(dt);
            assert_eq!(bed.particles, before);
        }
    }
}
