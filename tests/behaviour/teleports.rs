//! What is put elsewhere by intention keeps no memory of its way: cloths, obstacles, pins, whole characters.

use bevy::{ecs::entity_disabling::Disabled, prelude::*};
use bevy_drape::prelude::*;

use crate::common::*;

/// A character: a root, a bone below it, and a cape behind a capsule, pinned to the bone.
struct Character {
    root: Entity,
    bone: Entity,
    capsule: Entity,
    cape: Entity,
}

fn spawn_character(app: &mut App, cape: impl Into<Mesh>) -> Character {
    let root = app.world_mut().spawn(Transform::default()).id();
    let bone = app.world_mut().spawn((Transform::from_xyz(0.0, 0.4, 0.0), ChildOf(root))).id();
    let capsule = (ClothCollider::from(Capsule3d::new(0.2, 0.8)), Transform::default(), ChildOf(bone));
    let capsule = app.world_mut().spawn(capsule).id();
    let pins = Pins::edge(ClothEdge::Top).to_entity(bone);
    let cape = spawn_cloth(app, cape, (pins, Transform::from_xyz(0.0, 0.0, 0.23), ChildOf(root)));
    Character { root, bone, capsule, cape }
}

fn cape() -> ClothGrid {
    ClothGrid::new(0.5, 1.0, 20, 44)
}

fn teleport(app: &mut App, entity: Entity, to: Transform) {
    command(app, entity, |entity| entity.teleport_cloth(to));
}

/// Places of a cloth in the space of an entity: differences first, as exact as they can be.
fn places_in(app: &App, cloth: Entity, space: Entity) -> Vec<Vec3> {
    let (_, rotation, translation) = get::<GlobalTransform>(app, space).to_scale_rotation_translation();
    let state = state(app, cloth);
    let origin = state.origin() - translation;
    state.positions_from_origin().map(|place| rotation.inverse() * (origin + place)).collect()
}

#[test]
fn a_character_that_is_respawned_far_away_hangs_as_before() {
    for mesh in [Mesh::from(cape()), uneven(cape(), 0.2)] {
        let start = || {
            let mut app = headless();
            let character = spawn_character(&mut app, mesh.clone());
            run(&mut app, 240);
            (app, character)
        };
        // As exact as transforms are there: each of them is rounded to 0.03 mm along both of the latter's axes.
        let turned = Transform::from_xyz(400.0, 0.0, -300.0).with_rotation(Quat::from_rotation_y(2.0));
        for (there, tolerance) in [(Transform::from_xyz(500.0, 0.0, 0.0), 1e-4), (turned, 2e-4)] {
            let (mut stayed, one) = start();
            let (mut moved, other) = start();
            teleport(&mut moved, other.root, there);
            for frames in [1, 1, 8] {
                run(&mut stayed, frames);
                run(&mut moved, frames);
                let [stayed, moved] =
                    [(&stayed, &one), (&moved, &other)].map(|(app, it)| places_in(app, it.cape, it.root));
                for (here, there) in stayed.into_iter().zip(moved) {
                    assert_close(here, there, tolerance);
                }
            }
        }
    }
}

#[test]
fn a_cape_that_is_no_child_of_its_wearer_comes_along() {
    let mut app = headless();
    let Character { root, cape, .. } = spawn_character(&mut app, cape());
    app.world_mut().entity_mut(cape).remove::<ChildOf>();
    run(&mut app, 60);
    let before = places_in(&app, cape, root);
    teleport(&mut app, root, Transform::from_xyz(400.0, 0.0, -300.0).with_rotation(Quat::from_rotation_y(2.0)));
    run(&mut app, 1);
    assert!(largest_strain(&app, cape) < 0.01, "{}", largest_strain(&app, cape));
    for (now, before) in places_in(&app, cape, root).into_iter().zip(before) {
        assert_close(now, before, 5e-3);
    }
}

