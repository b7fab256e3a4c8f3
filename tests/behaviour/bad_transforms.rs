//! Transforms that can't be inverted: refused at first, and survived while the cloth runs.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::common::*;

const GRID: ClothGrid = ClothGrid { size: Vec2::ONE, particles: UVec2::new(5, 5), lying: true };
const CORNER_AT: Vec3 = Vec3::new(-0.5, 0.0, -0.5);

fn bad() -> [Transform; 6] {
    [
        Transform::from_scale(Vec3::ZERO),
        Transform::from_scale(Vec3::new(1.0, 0.0, 1.0)),
        Transform::from_scale(Vec3::new(f32::NAN, 1.0, 1.0)),
        Transform::from_xyz(f32::NAN, 0.0, 0.0),
        Transform::from_xyz(0.0, f32::INFINITY, 0.0),
        Transform::from_rotation(Quat::from_xyzw(f32::NAN, 0.0, 0.0, 1.0)),
    ]
}

#[test]
fn a_bad_transform_is_refused_until_it_is_mended() {
    for transform in bad() {
        let mut app = headless();
        let cloth = spawn_cloth(&mut app, GRID, transform);
        run(&mut app, 3);
        let status = get::<ClothStatus>(&app, cloth);
        assert_eq!(*status, ClothStatus::Failed(ClothError::FlatTransform), "{transform:?}");
        *get_mut::<Transform>(&mut app, cloth) = Transform::IDENTITY;
        run(&mut app, 2);
        assert_eq!(*get::<ClothStatus>(&app, cloth), ClothStatus::Ready, "{transform:?}");
    }
}

#[test]
fn a_bad_parent_is_refused_until_it_is_mended() {
    let mut app = headless();
    let parent = app.world_mut().spawn(Transform::from_scale(Vec3::ZERO)).id();
    let cloth = spawn_cloth(&mut app, GRID, ChildOf(parent));
    run(&mut app, 3);
    assert_eq!(*get::<ClothStatus>(&app, cloth), ClothStatus::Failed(ClothError::FlatTransform));
    get_mut::<Transform>(&mut app, parent).scale = Vec3::ONE;
    run(&mut app, 3);
    assert_eq!(*get::<ClothStatus>(&app, cloth), ClothStatus::Ready);
}

#[test]
fn a_transform_that_turns_bad_leaves_the_cloth_finite() {
    for transform in bad() {
        let mut app = headless();
        let cloth = spawn_cloth(&mut app, GRID, Pins::indices([0, 4]));
        run(&mut app, 2);
        *get_mut::<Transform>(&mut app, cloth) = transform;
        run(&mut app, 30);
        assert_close(place(&app, cloth, 0), CORNER_AT, 1e-6);
        assert!(place(&app, cloth, 22).y < -0.5, "{transform:?}");
        assert!(points(drawn(&app, cloth)).into_iter().all(Vec3::is_finite), "{transform:?}");
        let moved = Transform::from_xyz(0.0, 1.0, 0.0);
        *get_mut::<Transform>(&mut app, cloth) = moved;
        run(&mut app, 1);
        assert_close(place(&app, cloth, 0), moved * CORNER_AT, 1e-6);
        assert_eq!(app.world().resource::<Heard>().reset, []);
    }
}

#[test]
fn a_target_that_turns_bad_leaves_its_pins_where_they_are() {
    for transform in bad() {
        let mut app = headless();
        let target = app.world_mut().spawn(Transform::default()).id();
        let cloth = spawn_cloth(&mut app, GRID, Pins::indices([0]).to_entity(target));
        run(&mut app, 2);
        *get_mut::<Transform>(&mut app, target) = transform;
        run(&mut app, 30);
        assert_close(place(&app, cloth, 0), CORNER_AT, 1e-6);
        assert_eq!(app.world().resource::<Heard>().reset, []);
    }
}
