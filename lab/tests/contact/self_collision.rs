//! Cloth that meets itself and other cloth.
//!
//! Nothing passes through anything, with [`ENOUGH`] substeps and with as many as the strain asks for, which is what the lab does where
//! nothing is said.

use bevy_drape::solver::Method;
use drape_lab::scene::{Scene, Settings, fold, layers, ribbon, storm, twist};

use crate::experiments::{bits_after, self_colliding, watch};

/// Substeps of a frame that are more than the strain asks for.
const ENOUGH: u32 = 32;

/// Share of the triangles that may pass through others while things move.
const WANTED: f32 = 0.001;

fn with_enough(n: u32, frames: u32) -> Settings {
    Settings { substeps: Some(ENOUGH), ..self_colliding(n, frames) }
}

/// Expects a scene to end with no two triangles that pass through each other, of which at most the share `moving` did before,
/// and with no place deeper in an obstacle than `depth`, m, at any time.
#[track_caller]
fn assert_untangled(scene: Scene, moving: f32, depth: f32) {
    let watched = watch(scene);
    assert_eq!(watched.end.intersecting_pairs, 0, "{watched:?}");
    assert!(watched.worst_share <= moving, "{watched:?}");
    assert!(watched.worst.penetration <= depth, "{watched:?}");
}

#[test]
fn a_cloth_that_falls_into_folds_does_not_pass_through_itself() {
    assert_untangled(fold::fold(&self_colliding(16, 240)).unwrap(), 0.0, 1e-3);
}

#[test]
fn a_ribbon_that_falls_into_a_pile_ends_without_tangles() {
    assert_untangled(ribbon::ribbon(&with_enough(32, 240)).unwrap(), WANTED, 1e-4);
    assert_untangled(ribbon::ribbon(&self_colliding(32, 300)).unwrap(), WANTED, 1e-3);
}

#[test]
fn a_strip_that_is_twisted_and_turned_back_ends_as_it_began() {
    assert_untangled(twist::twist(&with_enough(32, 300)).unwrap(), WANTED, 0.0);
    assert_untangled(twist::twist(&self_colliding(32, 300)).unwrap(), WANTED, 0.0);
}

#[test]
fn a_strip_that_is_twisted_into_a_tight_rope_does_not_pass_through_itself() {
    // Pairs that are solved once a substep are pulled through each other, with some numbers of substeps and not with others.
    for (substeps, frames) in [(28, 300), (31, 300), (34, 240), (36, 240)] {
        let settings = Settings { substeps: Some(substeps), ..self_colliding(32, frames) };
        assert_untangled(twist::twist(&settings).unwrap(), WANTED, 0.0);
    }
}

#[test]
fn three_cloths_that_fall_on_each_other_keep_their_order() {
    let order = |settings: &Settings| {
        let watched = watch(layers::layers(settings).unwrap());
        assert_eq!((watched.end.intersecting_pairs, watched.end.fault), (0, 0.0), "{watched:?}");
        assert!(watched.worst_share <= WANTED && watched.worst.fault == 0.0, "{watched:?}");
        assert!(watched.worst.penetration <= 1e-3, "{watched:?}");
    };
    order(&with_enough(12, 120));
    order(&self_colliding(12, 150));
}

#[test]
fn a_flag_in_a_storm_does_not_pass_through_itself() {
    assert_untangled(storm::storm(&self_colliding(16, 300)).unwrap(), WANTED, 0.0);
}

#[test]
fn the_other_method_keeps_its_folds_apart_too() {
    let settings = Settings { method: Method::Xpbd, substeps: Some(ENOUGH), ..self_colliding(16, 180) };
    assert_untangled(fold::fold(&settings).unwrap(), WANTED, 1e-3);
    assert_untangled(ribbon::ribbon(&Settings { n: 32, ..settings }).unwrap(), WANTED, 1e-3);
}

#[test]
fn what_happens_does_not_depend_on_what_the_scratch_was_used_for() {
    type Make = fn(&Settings) -> std::io::Result<Scene>;
    let scenes: [(&str, Make, u32); 5] = [
        ("fold", fold::fold, 16),
        ("ribbon", ribbon::ribbon, 24),
        ("twist", twist::twist, 24),
        ("layers", layers::layers, 10),
        ("storm", storm::storm, 12),
    ];
    // Something that has touched, of another size.
    let mut other = fold::fold(&self_colliding(20, 60)).unwrap();
    bits_after(&mut other, 40);
    for (name, make, n) in scenes {
        let made = || make(&self_colliding(n, 60)).unwrap();
        let first = bits_after(&mut made(), 60);
        assert_eq!(first, bits_after(&mut made(), 60), "{name}: a second time");
        let mut after = made();
        after.cloths.iter_mut().for_each(|cloth| cloth.scratch.clone_from(&other.cloths[0].scratch));
        assert_eq!(first, bits_after(&mut after, 60), "{name}: with a scratch that something else was in");
    }
}
