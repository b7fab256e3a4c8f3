//! Whatever is thrown at it, the default solver stays finite and settles.

use bevy::{math::Vec3A, prelude::*};
use bevy_drape::{
    build,
    prelude::{ClothGrid, Fabric},
    solver::{Method, SpringKind, constraint::spring::strain},
};
use proptest::prelude::*;

use crate::bench_bed::Bed;

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..default() })]

    #[test]
    fn random_starts_stiffness_and_steps_stay_finite(
        places in prop::collection::vec(prop::array::uniform3(-1.0_f32..1.0), 64),
        exponents in prop::array::uniform3(-2.0_f32..7.0),
        damping in 0.0_f32..10.0,
        density in 0.01_f32..2.0,
        substeps in 1_u32..20,
        dt in 0.001_f32..0.2,
        explicit in any::<bool>(),
    ) {
        let stiffness = exponents.map(|e| bevy::math::ops::powf(10.0, e));
        let fabric = Fabric {
            density,
            structural_stiffness: stiffness[0],
            shear_stiffness: stiffness[1],
            bend_stiffness: stiffness[2],
            structural_damping: damping,
            bend_damping: damping,
            ..Fabric::default()
        };
        let mut bed = Bed::new(ClothGrid::new(1.0, 1.0, 8, 8), fabric.material().unwrap()).pinned([0, 7]);
        bed.tethers = build::tethers(&bed.topology, &[0, 7]);
        bed.substeps = substeps;
        bed.max_substeps = 200;
        bed.method = if explicit { Method::Explicit } else { Method::Xpbd };
        for (position, place) in bed.particles.position.iter_mut().zip(places).skip(8) {
            // The explicit solver is stable around the rest shape; only XPBD is anywhere.
            *position = if explicit { *position + Vec3A::from(place) * 0.03 } else { Vec3A::from(place) };
        }
        for _ in 0..40 {
            bed.step(dt);
            prop_assert!(bed.particles.is_finite());
        }
    }
}

#[test]
fn a_corner_jerked_by_a_metre_does_not_explode_the_cloth() {
    let mut bed = Bed::lying(24, Fabric::default().material().unwrap()).pinned([0, 23]);
    bed.tethers = build::tethers(&bed.topology, &[0, 23]);
    bed.run(1.0);
    bed.anchors[1].end += Vec3A::new(-0.5, 0.5, 0.7);
    bed.step(1.0 / 60.0);
    bed.anchors[1].start = bed.anchors[1].end;
    bed.run(2.0);
    assert!(bed.particles.is_finite() && bed.fastest() < 10.0, "{} m/s", bed.fastest());
}

#[test]
fn a_cloth_crushed_to_a_point_opens_again() {
    let mut bed = Bed::lying(12, Fabric::default().material().unwrap()).pinned([0]);
    let corner = bed.particles.position[0];
    bed.particles.position.fill(corner);
    bed.particles.position.iter_mut().enumerate().for_each(|(i, p)| p.x += 1e-5 * i as f32);
    bed.anchors[0].end = bed.anchors[0].start;
    bed.run(3.0);
    assert!(bed.particles.is_finite());
    let structural = bed.topology.springs_of(SpringKind::Structural);
    let strains: Vec<f32> = structural.map(|spring| strain(&bed.particles.position, spring).max(0.0)).collect();
    let mean = strains.iter().sum::<f32>() / strains.len() as f32;
    assert!(mean < 0.1, "a mean stretch of {mean}");
}
