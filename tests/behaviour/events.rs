//! Each fact about a cloth is told once, and is true when it is told.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::common::*;

const GRID: ClothGrid = ClothGrid { size: Vec2::ONE, particles: UVec2::new(4, 4), lying: false };

fn heard(app: &App) -> &Heard {
    app.world().resource()
}

#[test]
fn ready_is_told_once_and_the_state_is_there() {
    let mut app = headless();
    app.add_observer(|event: On<ClothReady>, cloths: Query<(&ClothState, &ClothStatus)>| {
        let (state, status) = cloths.get(event.entity).unwrap();
        assert_eq!((state.particle_count(), status), (16, &ClothStatus::Ready));
    });
    let cloth = spawn_cloth(&mut app, GRID, Pins::corners());
    run(&mut app, 10);
    assert_eq!(*heard(&app), Heard { ready: vec![cloth], ..default() });
}

#[test]
fn ready_is_told_to_observers_of_the_entity() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, GRID, ());
    app.world_mut().entity_mut(cloth).observe(|event: On<ClothReady>, mut commands: Commands| {
        commands.entity(event.entity).insert(Name::new("ready"));
    });
    run(&mut app, 1);
    assert_eq!(get::<Name>(&app, cloth).as_str(), "ready");
}

#[test]
fn failure_is_told_once_and_again_when_its_cause_changes() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, GRID, Pins::indices([99]));
    run(&mut app, 5);
    let out_of_range = |vertex| (cloth, ClothError::PinOutOfRange { vertex, count: 16 });
    assert_eq!(heard(&app).failed, [out_of_range(99)]);
    assert_eq!(*get::<ClothStatus>(&app, cloth), ClothStatus::Failed(out_of_range(99).1));
    for _ in 0..3 {
        get_mut::<Transform>(&mut app, cloth).translation.x += 1.0;
        get_mut::<Pins>(&mut app, cloth).set_changed();
        run(&mut app, 1);
    }
    assert_eq!(heard(&app).failed, [out_of_range(99)]);
    *get_mut::<Pins>(&mut app, cloth) = Pins::indices([77]);
    run(&mut app, 5);
    assert_eq!(heard(&app).failed, [out_of_range(99), out_of_range(77)]);
    assert_eq!(heard(&app).ready, []);
}

#[test]
fn failure_for_want_of_a_number_is_told_once() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, GRID, Fabric { density: f32::NAN, ..default() });
    for _ in 0..5 {
        get_mut::<Transform>(&mut app, cloth).translation.x += 1.0;
        run(&mut app, 1);
    }
    assert_eq!(heard(&app).failed.len(), 1);
}

#[test]
fn what_failed_is_ready_once_it_is_mended() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, GRID, Pins::indices([99]));
    run(&mut app, 2);
    *get_mut::<Pins>(&mut app, cloth) = Pins::indices([9]);
    run(&mut app, 2);
    assert_eq!(heard(&app).ready, [cloth]);
    assert_eq!(*get::<ClothStatus>(&app, cloth), ClothStatus::Ready);
    assert_eq!(pinned(&app, cloth), [9]);
}

#[test]
fn a_reset_of_what_failed_is_told_as_ready() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, GRID, Pins::indices([99]));
    run(&mut app, 2);
    *get_mut::<Pins>(&mut app, cloth) = Pins::indices([9]);
    command(&mut app, cloth, |cloth| cloth.reset_cloth());
    run(&mut app, 2);
    assert_eq!((heard(&app).ready.as_slice(), heard(&app).reset.as_slice()), (&[cloth][..], &[][..]));
}

#[test]
fn each_cause_of_a_reset_is_told_once() {
    let mut app = headless();
    let handle = add_mesh(&mut app, GRID);
    let cloth = app.world_mut().spawn((Mesh3d(handle.clone()), Cloth::default())).id();
    run(&mut app, 3);
    command(&mut app, cloth, |cloth| cloth.reset_cloth());
    run(&mut app, 3);
    *app.world_mut().resource_mut::<Assets<Mesh>>().get_mut(&handle).unwrap() = GRID.into();
    run(&mut app, 3);
    get_mut::<ClothState>(&mut app, cloth).add_impulse(3, Vec3::splat(f32::MAX));
    run(&mut app, 3);
    let causes = [ResetCause::Requested, ResetCause::Rebuilt, ResetCause::NotFinite];
    assert_eq!(heard(&app).reset, causes.map(|cause| (cloth, cause)));
    assert_eq!(heard(&app).ready, [cloth]);
}
