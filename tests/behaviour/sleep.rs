//! Cloth at rest sleeps until something changes near it.

use bevy::{ecs::entity_disabling::Disabled, prelude::*};
use bevy_drape::prelude::*;

use crate::common::*;

const GRID: ClothGrid = ClothGrid { size: Vec2::new(0.6, 0.4), particles: UVec2::new(13, 9), lying: false };

/// Those that fell asleep and woke up, in their order.
#[derive(Resource, Default, Debug, PartialEq)]
struct Told {
    asleep: Vec<Entity>,
    awake: Vec<Entity>,
}

fn app() -> App {
    let mut app = headless();
    app.init_resource::<Told>()
        .add_observer(|event: On<ClothFellAsleep>, mut told: ResMut<Told>| told.asleep.push(event.entity))
        .add_observer(|event: On<ClothWokeUp>, mut told: ResMut<Told>| told.awake.push(event.entity));
    app
}

fn is_asleep(app: &App, cloth: Entity) -> bool {
    *get::<ClothStatus>(app, cloth) == ClothStatus::Asleep
}

/// Runs the app until the cloth sleeps. Returns the number of steps, or none after `most` s.
fn time_to_sleep(app: &mut App, cloth: Entity, most: f32) -> Option<usize> {
    let steps = (most / STEP) as usize;
    (0..steps).find(|_| {
        run(app, 1);
        is_asleep(app, cloth)
    })
}

#[track_caller]
fn let_sleep(app: &mut App, cloth: Entity) {
    assert!(time_to_sleep(app, cloth, 30.0).is_some(), "it never sleeps");
}

/// A cloth with such pins, asleep.
fn sleeper(app: &mut App, pins: Pins, settings: Cloth) -> Entity {
    let cloth = spawn_cloth(app, GRID, (pins, settings));
    let_sleep(app, cloth);
    cloth
}

fn farthest(one: &[Vec3], other: &[Vec3]) -> f32 {
    one.iter().zip(other).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max)
}

#[test]
fn cloth_of_every_kind_falls_asleep() {
    let pinned = || Pins::edge(ClothEdge::Top);
    let lying = ClothGrid::new(0.6, 0.6, 13, 13).lying();
    let ball = Sphere::new(0.2).mesh().ico(8).unwrap();
    let (above_ball, above_table, above_ground) =
        (Vec3::new(10.0, 0.25, 0.0), Vec3::new(20.0, 0.25, 0.0), Vec3::NEG_Y * 1.75);
    let kinds: [(&str, Mesh, Pins, Vec3); 7] = [
        ("rows and columns", GRID.into(), pinned(), Vec3::ZERO),
        ("triangles", uneven(GRID, 0.25), pinned(), Vec3::ZERO),
        ("a seam", seamed_strip(), Pins::indices([0, 1]), Vec3::ZERO),
        ("a closed ball on the ground", ball, Pins::default(), above_ground),
        ("on a ball", lying.into(), Pins::default(), above_ball),
        ("triangles on a ball", uneven(lying, 0.25), Pins::default(), above_ball),
        ("triangles on a table", uneven(ClothGrid::new(0.8, 0.8, 33, 33).lying(), 0.25), Pins::default(), above_table),
    ];
    for (kind, mesh, pins, place) in kinds {
        let mut app = app();
        app.world_mut().spawn((ClothCollider::from(Sphere::new(0.2)), Transform::from_xyz(10.0, 0.0, 0.0)));
        let table = ClothCollider::from(Cuboid::new(0.4, 0.4, 0.4));
        app.world_mut().spawn((table, Transform::from_xyz(20.0, 0.0, 0.0)));
        app.world_mut().spawn((ClothCollider::from(InfinitePlane3d::default()), Transform::from_xyz(0.0, -2.0, 0.0)));
        let cloth = spawn_cloth(&mut app, mesh, (pins, Transform::from_translation(place)));
        let time = time_to_sleep(&mut app, cloth, 60.0);
        println!("{kind}: {:?} s", time.map(|steps| steps as f32 * STEP));
        assert!(time.is_some(), "{kind} never sleeps");
        assert_eq!(*app.world().resource::<Told>(), Told { asleep: vec![cloth], awake: vec![] }, "{kind}");
        let before = positions(&app, cloth);
        run(&mut app, 60);
        assert!(is_asleep(&app, cloth) && positions(&app, cloth) == before, "{kind}");
        assert_eq!(get::<ClothReport>(&app, cloth).step_time(), core::time::Duration::ZERO);
        // It was at rest: it goes on where it was when it is woken.
        get_mut::<Cloth>(&mut app, cloth).set_changed();
        run(&mut app, 30);
        let moved = farthest(&before, &positions(&app, cloth));
        assert!(moved < 2e-4, "{kind} moves by {moved} m when it wakes");
    }
}

/// What may wake a cloth, given that and the pole that it is pinned to.
type Disturbance = fn(&mut App, Entity, Entity);

