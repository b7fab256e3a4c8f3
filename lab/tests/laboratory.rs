//! What a textile laboratory would measure, at sizes that take seconds: the experiments are the lab's own.

use drape_lab::laboratory::{Curve, EXPERIMENTS, Extent, Measurement, Outcome};

/// Makes an experiment and looks at all that has a tolerance.
fn assert_on_paper(name: &str) {
    assert_to(Extent::Brief, name);
}

fn assert_to(extent: Extent, name: &str) {
    let experiment = EXPERIMENTS.iter().find(|experiment| experiment.name == name).expect("an experiment");
    let Outcome { measurements, curves } = (experiment.run)(extent);
    assert_within_tolerance(&measurements);
    assert_drawable(&curves);
}

fn assert_within_tolerance(measurements: &[Measurement]) {
    assert!(measurements.iter().any(|measurement| measurement.is_ok().is_some()));
    let misses = measurements.iter().filter(|measurement| measurement.is_ok() == Some(false));
    let misses: Vec<String> = misses.map(ToString::to_string).collect();
    assert!(misses.is_empty(), "{misses:#?}");
    assert!(measurements.iter().all(|measurement| measurement.json()["experiment"].is_string()));
}

fn assert_drawable(curves: &[Curve]) {
    for curve in curves {
        let is_finite = curve.points.as_flattened().iter().all(|value| value.is_finite());
        assert!(is_finite && !curve.points.is_empty(), "{}: {}", curve.plot, curve.series);
        assert!(curve.names.is_empty() || curve.names.len() == curve.points.len());
        let has_cloth = curves.iter().any(|other| other.plot == curve.plot && !other.is_expected);
        assert!(has_cloth, "nothing is compared with {}", curve.series);
    }
}

#[test]
fn a_free_cloth_falls_as_everything_does_and_keeps_its_momentum() {
    assert_on_paper("free-fall");
}

#[test]
fn a_small_swing_takes_the_time_of_a_pendulum_and_of_a_heavy_chain() {
    assert_on_paper("pendulum");
}

#[test]
fn a_swinging_cloth_loses_little_of_its_energy_and_gains_none() {
    assert_on_paper("energy");
}

#[test]
fn a_strip_that_is_pulled_gets_longer_by_force_over_stiffness_and_width() {
    assert_on_paper("pull");
}

#[test]
fn a_square_in_a_shear_frame_gives_its_modulus_back() {
    assert_on_paper("shear");
}

#[test]
fn a_strip_that_hangs_from_both_ends_takes_the_catenary() {
    assert_on_paper("catenary");
}

#[test]
fn a_strip_over_an_edge_bends_as_the_elastica_of_its_rigidity() {
    assert_on_paper("cantilever");
}

#[test]
fn a_disc_drapes_as_stiffly_as_it_bends() {
    assert_on_paper("cusick");
}

#[test]
fn a_sheet_that_falls_flat_reaches_its_terminal_speed() {
    assert_on_paper("terminal-speed");
}

#[test]
fn a_cloth_slides_from_the_angle_of_its_friction_on() {
    assert_on_paper("slope");
}

#[test]
fn frames_change_no_bit() {
    assert_on_paper("frame-rates");
}

#[test]
fn a_hung_cloth_rests_in_the_same_place_at_any_step() {
    assert_on_paper("step-rates");
}

#[test]
#[ignore = "takes minutes; the lab writes the same to docs/fidelity.md"]
fn all_that_the_lab_measures_is_on_paper() {
    EXPERIMENTS.iter().for_each(|experiment| assert_to(Extent::Full, experiment.name));
}
