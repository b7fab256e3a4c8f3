//! The same input gives the same bits.

use bevy::{math::Vec3A, prelude::*};
use bevy_drape::{
    build,
    prelude::Fabric,
    solver::{ColliderShape, Method, Obstacle},
};

use crate::bench_bed::{Bed, bits};

fn scene(method: Method) -> Bed {
    let mut bed = Bed { method, ..Bed::lying(16, Fabric::default().material().unwrap()).pinned([0, 15]) };
    bed.tethers = build::tethers(&bed.topology, &[0, 15]);
    let pose = bevy::math::Isometry3d::from_translation(Vec3::new(0.0, -0.5, -0.3));
    bed.obstacles =
        vec![Obstacle { shape: ColliderShape::Sphere(Sphere::new(0.2)), start: pose, end: pose, friction: 1.0 }];
    bed.particles.force[200] = Vec3A::new(0.01, 0.02, 0.0);
    bed
}

#[test]
fn two_runs_give_the_same_bits() {
    for method in [Method::Xpbd, Method::Explicit] {
        let (mut a, mut b) = (scene(method), scene(method));
        a.run(1.0);
        b.run(1.0);
        assert_eq!(bits(&a.particles), bits(&b.particles), "{method:?}");
    }
}

#[test]
fn scratch_carries_nothing_from_one_cloth_to_another() {
    let (mut a, mut b) = (scene(Method::Explicit), scene(Method::Explicit));
    a.run(0.2);
    let mut larger = Bed::lying(30, Fabric::default().material().unwrap());
    larger.run(0.5);
    core::mem::swap(&mut b.scratch, &mut larger.scratch);
    b.run(0.2);
    assert_eq!(bits(&a.particles), bits(&b.particles));
}
