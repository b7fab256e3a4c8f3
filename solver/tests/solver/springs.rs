//! The explicit solver's own number of substeps.

use drape_solver::{Elasticity, Method};

use crate::{
    bench_bed::Bed,
    fixtures::material::{Springs, springs},
};

fn explicit(structural_stiffness: f32, max_substeps: u32) -> Bed {
    let material = springs(Springs { structural_stiffness, ..Springs::default() });
    Bed { method: Method::Explicit, max_substeps, ..Bed::lying(12, material).pinned([0, 11]) }
}

#[test]
fn substeps_grow_with_the_square_root_of_the_stiffness() {
    let soft = explicit(10_000.0, 4096).step(1.0 / 60.0).substeps as f32;
    let stiff = explicit(1_000_000.0, 4096).step(1.0 / 60.0).substeps as f32;
    assert!((9.0..10.1).contains(&(stiff / soft)), "{soft} and {stiff}");
}

#[test]
fn the_cap_softens_instead_of_exploding_and_says_so() {
    let mut bed = explicit(1e6, 32);
    let report = bed.step(1.0 / 60.0);
    assert_eq!(report.substeps, 32);
    assert!(report.stiffness_scale < 0.1, "{report:?}");
    bed.run(5.0);
    assert!(bed.particles.is_finite() && bed.fastest() < 20.0, "{} m/s", bed.fastest());
}

#[test]
fn strong_damping_is_stable_too() {
    let mut bed = explicit(5000.0, 4096);
    let Elasticity::Springs(constants) = &mut bed.material.elasticity else { panic!("they are springs") };
    constants.iter_mut().for_each(|spring| spring.damping = 5.0);
    bed.run(2.0);
    assert!(bed.particles.is_finite() && bed.fastest() < 10.0, "{} m/s", bed.fastest());
}
