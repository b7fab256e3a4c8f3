//! Three solvers, one set of constants: all come to the same motion as their steps shrink.

use bevy_math::ops;
use drape_solver::Method;

use crate::{
    bench_bed::{Bed, STABLE, rms},
    fixtures::material::{Springs, springs},
};

/// The standard cloth, rippled and held by two corners.
fn held(method: Method) -> Bed {
    let n = 32;
    let mut bed = Bed { method, ..Bed::lying(n, springs(Springs::default())).pinned([0, n - 1]) };
    for position in &mut bed.particles.position {
        let wave = |x: f32| ops::sin(core::f32::consts::TAU * x);
        position.y = 0.001 * wave(position.x) * wave(position.z + 0.25);
    }
    bed
}

/// 0.5 s after it was let go, in so many substeps.
fn swung(method: Method, substeps: u32) -> Bed {
    let mut bed = held(method).with_substeps(substeps);
    bed.run(0.5);
    bed
}

/// Distances from the explicit solver's motion with so many substeps, m.
fn errors<const N: usize>(method: Method, substeps: [u32; N]) -> [f32; N] {
    let truth = swung(Method::Explicit, 1);
    let errors = substeps.map(|substeps| rms(&swung(method, substeps).particles, &truth.particles));
    println!("{method:?} at 0.5 s with {substeps:?} substeps: RMS {errors:?} m");
    errors
}

#[test]
fn xpbd_and_strands_come_to_the_motion_of_the_explicit_solver_as_their_steps_shrink() {
    for method in STABLE {
        // Finer steps than the last gain nothing in f32: what they move by is lost in rounding.
        let errors = errors(method, [8, 32, 128]);
        // Strands are near the limit of f32 with 32 substeps already.
        let gain = if method == Method::Strands { 1.5 } else { 3.0 };
        assert!(errors.array_windows().all(|[coarse, fine]| *coarse > gain * fine), "{method:?}: {errors:?}");
        assert!(errors[2] < 0.006, "{method:?}: {errors:?}");
    }
}

#[test]
fn strands_come_closer_with_every_more_substep() {
    let errors = errors(Method::Strands, [1, 2, 4, 8, 16, 32]);
    assert!(errors.array_windows().all(|[coarse, fine]| coarse > fine), "{errors:?}");
}

#[test]
fn the_explicit_solver_is_its_own_limit() {
    // Half of its own step: the answer moves by less than what the others are measured against.
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
