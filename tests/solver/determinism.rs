//! The same input gives the same bits.

use bevy::{math::Vec3A, prelude::*};
use bevy_drape::{
    prelude::{ClothGrid, Fabric},
    solver::{ColliderShape, Method, Obstacle},
};

use crate::bench_bed::{ALL, Bed, bits};

fn scene(method: Method) -> Bed {
    let bed = Bed::lying(18, Fabric::default().material().unwrap()).pinned([0, 17]).tethered(&[0, 17]).with_levels();
    let mut bed = Bed { method, ..bed };
    let pose = bevy::math::Isometry3d::from_translation(Vec3::new(0.0, -0.5, -0.3));
    bed.obstacles =
        vec![Obstacle { shape: ColliderShape::Sphere(Sphere::new(0.2)), start: pose, end: pose, friction: 1.0 }];
    bed.particles.force[200] = Vec3A::new(0.01, 0.02, 0.0);
    assert!(!bed.topology.levels.is_empty());
    bed
}

#[test]
fn two_runs_give_the_same_bits() {
    for method in ALL {
        let (mut a, mut b) = (scene(method), scene(method));
        a.run(1.0);
        b.run(1.0);
        assert_eq!(bits(&a.particles), bits(&b.particles), "{method:?}");
    }
}

#[test]
fn scratch_carries_nothing_from_one_cloth_to_another() {
    for method in ALL {
        // Larger with more levels, smaller without any, and without rows and columns.
        let material = Fabric { structural_damping: 0.01, ..Fabric::default() }.material().unwrap();
        let others = [
            Bed::lying(40, material).pinned([5]).tethered(&[5]).with_levels(),
            Bed::new(ClothGrid::new(1.0, 1.0, 3, 5), material).pinned([0, 2]),
            Bed::new(Sphere::new(0.3), material),
        ];
        for other in others {
            let (mut a, mut b) = (scene(method), scene(method));
            a.run(0.2);
            let mut other = Bed { method, ..other };
            other.run(0.2);
            core::mem::swap(&mut b.scratch, &mut other.scratch);
            b.run(0.2);
            assert_eq!(bits(&a.particles), bits(&b.particles), "{method:?} after {}", other.particles.len());
        }
    }
}
