//! Clothes meet their own body, and others only if that is asked for.

use bevy::{
    mesh::{VertexAttributeValues, skinning::SkinnedMesh},
    prelude::*,
};
use bevy_drape::prelude::*;

use super::limb::{lying, spawn, spawn_body};
use crate::common::*;

/// A sheet above the upper part of a limb that lies with its root at `place`.
fn above(place: Vec3) -> Transform {
    Transform::from_translation(place + Vec3::new(0.25, 0.12, 0.0))
}

fn sheet() -> ClothGrid {
    ClothGrid::new(0.4, 0.4, 9, 9).lying()
}

/// Height of a sheet's middle after a while in which it would fall by two metres.
fn height(app: &App, cloth: Entity) -> f32 {
    place(app, cloth, 40).y
}

#[test]
fn clothes_meet_their_own_body_and_no_other_unless_asked() {
    let mut app = headless();
    let [own, other] = [Vec3::ZERO, Vec3::Z * 2.0];
    let character = spawn_body(&mut app, lying(own));
    spawn_body(&mut app, lying(other));
    let mut worn = |place: Vec3, skin: ClothSkin| {
        let cloth = spawn_cloth(&mut app, sheet(), (undamped(), skin));
        // Where it is in the world, below a turned character.
        let local = lying(own).compute_affine().inverse() * above(place).compute_affine();
        let local = Transform::from_matrix(local.into());
        app.world_mut().entity_mut(cloth).insert((local, ChildOf(character.root)));
        cloth
    };
    let on_own = worn(own, ClothSkin::default());
    let on_other = worn(other, ClothSkin::default());
    let asked = worn(other, ClothSkin { meets_others: true, ..default() });
    let free = spawn_cloth(&mut app, sheet(), (undamped(), above(other)));
    run(&mut app, 40);
    assert!((height(&app, on_own) - 0.1).abs() < 0.04, "its own: {}", height(&app, on_own));
    assert!(height(&app, on_other) < -1.5, "another's: {}", height(&app, on_other));
    assert!((height(&app, asked) - 0.1).abs() < 0.04, "another's, if asked: {}", height(&app, asked));
    assert!((height(&app, free) - 0.1).abs() < 0.04, "it is nobody's: {}", height(&app, free));
}

#[test]
fn clothes_beside_their_body_on_its_joints_are_its_own() {
    let mut app = headless();
    let [own, other] = [Vec3::ZERO, Vec3::Z * 2.0];
    let limb = spawn(&mut app, lying(own));
    app.world_mut().entity_mut(limb.mesh).insert(ClothBody::default());
    spawn_body(&mut app, lying(other));
    let skeleton = get::<SkinnedMesh>(&app, limb.mesh).clone();
    let mut worn = |at: Vec3| {
        let mut mesh: Mesh = sheet().into();
        let local = lying(own).compute_affine().inverse() * above(at).compute_affine();
        mesh.transform_by(Transform::from_matrix(local.into()));
        let joints = VertexAttributeValues::Uint16x4(vec![[0; 4]; 81]);
        let mesh = mesh
            .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_INDEX, joints)
            .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, vec![[1.0, 0.0, 0.0, 0.0]; 81]);
        spawn_cloth(&mut app, mesh, (undamped(), skeleton.clone()))
    };
    let [on_own, on_other] = [own, other].map(&mut worn);
    run(&mut app, 40);
    assert!((height(&app, on_own) - 0.1).abs() < 0.04, "its own: {}", height(&app, on_own));
    assert!(height(&app, on_other) < -1.5, "another's: {}", height(&app, on_other));
}

#[test]
fn plain_obstacles_are_met_by_all() {
    let mut app = headless();
    let character = spawn_body(&mut app, Transform::from_xyz(9.0, 0.0, 0.0));
    let cloth = spawn_cloth(&mut app, sheet(), undamped());
    let place = Transform::from_xyz(-9.0, 0.12, 0.0);
    app.world_mut().entity_mut(cloth).insert((place, ChildOf(character.root)));
    app.world_mut().spawn(ClothCollider::from(Cuboid::new(2.0, 0.2, 2.0)));
    run(&mut app, 40);
    assert!((height(&app, cloth) - 0.1).abs() < 0.02, "{}", height(&app, cloth));
}

#[test]
fn a_body_far_from_the_origin_that_comes_fast_is_met_still() {
    let mut app = headless();
    let far = Vec3::new(3000.0, 0.0, -3000.0);
    let limb = spawn_body(&mut app, lying(far - Vec3::Y));
    let cloth = spawn_cloth(&mut app, sheet(), (undamped(), above(far + Vec3::Y * 0.4)));
    run(&mut app, 1);
    for _ in 0..20 {
        // 6 m/s upwards.
        get_mut::<Transform>(&mut app, limb.root).translation.y += 0.1;
        run(&mut app, 1);
    }
    assert!(height(&app, cloth) > 1.0, "{}", height(&app, cloth));
}

#[test]
fn a_body_that_clothes_dont_meet_leaves_them_asleep() {
    let mut app = headless();
    let character = spawn_body(&mut app, Transform::from_xyz(9.0, 0.0, 0.0));
    let passer_by = spawn_body(&mut app, lying(Vec3::new(0.0, 3.0, 0.0)));
    app.world_mut().spawn(ClothCollider::from(Cuboid::new(2.0, 0.2, 2.0)));
    let cloth = spawn_cloth(&mut app, sheet(), ());
    app.world_mut().entity_mut(cloth).insert((Transform::from_xyz(-9.0, 0.102, 0.0), ChildOf(character.root)));
    run(&mut app, 400);
    assert_eq!(*get::<ClothStatus>(&app, cloth), ClothStatus::Asleep);
    for i in 0..20 {
        get_mut::<Transform>(&mut app, passer_by.root).translation = Vec3::new(0.0, 0.1, 0.01 * i as f32);
        run(&mut app, 1);
        assert_eq!(*get::<ClothStatus>(&app, cloth), ClothStatus::Asleep);
    }
    app.world_mut().despawn(passer_by.root);
    get_mut::<Transform>(&mut app, character.root).translation.z = 0.01;
    run(&mut app, 1);
    assert_eq!(*get::<ClothStatus>(&app, cloth), ClothStatus::Ready);
}
