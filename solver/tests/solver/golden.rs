//! The bits of some scenes after five seconds are those that they have always had: the net under changes that are to move
//! nothing.
//!
//! They are the same with any instructions and with any number of threads, and are meant to be so on any machine: see
//! [`stages`]. A change that is meant to move cloth otherwise replaces the constants by those that the failures print.

use std::sync::Arc;

use bevy_tasks::TaskPoolBuilder;
use drape_solver::{SimdLevel, step_together};

use crate::{
    bench_bed::{ALL, STABLE, bits, digest},
    stages::{self, Stage},
};

/// Springs by each method, a sheet, springs on a large cloth that threads share.
const GRID: [u64; 5] =
    [0x2c9e9c7a555eabbc, 0xb328fb10c97ec5f2, 0xa25ba02562469120, 0xd6cfd8929c9d7095, 0x14edcfbf413adc8a];

/// Springs by each method, threads of springs, faces.
const IRREGULAR: [u64; 5] =
    [0xaeb0a88e1bf1d3ab, 0xed3d55c3007821a8, 0xd07060e257fc7548, 0x6036f3f2086341bb, 0xbf6ef42e534b9262];

/// Faces that bend.
const BENT: [u64; 1] = [0x0a147195f5e25ce5];

/// A grid by each method, irregular triangles.
const CONTACT: [u64; 4] = [0x41c38947138fd2cb, 0xf0529a38e4bbc032, 0xcc7fb1ef65bdb53b, 0xe4d07bf40747a555];

/// Triangles by both methods, particles as balls.
const SELF_COLLISION: [u64; 2] = [0x24259194ef0dcb43, 0xc4dde1f3371c134f];

/// By both methods.
const MOVING_BODY: [u64; 2] = [0x0e3864214803d28d, 0xd4eb7442f8be9bf5];

const FRAMES: u32 = 300;

/// Stands for the bits of all cloths of a stage after five seconds.
fn end(mut stage: Stage, simd_level: SimdLevel, helpers: Option<usize>) -> u64 {
    let pool = helpers.map(|count| Arc::new(TaskPoolBuilder::new().num_threads(count).build()));
    for bed in &mut stage.beds {
        bed.scratch.simd_level = simd_level;
        bed.pool.clone_from(&pool);
    }
    for frame in 0..FRAMES {
        stage.frame(frame, step_together);
    }
    assert!(stage.beds.iter().all(|bed| bed.particles.is_finite()), "nothing can be compared");
    digest(stage.beds.iter().flat_map(|bed| bits(&bed.particles)))
}

/// Expects what is made to end as the constant called `name` says.
#[track_caller]
fn assert_golden<const N: usize>(name: &str, golden: [u64; N], make: [&dyn Fn() -> Stage; N]) {
    let found = make.map(|make| {
        let alone = end(make(), SimdLevel::Best, None);
        assert_eq!(alone, end(make(), SimdLevel::Baseline, None), "{name}: SIMD levels make a difference");
        assert_eq!(alone, end(make(), SimdLevel::Best, Some(2)), "{name}: threads make a difference");
        alone
    });
    let list: Vec<String> = found.iter().map(|hash| format!("{hash:#018x}")).collect();
    assert!(
        found == golden,
        "cloth moves otherwise than it did. If that is meant, bless it: in {}, write\n\
         const {name}: [u64; {N}] = [{}];\n\
         If it isn't, look for what the change did beside what it is for.",
        file!(),
        list.join(", ")
    );
}

#[test]
fn a_grid_in_the_wind_moves_as_it_always_did() {
    let [strands, xpbd, explicit] = ALL.map(|method| move || stages::grid(method));
    assert_golden("GRID", GRID, [&strands, &xpbd, &explicit, &stages::sheet, &stages::large]);
}

#[test]
fn irregular_triangles_in_the_wind_move_as_they_always_did() {
    let [strands, xpbd, explicit] = ALL.map(|method| move || stages::irregular(method));
    assert_golden("IRREGULAR", IRREGULAR, [&strands, &xpbd, &explicit, &stages::threads, &stages::faces]);
}

#[test]
fn irregular_triangles_that_bend_move_as_they_always_did() {
    assert_golden("BENT", BENT, [&stages::bent]);
}

#[test]
fn a_cloth_on_obstacles_moves_as_it_always_did() {
    let [strands, xpbd, explicit] = ALL.map(|method| move || stages::fallen_grid(method));
    assert_golden("CONTACT", CONTACT, [&strands, &xpbd, &explicit, &stages::fallen_triangles]);
}

#[test]
fn a_cloth_that_falls_into_folds_moves_as_it_always_did() {
    let [strands, xpbd] = STABLE.map(|method| move || stages::folded(method));
    assert_golden("SELF_COLLISION", SELF_COLLISION, [&strands, &xpbd]);
}

#[test]
fn two_cloths_on_a_moving_body_move_as_they_always_did() {
    let [strands, xpbd] = STABLE.map(|method| move || stages::swinging(method));
    assert_golden("MOVING_BODY", MOVING_BODY, [&strands, &xpbd]);
}
