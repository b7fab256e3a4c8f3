//! The result doesn't hang on the time step or the number of substeps more than a game would notice.

use bevy_drape::{build, prelude::Fabric};

use crate::bench_bed::{Bed, rms};

/// A cloth hung by two corners, after it has come to rest.
fn hung(rate: f32, substeps: u32) -> Bed {
    let fabric = Fabric { damping: 3.0, ..Fabric::default() };
    let mut bed = Bed::lying(16, fabric.material().unwrap()).pinned([0, 15]);
    bed.tethers = build::tethers(&bed.topology, &[0, 15]);
    bed.substeps = substeps;
    for _ in 0..(8.0 * rate) as u32 {
        bed.step(1.0 / rate);
    }
    bed
}

#[test]
fn a_hung_cloth_rests_in_the_same_place_at_any_rate() {
    let reference = hung(60.0, 16);
    for (rate, substeps) in [(30.0, 16), (60.0, 8), (60.0, 32), (144.0, 8)] {
        let distance = rms(&hung(rate, substeps).particles, &reference.particles);
        assert!(distance < 0.01, "{rate} Hz, {substeps} substeps: {distance} m");
    }
}

#[test]
fn a_step_of_ten_seconds_is_cut_down_and_stays_finite() {
    let mut bed = hung(60.0, 8);
    for _ in 0..20 {
        bed.step(10.0);
    }
    assert!(bed.particles.is_finite() && bed.fastest() < 20.0, "{} m/s", bed.fastest());
}

#[test]
fn a_step_of_no_time_does_nothing() {
    let mut bed = hung(60.0, 8);
    let before = bed.particles.clone();
    for dt in [0.0, -1.0, f32::NAN] {
        bed.step(dt);
        assert_eq!(bed.particles, before);
    }
}
