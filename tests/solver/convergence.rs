//! Two solvers, one set of constants: both come to the same motion as their steps shrink.

use bevy::math::ops;
use bevy_drape::{prelude::Fabric, solver::Method};

use crate::bench_bed::{Bed, bare, rms};

/// The standard cloth, rippled and held by two corners.
fn held(method: Method) -> Bed {
    let n = 32;
    let mut bed = Bed { method, ..Bed::lying(n, bare(Fabric::default())).pinned([0, n - 1]) };
    for position in &mut bed.particles.position {
        let wave = |x: f32| ops::sin(core::f32::consts::TAU * x);
        position.y = 0.001 * wave(position.x) * wave(position.z + 0.25);
    }
    bed
}

/// The same 0.5 s after it was let go.
fn swung(method: Method, refine: u32) -> Bed {
    let mut bed = Bed { substeps: 8 * refine, ..held(method) };
    bed.run(0.5);
    bed
}

#[test]
fn xpbd_comes_to_the_motion_of_the_explicit_solver_as_its_steps_shrink() {
    let truth = swung(Method::Explicit, 1);
    // Finer steps than the last gain nothing in f32: what they move by is lost in rounding.
    let errors = [1, 4, 16].map(|refine| rms(&swung(Method::Xpbd, refine).particles, &truth.particles));
    println!("RMS at 0.5 s with 8, 32, 128 substeps: {errors:?} m");
    assert!(errors.array_windows().all(|[coarse, fine]| *coarse > 3.0 * fine), "{errors:?}");
    assert!(errors[2] < 0.006, "{errors:?}");
}

#[test]
fn the_explicit_solver_is_its_own_limit() {
    // Half of its own step: the answer moves by less than what XPBD is measured against.
    let coarse = swung(Method::Explicit, 1);
    let own_substeps = held(Method::Explicit).step(1.0 / 60.0).substeps;
    let steps = 2 * own_substeps;
    let mut fine = held(Method::Explicit);
    for _ in 0..30 * steps {
        let report = fine.step(1.0 / (60 * steps) as f32);
        assert_eq!(report.substeps, 1);
    }
    let error = rms(&coarse.particles, &fine.particles);
    assert!(error < 0.003, "{error} m");
}
