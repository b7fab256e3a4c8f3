//! A step doesn't allocate, and a cloth keeps little.

use bevy::{math::Vec3A, prelude::*};
use bevy_drape::solver::Particles;
use bevy_drape::{
    build,
    prelude::{ClothGrid, ClothGrip, ClothSprings},
};

use crate::{
    bench_bed::{ALL, Bed, springs_in_air},
    grabs::hand,
    lattices::hexagons,
};

#[test]
fn a_step_allocates_nothing_once_it_has_run() {
    let plain = ClothSprings::default();
    let damped = ClothSprings { structural_damping: 0.01, shear_damping: 0.01, ..plain.clone() };
    let materials = [plain, damped].map(springs_in_air);
    for (method, material) in ALL.into_iter().flat_map(|method| materials.map(|material| (method, material))) {
        let sheets = [Mesh::from(ClothGrid::new(1.0, 1.0, 24, 24).lying()), hexagons(24).scaled_by(Vec3::splat(0.04))];
        for sheet in sheets {
            let bed = Bed::new(sheet, material).pinned([0, 23]).tethered(&[0, 23]).with_levels();
            let mut bed = Bed { method, ..bed };
            bed.grabs = vec![hand(&bed, 100, [0.2, 0.3, 0.5], ClothGrip::default())];
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

#[test]
fn a_grid_keeps_at_most_120_bytes_a_particle() {
    let material = springs_in_air(ClothSprings::default());
    let topology = Bed::new(Mesh::from(ClothGrid::new(1.0, 1.0, 64, 64).lying()), material).topology;
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
