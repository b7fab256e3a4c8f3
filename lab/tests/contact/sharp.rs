//! What is sharp, thin, or fast, and cloth: the lab's experiments at sizes that take seconds.
//!
//! No particle is ever inside of anything. What passes between particles depends on the substeps: with as many as the strain
//! asks for, cells of centimetres let a tip or a small ball through; the tests say how many substeps keep it out.

use std::io;

use drape_lab::scene::{
    Scene, Settings, bullet, drape,
    needle::{self, Sharp},
};

use crate::experiments::{Watched, alone, bits_after, watch};

/// The deepest that a particle may be in an obstacle, m: what rounding makes.
const ROUNDING: f32 = 1e-6;

fn with_substeps(substeps: u32, n: u32, frames: u32) -> Settings {
    Settings { substeps: Some(substeps), ..alone(n, frames) }
}

/// Watches a scene of which no particle may be inside of anything.
#[track_caller]
fn watch_outside(scene: io::Result<Scene>) -> Watched {
    let watched = watch(scene.unwrap());
    assert!(watched.worst.particle_penetration <= ROUNDING, "{watched:?}");
    watched
}

fn lying(settings: &Settings) -> io::Result<Scene> {
    let cloth = settings.cloth(&settings.grid(1.0, 1.0).lying().into())?;
    Ok(drape::on_ball(settings, [drape::raised(cloth)]))
}

#[test]
fn a_cloth_on_a_ball_keeps_its_triangles_out_of_it() {
    for n in [12, 24] {
        let watched = watch_outside(lying(&alone(n, 180)));
        // Between particles, a triangle may sink in by half a millimetre.
        assert!(watched.worst.penetration <= 6e-4, "{watched:?}");
        assert!(watched.end.max_speed < 0.2 && watched.end.intersecting_pairs == 0, "{watched:?}");
    }
}

#[test]
fn a_cloth_on_a_ball_of_twenty_thousand_triangles_keeps_its_triangles_out_of_it() {
    for is_closed in [true, false] {
        let settings = with_substeps(16, 12, 90);
        let cloth = settings.cloth(&settings.grid(1.0, 1.0).lying().into()).unwrap();
        let watched = watch_outside(drape::on_mesh(&settings, drape::raised(cloth), is_closed));
        assert!(watched.worst.penetration <= 6e-4, "closed: {is_closed}, {watched:?}");
    }
}

#[test]
fn what_is_sharp_comes_through_no_triangle_with_substeps_enough() {
    // Around its tip a cone's side sinks in by some millimetres: 2.6 were measured.
    for (sharp, substeps, depth) in [(Sharp::Needle, 32, 1e-3), (Sharp::Corner, 32, 1e-3), (Sharp::Cone, 64, 6e-3)] {
        let watched = watch_outside(needle::needle(&with_substeps(substeps, 16, 120), sharp));
        assert_eq!(watched.worst.fault, 0.0, "{sharp:?}: {watched:?}");
        assert!(watched.worst.penetration <= depth, "{sharp:?}: {watched:?}");
    }
}

#[test]
fn what_is_sharp_comes_through_no_triangle_by_default() {
    for sharp in [Sharp::Needle, Sharp::Corner, Sharp::Cone] {
        let watched = watch_outside(needle::needle(&alone(16, 120), sharp));
        assert_eq!(watched.worst.fault, 0.0, "{sharp:?}: {watched:?}");
    }
}

#[test]
fn what_is_sharp_harms_nothing_where_it_comes_through() {
    for sharp in [Sharp::Needle, Sharp::Corner, Sharp::Cone] {
        let watched = watch_outside(needle::needle(&alone(16, 150), sharp));
        // It hangs on it and comes to rest, though a cone stands out of it by 5 cm.
        assert!(watched.end.max_speed < 1.0, "{sharp:?}: {watched:?}");
        assert!(watched.worst.penetration <= 0.06, "{sharp:?}: {watched:?}");
    }
}

#[test]
fn balls_at_thirty_metres_a_second_are_caught() {
    for radius in [0.02, 0.005] {
        for settings in [alone(16, 60), with_substeps(64, 16, 60)] {
            let watched = watch_outside(bullet::ball(&settings, radius));
            assert_eq!(watched.worst.fault, 0.0, "{radius} m: {watched:?}");
            assert!(watched.worst.penetration <= 1e-3, "{radius} m: {watched:?}");
        }
    }
}

#[test]
fn a_ball_at_thirty_metres_a_second_is_caught_by_cells_that_it_stretches_to_more_than_its_width() {
    // Without a margin, and with that of a `Cloth`.
    for (n, margin) in [(64, 0.0), (72, 0.0), (48, 0.005), (64, 0.005)] {
        let watched = watch_outside(bullet::ball(&Settings { margin, ..alone(n, 60) }, 0.02));
        assert_eq!(watched.worst.fault, 0.0, "{n}, {margin} m: {watched:?}");
        assert!(watched.worst.penetration <= 0.01, "{n}, {margin} m: {watched:?}");
    }
}

#[test]
fn a_cloth_at_thirty_metres_a_second_does_not_pass_a_wall_of_four_millimetres() {
    for n in [12, 24] {
        for settings in [alone(n, 60), with_substeps(8, n, 60), with_substeps(32, n, 60), with_substeps(64, n, 60)] {
            let watched = watch_outside(bullet::wall(&settings));
            assert_eq!(watched.worst.fault, 0.0, "{n}: {watched:?}");
            // A triangle of which a corner is under its foot is in the middle of it.
            assert!(watched.worst.penetration <= 2e-3, "{n}: {watched:?}");
        }
    }
}

#[test]
fn a_cloth_at_thirty_metres_a_second_wraps_around_a_ball() {
    let watched = watch_outside(bullet::post(&with_substeps(64, 16, 60), 0.1));
    assert!(watched.worst.penetration <= 1e-3, "{watched:?}");
    // As many as the strain asks for before it hits: 2 cm deep and stretched to more than three times its length.
    let watched = watch_outside(bullet::post(&alone(16, 60), 0.1));
    assert!(watched.worst.penetration <= 0.05 && watched.end.max_strain < 0.2, "{watched:?}");
}

#[test]
fn what_happens_does_not_depend_on_what_the_scratch_was_used_for() {
    let scenes: [(&str, &dyn Fn(&Settings) -> io::Result<Scene>); 5] = [
        ("drape", &lying),
        ("needle", &|settings| needle::needle(settings, Sharp::Needle)),
        ("corner", &|settings| needle::needle(settings, Sharp::Corner)),
        ("ball", &|settings| bullet::ball(settings, 0.02)),
        ("wall", &bullet::wall),
    ];
    let mut other = needle::needle(&with_substeps(16, 20, 60), Sharp::Cone).unwrap();
    bits_after(&mut other, 40);
    for (name, make) in scenes {
        let made = || make(&alone(16, 60)).unwrap();
        let first = bits_after(&mut made(), 50);
        assert_eq!(first, bits_after(&mut made(), 50), "{name}: a second time");
        let mut after = made();
        after.cloths[0].scratch.clone_from(&other.cloths[0].scratch);
        assert_eq!(first, bits_after(&mut after, 50), "{name}: with a scratch that something else was in");
    }
}
