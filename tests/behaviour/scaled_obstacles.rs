//! Obstacles under a scale are what is seen of them, or one warning says how they aren't.

use bevy::{math::Affine3A, mesh::VertexAttributeValues, prelude::*};
use bevy_drape::prelude::*;

use crate::{common::*, quiet::Quiet};

const FLAT: Vec3 = Vec3::new(2.0, 0.4, 1.0);
const BALL: Sphere = Sphere { radius: 0.3 };

/// The ball in the tests lies in the middle, and a cloth of 0.8 m falls on it from 10 cm above. It keeps hardly any distance, so
/// that it lies on what is seen.
fn cover(app: &mut App, pose: Transform, mesh: impl Into<Mesh>) -> (Entity, Entity) {
    let ball = app.world_mut().spawn((ClothCollider { friction: 4.0, ..BALL.into() }, pose)).id();
    let above = Transform::from_xyz(0.0, highest(&pose) + 0.1, 0.0);
    let close = (Cloth { collision_margin: 0.0, ..default() }, Fabric { thickness: 1e-5, ..Fabric::COTTON_WOVEN });
    (ball, spawn_cloth(app, mesh, (close, above)))
}

fn grid() -> Mesh {
    ClothGrid::new(0.8, 0.8, 33, 33).lying().into()
}

/// The same without rows and columns.
fn irregular() -> Mesh {
    let mut mesh = grid();
    let Some(VertexAttributeValues::Float32x3(places)) = mesh.attribute_mut(Mesh::ATTRIBUTE_POSITION) else {
        panic!("a grid has positions")
    };
    for (k, place) in places.iter_mut().enumerate() {
        place[0] += 0.006 * ops::sin(12.9 * k as f32);
        place[2] += 0.006 * ops::sin(78.2 * k as f32);
    }
    mesh
}

/// Height of the ball's top under a transform, m.
fn highest(pose: &Transform) -> f32 {
    BALL.radius * pose.compute_affine().matrix3.row(1).length() + pose.translation.y
}

/// How far places are from the middle of the ball under a transform, in its radii: 1 on the surface.
fn off_middle(pose: &Transform, places: &[Vec3]) -> Vec<f32> {
    let to_ball: Affine3A = pose.compute_affine().inverse();
    places.iter().map(|&place| to_ball.transform_point3(place).length() / BALL.radius).collect()
}

#[test]
fn cloth_lies_on_a_flattened_ball_and_not_above_it() {
    let turned = Quat::from_euler(EulerRot::YXZ, 0.7, 0.2, -0.1);
    let cases = [
        (grid(), Transform::from_scale(FLAT)),
        (irregular(), Transform::from_scale(FLAT)),
        (grid(), Transform::from_scale(FLAT).with_rotation(turned)),
        (irregular(), Transform::from_scale(FLAT * Vec3::new(-1.0, 1.0, 1.0)).with_rotation(turned)),
    ];
    for (mesh, pose) in cases {
        let mut app = headless();
        let (_, cloth) = cover(&mut app, pose, mesh);
        run(&mut app, 120);
        let off_middle = off_middle(&pose, &positions(&app, cloth));
        let nearest = off_middle.iter().copied().fold(f32::MAX, f32::min);
        assert!(nearest > 0.999, "{pose:?}: a particle is inside, at {nearest}");
        let touching = off_middle.iter().filter(|&&off| off < 1.01).count();
        println!("{pose:?}: {touching} of {} touch, the nearest at {nearest}", off_middle.len());
        assert!(touching > 200, "{pose:?}: {touching} particles touch");
    }
}

