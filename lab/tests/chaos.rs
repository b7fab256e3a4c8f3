//! Random scenes through the public API: a few of the many that the lab's `chaos` runs.

use drape_lab::chaos::{Options, run};

/// Options for scenes that no clock cuts short, however busy the machine is.
fn whole(seeds: core::ops::Range<u64>) -> Options {
    Options { budget: 3600.0, ..Options::of(seeds) }
}

#[test]
fn random_scenes_stay_finite_and_panic_nowhere() {
    let tally = run(&whole(0..60), |outcome| println!("{}", outcome.json()));
    assert!(!tally.has_failed(), "{}", tally.json());
}

#[test]
fn a_scene_follows_from_its_seed() {
    let fingerprints = |threads| run(&Options { threads: Some(threads), ..whole(0..12) }, |_| ()).fingerprints();
    assert_eq!(fingerprints(1), fingerprints(3));
}