/// Strain of a cape once its root has been moved by hand and `ask` has been asked of the cape: one step later, and ten.
fn strain_after(
    ask: impl for<'a, 'w> Fn(&'a mut EntityCommands<'w>, Transform) -> &'a mut EntityCommands<'w>,
    to: Vec3,
) -> [f32; 2] {
    let mut app = headless();
    let root = app.world_mut().spawn(Transform::default()).id();
    app.world_mut().spawn((ClothCollider::from(Sphere::new(0.2)), Transform::default(), ChildOf(root)));
    let local = Transform::from_xyz(0.0, 0.0, 0.25);
    let grid = ClothGrid::new(0.5, 1.0, 12, 24);
    let cape = spawn_cloth(&mut app, grid, (Pins::edge(ClothEdge::Top), local, ChildOf(root)));
    run(&mut app, 60);
    get_mut::<Transform>(&mut app, root).translation = to;
    command(&mut app, cape, |cape| ask(cape, local));
    [1, 9].map(|frames| {
        run(&mut app, frames);
        largest_strain(&app, cape)
    })
}

#[test]
fn an_obstacle_that_has_come_along_with_a_teleported_or_reset_cloth_sweeps_nothing() {
    for to in [Vec3::NEG_Z, Vec3::Z * 0.9, Vec3::new(20.0, 0.0, 0.0), Vec3::NEG_X * 500.0] {
        let teleported = strain_after(|cape, local| cape.teleport_cloth(local), to);
        assert!(teleported.iter().all(|&strain| strain < 0.01), "to {to}: {teleported:?}");
        let reset = strain_after(|cape, _| cape.reset_cloth(), to);
        assert!(reset.iter().all(|&strain| strain < 0.01), "reset, to {to}: {reset:?}");
    }
}

/// A curtain, and a ball that is half a metre before it.
fn curtain_and_ball(mesh: impl Into<Mesh>) -> (App, Entity, Entity) {
    let mut app = headless();
    let curtain = spawn_cloth(&mut app, mesh, Pins::edge(ClothEdge::Top));
    let ball = (ClothCollider::from(Sphere::new(0.1)), Transform::from_xyz(0.0, 0.0, 0.5));
    let ball = app.world_mut().spawn(ball).id();
    run(&mut app, 30);
    (app, curtain, ball)
}

const BEHIND: Transform = Transform::from_xyz(0.0, 0.0, -0.5);

/// How far the ball moves the curtain, against one that it leaves alone, while it goes behind it as `go` says, m.
fn thrown(mesh: impl Into<Mesh>, go: impl Fn(&mut App, Entity)) -> f32 {
    let mesh = mesh.into();
    let (mut app, curtain, ball) = curtain_and_ball(mesh.clone());
    let (mut alone, same, _) = curtain_and_ball(mesh);
    let step = app.world().resource::<Time<Fixed>>().elapsed();
    go(&mut app, ball);
    let passed = app.world().resource::<Time<Fixed>>().elapsed() - step;
    run(&mut alone, (passed.as_secs_f32() / STEP).round() as usize);
    let mut farthest = 0.0_f32;
    for _ in 0..30 {
        run(&mut app, 1);
        run(&mut alone, 1);
        let pairs = positions(&app, curtain).into_iter().zip(positions(&alone, same));
        farthest = pairs.map(|(moved, alone)| moved.distance(alone)).fold(farthest, f32::max);
    }
    farthest
}

#[test]
fn a_teleported_obstacle_hits_nothing_on_its_way() {
    let grid = ClothGrid::new(1.0, 1.0, 24, 24);
    let swept = thrown(grid, |app, ball| *get_mut::<Transform>(app, ball) = Transform::from_xyz(0.0, 0.0, -0.4));
    assert!(swept > 0.3, "one that moves does: {swept} m");
    for mesh in [Mesh::from(grid), uneven(grid, 0.25)] {
        let thrown = thrown(mesh, |app, ball| command(app, ball, |ball| ball.teleport_collider(BEHIND)));
        assert!(thrown < 1e-3, "{thrown} m");
    }
}

#[test]
fn a_disabled_obstacle_is_gone_and_comes_back_out_of_nowhere() {
    let away = |app: &mut App, ball: Entity| {
        app.world_mut().entity_mut(ball).insert(Disabled);
        for z in [0.3, 0.1, -0.1, -0.3] {
            app.world_mut().get_mut::<Transform>(ball).unwrap().translation.z = z;
            run(app, 1);
        }
        app.world_mut().get_mut::<Transform>(ball).unwrap().translation.z = -0.5;
        app.world_mut().entity_mut(ball).remove::<Disabled>();
    };
    let thrown = thrown(ClothGrid::new(1.0, 1.0, 24, 24), away);
    assert!(thrown < 1e-3, "{thrown} m");
}