#[test]
fn it_wakes_in_the_step_in_which_something_changes() {
    let disturbances: [(&str, Disturbance); 13] = [
        ("a force", |app, cloth, _| get_mut::<ClothState>(app, cloth).add_force(40, Vec3::X)),
        ("an impulse", |app, cloth, _| get_mut::<ClothState>(app, cloth).add_impulse(40, Vec3::X * 1e-3)),
        ("a hand", |app, cloth, _| {
            let point = state(app, cloth).nearest_point(Vec3::ZERO).unwrap();
            take_hold(app, cloth, point, ClothGrip::default()).unwrap();
        }),
        ("gravity", |app, _, _| app.world_mut().resource_mut::<ClothGravity>().0 = Vec3::X),
        ("a setting", |app, cloth, _| get_mut::<Cloth>(app, cloth).gravity_scale = 0.5),
        ("its fabric", |app, cloth, _| *get_mut::<Fabric>(app, cloth) = Fabric::SILK),
        ("a pin that goes", |app, cloth, _| *get_mut::<Pins>(app, cloth) = Pins::indices([0])),
        ("its pole", |app, _, pole| get_mut::<Transform>(app, pole).translation.x += 0.01),
        ("its transform", |app, cloth, _| get_mut::<Transform>(app, cloth).translation.x += 0.01),
        ("its scale", |app, cloth, _| get_mut::<Transform>(app, cloth).scale *= 1.1),
        ("an obstacle that comes", |app, _, _| {
            app.world_mut().spawn((ClothCollider::from(Sphere::new(0.1)), Transform::from_xyz(0.0, 0.0, 0.05)));
        }),
        ("a wind", |app, _, _| {
            app.world_mut().spawn(Wind { velocity: Vec3::Z, ..default() });
        }),
        ("other cloth", |app, _, _| {
            let meets = Cloth { self_collision: true, ..default() };
            spawn_cloth(app, GRID, (meets, Transform::from_xyz(0.0, 0.0, 0.02)));
            // It is cloth, and moves, from the next step on.
            run(app, 1);
        }),
    ];
    for (what, disturb) in disturbances {
        let mut app = app();
        let pole = app.world_mut().spawn(Transform::default()).id();
        let meets = Cloth { self_collision: true, ..default() };
        let cloth = sleeper(&mut app, Pins::corners().to_entity(pole), meets);
        let before = positions(&app, cloth);
        disturb(&mut app, cloth, pole);
        run(&mut app, 1);
        assert_eq!(*get::<ClothStatus>(&app, cloth), ClothStatus::Ready, "{what}");
        assert_eq!(app.world().resource::<Told>().awake, [cloth], "{what}");
        assert!(what == "its transform" || positions(&app, cloth) != before, "{what} moves it");
    }
}

#[test]
fn an_obstacle_wakes_it_when_it_moves_or_goes() {
    let mut app = app();
    let ball = |x: f32| (ClothCollider::from(Sphere::new(0.2)), Transform::from_xyz(x, -0.2, 0.0));
    let [under, far] = [0.0, 5.0].map(|x| app.world_mut().spawn(ball(x)).id());
    let lying = uneven(ClothGrid::new(0.6, 0.6, 13, 13).lying(), 0.25);
    let cloth = spawn_cloth(&mut app, lying, Fabric::DENIM);
    let_sleep(&mut app, cloth);
    get_mut::<Transform>(&mut app, far).translation.y += 1.0;
    run(&mut app, 5);
    app.world_mut().despawn(far);
    run(&mut app, 5);
    assert!(is_asleep(&app, cloth), "what is far away doesn't matter");
    get_mut::<Transform>(&mut app, under).translation.y += 0.01;
    run(&mut app, 1);
    assert!(!is_asleep(&app, cloth), "it is lifted");
    let_sleep(&mut app, cloth);
    get_mut::<ClothCollider>(&mut app, under).friction = 0.0;
    run(&mut app, 1);
    assert!(!is_asleep(&app, cloth), "it slides off");
    get_mut::<ClothCollider>(&mut app, under).friction = 1.0;
    let_sleep(&mut app, cloth);
    app.world_mut().despawn(under);
    run(&mut app, 30);
    assert!(!is_asleep(&app, cloth) && place(&app, cloth, 84).y < -0.5, "it falls");
}

#[test]
fn one_that_was_disabled_looks_anew_at_what_is_around() {
    let mut app = app();
    let ball = (ClothCollider::from(Sphere::new(0.2)), Transform::from_xyz(0.0, -0.2, 0.0));
    let ball = app.world_mut().spawn(ball).id();
    let lying = uneven(ClothGrid::new(0.6, 0.6, 13, 13).lying(), 0.25);
    let cloth = spawn_cloth(&mut app, lying, Fabric::DENIM);
    let_sleep(&mut app, cloth);
    app.world_mut().entity_mut(cloth).insert(Disabled);
    run(&mut app, 2);
    app.world_mut().despawn(ball);
    run(&mut app, 2);
    app.world_mut().entity_mut(cloth).remove::<Disabled>();
    run(&mut app, 30);
    assert!(!is_asleep(&app, cloth) && place(&app, cloth, 84).y < -0.5, "it falls");
}

