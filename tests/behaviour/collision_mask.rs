//! A cloth meets the obstacles that its mask selects.

use bevy::{math::primitives::InfinitePlane3d, prelude::*};
use bevy_drape::prelude::*;

use crate::common::*;

/// Whether a falling cloth with `mask` is stopped by a ground in `layers`.
fn meets(mask: u32, layers: u32) -> bool {
    let mut app = headless();
    let ground = ClothCollider::from(InfinitePlane3d::new(Vec3::Y)).in_layers(layers);
    app.world_mut().spawn((ground, Transform::from_xyz(0.0, -0.3, 0.0)));
    let cloth = Cloth { collision_mask: mask, ..default() };
    let cloth = spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 4, 4).lying(), cloth);
    run(&mut app, 60);
    let low = positions(&app, cloth).into_iter().map(|place| place.y).fold(f32::MAX, f32::min);
    let is_stopped = low >= -0.3;
    assert_eq!(report(&app, cloth).contacts > 0, is_stopped);
    is_stopped
}

#[test]
fn one_common_bit_is_enough() {
    assert!(meets(u32::MAX, 1));
    assert!(meets(0b0110, 0b0100));
    assert!(!meets(0b0110, 0b1001));
    assert!(!meets(0, u32::MAX));
    assert!(!meets(u32::MAX, 0));
    assert!(meets(1 << 31, 1 << 31));
}

#[test]
fn the_mask_can_change_while_the_cloth_runs() {
    let mut app = headless();
    app.world_mut().spawn((ClothCollider::from(InfinitePlane3d::new(Vec3::Y)), Transform::from_xyz(0.0, -0.3, 0.0)));
    let cloth = spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 4, 4).lying(), Cloth::default());
    run(&mut app, 60);
    assert!(place(&app, cloth, 5).y > -0.3);
    get_mut::<Cloth>(&mut app, cloth).collision_mask = 0b10;
    run(&mut app, 60);
    assert!(place(&app, cloth, 5).y < -1.0);
}
