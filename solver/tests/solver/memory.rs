//! A step doesn't allocate, and a cloth keeps little.

use bevy_math::Vec3A;
use drape_solver::{Member, Particles, Scratch, build, step, step_together};

use crate::{
    bench_bed::{ALL, Bed, STABLE, together},
    fixtures::{
        hand::{Grip, hand},
        material::{Springs, springs_in_air},
        mesh::{Grid, shaped},
    },
    lattices::hexagons,
    stages::{self, Stage},
};

#[test]
fn a_step_allocates_nothing_once_it_has_run() {
    let plain = Springs::default();
    let damped = Springs { structural_damping: 0.01, shear_damping: 0.01, ..plain.clone() };
    let materials = [plain, damped].map(springs_in_air);
    for (method, material) in ALL.into_iter().flat_map(|method| materials.map(|material| (method, material))) {
        let sheets = [Grid::new(1.0, 1.0, 24, 24).lying().into(), shaped(hexagons(24), |p| 0.04 * p)];
        for sheet in sheets {
            let bed = Bed::new(sheet, material).pinned([0, 23]).tethered(&[0, 23]).with_levels();
            let mut bed = Bed { method, ..bed };
            bed.grabs = vec![hand(&bed, 100, [0.2, 0.3, 0.5], Grip::default())];
            bed.step(1.0 / 60.0);
            let info = allocation_counter::measure(|| {
                for _ in 0..10 {
                    bed.step(1.0 / 60.0);
                }
            });
            assert_eq!(info.count_total, 0, "{method:?}: {info:?}");
        }
    }
}

/// What `act` allocates in each frame of what is made, with working memory that has seen the same before.
fn allocations(make: &dyn Fn() -> Stage, act: impl Fn(&mut [Member])) -> Vec<u64> {
    const FRAMES: u32 = 120;
    let mut before = make();
    for frame in 0..FRAMES {
        before.frame(frame, &act);
    }
    let mut again = make();
    for (bed, used) in again.beds.iter_mut().zip(&before.beds) {
        // With the first look at a surface, its tree is made.
        bed.topology = used.topology.clone();
    }
    // Stages move bodies by the impulses that memory has of the step before. Both runs begin without any, so memory that has been
    // used comes in once the first frame has moved them.
    let mut used: Vec<Scratch> = before.beds.into_iter().map(|bed| bed.scratch).collect();
    let mut count = |members: &mut [Member]| {
        for (member, used) in members.iter_mut().zip(used.drain(..)) {
            *member.scratch = used;
        }
        allocation_counter::measure(|| act(members)).count_total
    };
    (0..FRAMES).map(|frame| again.frame(frame, &mut count)).collect()
}

/// Steps each cloth by itself.
fn alone(members: &mut [Member]) {
    for Member { particles, topology, ctx, scratch, .. } in members {
        step(particles, topology, ctx, scratch);
    }
}

#[test]
fn what_touches_allocates_nothing_once_it_has_happened() {
    let mut cases: Vec<(String, Box<dyn Fn() -> Stage>)> =
        vec![("irregular triangles on obstacles".into(), Box::new(stages::fallen_triangles))];
    for method in ALL {
        cases.push((format!("{method:?} on obstacles"), Box::new(move || stages::fallen_grid(method))));
    }
    for method in STABLE {
        cases.push((format!("{method:?} on a body"), Box::new(move || stages::swinging(method))));
        cases.push((format!("{method:?} in folds"), Box::new(move || stages::folded(method))));
    }
    for (name, make) in &cases {
        let allocated = allocations(make, alone);
        assert!(allocated.iter().all(|&count| count == 0), "{name}: {allocated:?}");
    }
}

#[test]
fn cloths_that_touch_each_other_allocate_no_more_than_those_that_do_not() {
    for method in STABLE {
        let touching = allocations(&|| stages::swinging(method), step_together);
        // Lists of the members, whatever these do.
        let mut apart =
            [Bed::lying(2, springs_in_air(Springs::default())), Bed::lying(2, springs_in_air(Springs::default()))];
        let lists = together(&mut apart, 1.0 / 60.0, |members| {
            step_together(members);
            allocation_counter::measure(|| step_together(members)).count_total
        });
        assert!(touching.iter().all(|&count| count == lists), "{method:?}: {touching:?} for {lists}");
    }
}

#[test]
fn a_grid_keeps_at_most_120_bytes_a_particle() {
    let material = springs_in_air(Springs::default());
    let topology = Bed::lying(64, material).topology;
    let info = allocation_counter::measure(|| {
        let rest: Vec<Vec3A> = topology.rest.iter().copied().map(Vec3A::from).collect();
        // Where it was when the step began is kept for drawing.
        let step_start = rest.clone();
        let particles = Particles::at_rest(rest, &topology, &material);
        core::mem::forget((step_start, particles));
    });
    let pins = [0, 63];
    let tethers = allocation_counter::measure(|| core::mem::forget(build::tethers(&topology, &pins)));
    let bytes = (info.bytes_current + tethers.bytes_current) as f32 / topology.particle_count() as f32;
    println!("{bytes} bytes a particle");
    assert!((80.0..=120.0).contains(&bytes));
}