#[test]
fn cloths_that_may_touch_each_other_sleep_and_wake_together() {
    let mut app = app();
    let meets = || Cloth { self_collision: true, ..default() };
    let at = |z: f32| (Pins::corners(), meets(), Transform::from_xyz(0.0, 0.0, z));
    let [one, other] = [0.0, 0.02].map(|z| spawn_cloth(&mut app, GRID, at(z)));
    let far = spawn_cloth(&mut app, GRID, at(3.0));
    let_sleep(&mut app, one);
    assert!(is_asleep(&app, other) && is_asleep(&app, far));
    get_mut::<ClothState>(&mut app, one).add_impulse(60, Vec3::Z * 1e-3);
    run(&mut app, 1);
    assert_eq!([one, other, far].map(|cloth| is_asleep(&app, cloth)), [false, false, true]);
    // One that may not sleep keeps the other awake.
    app.world_mut().entity_mut(one).insert(ClothSleepingDisabled);
    assert_eq!(time_to_sleep(&mut app, other, 20.0), None);
    app.world_mut().entity_mut(one).remove::<ClothSleepingDisabled>();
    let_sleep(&mut app, other);
}

#[test]
fn it_stays_awake_in_wind_where_it_is_asked_to_and_under_a_steady_force() {
    let mut app = app();
    let region = WindShape::Sphere(Sphere::new(0.5));
    app.world_mut()
        .spawn((Wind { velocity: Vec3::Z, region, edge: 0.1, ..default() }, Transform::from_xyz(5.0, 0.0, 0.0)));
    let at = |x: f32| (Pins::corners(), Transform::from_xyz(x, 0.0, 0.0));
    let calm = spawn_cloth(&mut app, GRID, at(0.0));
    let blown = spawn_cloth(&mut app, GRID, at(5.0));
    let forbidden = spawn_cloth(&mut app, GRID, (at(1.0), ClothSleepingDisabled));
    let pushed = spawn_cloth(&mut app, GRID, at(2.0));
    for _ in 0..1200 {
        get_mut::<ClothState>(&mut app, pushed).add_force(60, Vec3::Z * 1e-3);
        run(&mut app, 1);
    }
    assert_eq!([calm, blown, forbidden, pushed].map(|cloth| is_asleep(&app, cloth)), [true, false, false, false]);
    // It is where a cloth is that never slept.
    let there = positions(&app, forbidden).into_iter().map(|place| place - Vec3::X).collect::<Vec<_>>();
    let apart = farthest(&positions(&app, calm), &there);
    assert!(apart < 2e-4, "{apart}");
}

#[test]
fn a_sleeper_is_drawn_where_it_is_and_its_mesh_isnt_written() {
    let mut app = app();
    let cloth = sleeper(&mut app, Pins::corners(), Cloth::default());
    run(&mut app, 2);
    for (drawn, place) in points(drawn(&app, cloth)).into_iter().zip(positions(&app, cloth)) {
        assert_close(drawn, place, 1e-6);
    }
    let mut written = app.world().resource::<Messages<AssetEvent<Mesh>>>().get_cursor_current();
    for _ in 0..10 {
        run(&mut app, 1);
        let messages = app.world().resource::<Messages<AssetEvent<Mesh>>>();
        assert_eq!(written.read(messages).filter(|event| matches!(event, AssetEvent::Modified { .. })).count(), 0);
    }
    // Where its entity goes, it doesn't: it is woken, and drawn where it hangs by its pins.
    get_mut::<Transform>(&mut app, cloth).translation.x += 0.2;
    run(&mut app, 2);
    assert!(!is_asleep(&app, cloth));
}

#[test]
fn a_sleeper_can_be_reset_teleported_shifted_and_rebuilt() {
    let mut app = app();
    let cloth = sleeper(&mut app, Pins::corners(), Cloth::default());
    app.world_mut().commands().shift_world(Vec3::X * 64.0);
    app.world_mut().flush();
    run(&mut app, 10);
    assert!(is_asleep(&app, cloth), "nothing has happened to it");
    assert_close(place(&app, cloth, 0), Vec3::new(63.7, 0.2, 0.0), 1e-5);
    command(&mut app, cloth, |cloth| cloth.teleport_cloth(Transform::from_xyz(0.0, 5.0, 0.0)));
    run(&mut app, 1);
    assert!(!is_asleep(&app, cloth));
    assert_close(place(&app, cloth, 0), Vec3::new(-0.3, 5.2, 0.0), 1e-5);
    let_sleep(&mut app, cloth);
    command(&mut app, cloth, |cloth| cloth.reset_cloth());
    run(&mut app, 1);
    assert!(!is_asleep(&app, cloth));
    let_sleep(&mut app, cloth);
    let other = add_mesh(&mut app, ClothGrid::new(0.6, 0.4, 9, 9));
    get_mut::<Mesh3d>(&mut app, cloth).0 = other;
    run(&mut app, 2);
    assert_eq!((is_asleep(&app, cloth), state(&app, cloth).particle_count()), (false, 81));
    let Told { asleep, awake } = app.world().resource();
    assert_eq!((asleep.len(), awake.len()), (3, 3));
}