#[test]
fn a_jump_that_no_game_means_as_motion_is_taken_for_a_teleport() {
    let jump = |app: &mut App, ball: Entity| *get_mut::<Transform>(app, ball) = Transform::from_xyz(0.0, 0.0, -1.0);
    let grid = ClothGrid::new(1.0, 1.0, 24, 24);
    let thrown_by_jump = thrown(grid, jump);
    assert!(thrown_by_jump < 1e-3, "{thrown_by_jump} m");
    let as_motion = thrown(grid, |app, ball| {
        app.insert_resource(ColliderTeleportThreshold { speed: 1000.0, ..default() });
        jump(app, ball);
    });
    assert!(as_motion > 0.3, "{as_motion} m");
}

#[test]
fn obstacles_below_a_teleported_one_come_along_and_free_cloth_stays() {
    let mut app = headless();
    let table = (ClothCollider::from(Cuboid::new(2.0, 0.1, 2.0)), Transform::default());
    let table = app.world_mut().spawn(table).id();
    let cup = (ClothCollider::from(Sphere::new(0.1)), Transform::from_xyz(0.0, 0.1, 0.0), ChildOf(table));
    app.world_mut().spawn(cup);
    let on_table = Transform::from_xyz(0.0, 0.3, 0.0);
    let cloth = spawn_cloth(&mut app, ClothGrid::new(0.6, 0.6, 16, 16).lying(), on_table);
    run(&mut app, 60);
    let before = positions(&app, cloth);
    command(&mut app, table, |table| table.teleport_collider(Transform::from_xyz(0.9, 0.0, 0.0)));
    run(&mut app, 1);
    for (now, before) in positions(&app, cloth).into_iter().zip(before) {
        assert_close(now, before, 0.01);
    }
}

#[test]
fn a_pin_to_what_is_teleported_is_there_at_once_and_has_no_speed() {
    let mut app = headless();
    let pole = app.world_mut().spawn(Transform::default()).id();
    let pins = Pins::indices([0]).to_entity(pole).and(Pins::indices([5]).to_world());
    let cloth = spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 6, 6), pins);
    run(&mut app, 5);
    let before = place(&app, cloth, 0);
    command(&mut app, pole, |pole| pole.teleport_collider(Transform::from_xyz(0.2, 0.1, 0.0)));
    run(&mut app, 1);
    assert_close(place(&app, cloth, 0), before + Vec3::new(0.2, 0.1, 0.0), 1e-6);
    let particle = state(&app, cloth).particle_of_vertex(0).unwrap();
    assert_eq!(state(&app, cloth).velocity(particle), Some(Vec3::ZERO));
}

#[test]
fn a_disabled_cloth_stands_still_and_comes_back_where_its_pins_are() {
    let mut app = headless();
    let Character { root, bone, capsule, cape } = spawn_character(&mut app, cape());
    run(&mut app, 60);
    let before = places_in(&app, cape, root);
    let wake = |app: &mut App, is_awake: bool| {
        for entity in [capsule, cape, bone] {
            let mut entity = app.world_mut().entity_mut(entity);
            if is_awake {
                entity.remove::<Disabled>()
            } else {
                entity.insert(Disabled)
            };
        }
    };
    wake(&mut app, false);
    run(&mut app, 5);
    *get_mut::<Transform>(&mut app, root) = Transform::from_xyz(0.0, 0.0, -30.0);
    run(&mut app, 5);
    wake(&mut app, true);
    run(&mut app, 1);
    assert!(largest_strain(&app, cape) < 0.01, "{}", largest_strain(&app, cape));
    for (now, before) in places_in(&app, cape, root).into_iter().zip(before) {
        assert_close(now, before, 5e-3);
    }
}

#[test]
fn a_disabled_wind_blows_no_more() {
    let mut app = headless();
    let flag = spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 8, 8), Pins::edge(ClothEdge::Top));
    app.world_mut().spawn((Wind { velocity: Vec3::Z * 20.0, ..default() }, Disabled));
    run(&mut app, 30);
    assert!(positions(&app, flag).iter().all(|place| place.z == 0.0));
}

#[test]
fn a_hidden_cloth_goes_on() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 8, 8), (Pins::indices([0]), Visibility::Hidden));
    run(&mut app, 30);
    assert!(place(&app, cloth, 7).y < 0.3, "{}", place(&app, cloth, 7));
}