#[test]
fn cloth_follows_a_ball_that_is_squashed_and_drawn_out() {
    let mut app = headless();
    let (ball, cloth) = cover(&mut app, Transform::default(), grid());
    run(&mut app, 90);
    for frame in 1..=180 {
        let squash = 0.3 * ops::sin(frame as f32 * core::f32::consts::TAU / 60.0);
        let scale = Vec3::new(1.0 + squash / 2.0, 1.0 - squash, 1.0 + squash / 2.0);
        get_mut::<Transform>(&mut app, ball).scale = scale;
        run(&mut app, 1);
        let pose = *get::<Transform>(&app, ball);
        let off_middle = off_middle(&pose, &positions(&app, cloth));
        let nearest = off_middle.iter().copied().fold(f32::MAX, f32::min);
        let touching = off_middle.iter().filter(|&&off| off < 1.02).count();
        if frame % 10 == 0 {
            println!("{frame}: {touching} touch, the nearest at {nearest}, {:?}", state(&app, cloth).strain());
        }
        assert!(nearest > 0.995, "frame {frame}: a particle is inside, at {nearest}");
        assert!(touching > 100, "frame {frame}: {touching} particles touch");
    }
    run(&mut app, 60);
    let strain = state(&app, cloth).strain();
    assert!(strain.largest < 0.03, "{strain:?}");
    assert_eq!(app.world().resource::<Heard>().reset, []);
}

/// The warnings while a collider is there for half a second, its scale `of` each frame.
fn told(collider: ClothCollider, of: impl Fn(usize) -> Vec3) -> (Entity, Vec<String>) {
    let mut quiet = Quiet::new();
    let entity = quiet.app.world_mut().spawn((collider, Transform::from_scale(of(0)))).id();
    let mut said = Vec::new();
    for frame in 0..30 {
        get_mut::<Transform>(&mut quiet.app, entity).scale = of(frame);
        said.extend(quiet.run(1));
    }
    (entity, said)
}

#[test]
fn what_stays_round_where_its_scale_is_not_is_told_of_once() {
    let (across, along) = (Vec3::new(2.0, 1.0, 1.0), Vec3::new(1.0, 2.0, 1.0));
    let limb = TaperedCapsule::new(0.1, 0.2, 0.5);
    for (collider, scale, words) in [
        (Cylinder::new(0.2, 0.5).into(), across, "along X and Z"),
        (Cone::new(0.2, 0.5).into(), across, "along X and Z"),
        (Capsule3d::new(0.2, 0.5).into(), across, "along X and Z"),
        (limb.into(), across, "along X and Z"),
        (Capsule3d::new(0.2, 0.5).into(), along, "its ends stay balls"),
        (limb.into(), along, "its ends stay balls"),
    ] {
        let collider: ClothCollider = collider;
        let steady = told(collider.clone(), |_| scale);
        // Breathing, and uniform now and then.
        let breathing = told(collider, |frame| Vec3::ONE.lerp(scale, [0.0, 0.5, 1.0, 0.7][frame % 4]));
        for (entity, said) in [steady, breathing] {
            assert_eq!(said.len(), 1, "{said:?}");
            let words = [&format!("collider {entity} isn't quite what is seen"), words, "ClothCollider::convex_hull"];
            assert!(words.iter().all(|word| said[0].contains(word)), "{said:?}");
        }
    }
}

#[test]
fn what_is_scaled_as_it_is_seen_is_not_told_of() {
    let uneven = Vec3::new(2.0, 0.4, -1.0);
    for (collider, scale) in [
        (Sphere::new(0.2).into(), uneven),
        (Ellipsoid { half_size: Vec3::new(0.1, 0.2, 0.3) }.into(), uneven),
        (Cuboid::new(0.1, 0.2, 0.3).into(), uneven),
        (Cylinder::new(0.2, 0.5).into(), Vec3::new(2.0, 0.4, -2.0)),
        (Cone::new(0.2, 0.5).into(), Vec3::new(2.0, 0.4, -2.0)),
        (Capsule3d::new(0.2, 0.5).into(), Vec3::splat(3.0)),
    ] {
        let collider: ClothCollider = collider;
        assert_eq!(told(collider, |_| scale).1, Vec::<String>::new());
    }
}

#[test]
fn what_is_sheared_by_its_parent_is_told_of_once() {
    let mut quiet = Quiet::new();
    let parent = quiet.app.world_mut().spawn(Transform::from_scale(FLAT)).id();
    let turned = Transform::from_rotation(Quat::from_rotation_z(0.5));
    let ball = quiet.app.world_mut().spawn((ClothCollider::from(BALL), turned, ChildOf(parent))).id();
    let said = quiet.run(30);
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said[0].contains(&format!("collider {ball} isn't quite")) && said[0].contains("shears"), "{said:?}");
}
