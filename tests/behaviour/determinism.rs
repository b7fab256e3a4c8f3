//! The same scene gives the same bits, however many threads step it and however the world stores it.

use core::hash::{Hash, Hasher};
use std::hash::DefaultHasher;

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::common::*;

/// A hash of all bits of all positions and velocities.
fn bits(app: &mut App, cloths: &[Entity]) -> u64 {
    let mut hasher = DefaultHasher::new();
    for &cloth in cloths {
        let state = state(app, cloth);
        for value in state.positions().chain(state.velocities()).flat_map(|v| v.to_array()) {
            value.to_bits().hash(&mut hasher);
        }
        for value in points(drawn(app, cloth)).into_iter().chain(normals(drawn(app, cloth))).flat_map(|v| v.to_array())
        {
            value.to_bits().hash(&mut hasher);
        }
    }
    hasher.finish()
}

fn colliders() -> Vec<(ClothCollider, Transform)> {
    let at = |y, z| Transform::from_xyz(0.1, y, z).with_rotation(Quat::from_rotation_x(0.3));
    vec![
        (Sphere::new(0.3).into(), at(-0.4, 0.0)),
        (Cuboid::new(0.5, 0.2, 0.5).into(), at(-0.45, 0.3)),
        (Capsule3d::new(0.1, 0.6).into(), at(-0.35, -0.2)),
        (Cylinder::new(0.2, 0.4).into(), at(-0.5, 0.1)),
    ]
}

fn winds() -> Vec<Wind> {
    let wind = |velocity, seed| Wind { velocity, gusts: 0.8, turbulence: 0.4, seed, ..default() };
    vec![wind(Vec3::X * 3.0, 1), wind(Vec3::new(0.3, 0.1, -2.0), 2), wind(Vec3::new(0.7, -1.1, 0.2), 3)]
}

/// A scene of six cloths in gusty wind over four solids, after 120 steps.
fn scene(plugin: ClothPlugin, spawn_others: impl FnOnce(&mut World)) -> u64 {
    let mut app = headless_with(plugin);
    spawn_others(app.world_mut());
    let solver = |i| match i {
        4 => ClothSolver::Xpbd,
        5 => ClothSolver::Explicit,
        _ => ClothSolver::Strands,
    };
    let cloths: Vec<Entity> = (0..6)
        .map(|i| {
            // The larger ones have coarse levels.
            let grid = ClothGrid::new(1.0, 1.0, 8 + 3 * i, 8 + 3 * i).lying();
            let pins = if i % 2 == 0 { Pins::edge(ClothEdge::Left) } else { Pins::none() };
            let cloth = Cloth { solver: solver(i), max_substeps: 16, ..default() };
            spawn_cloth(&mut app, grid, (pins, cloth, Transform::from_xyz(0.0, 0.1 * i as f32, 0.0)))
        })
        .collect();
    run(&mut app, 120);
    let touched = cloths.iter().any(|&cloth| report(&app, cloth).contacts > 0);
    assert!(touched, "the scene has contacts");
    bits(&mut app, &cloths)
}

fn in_order(world: &mut World) {
    winds().into_iter().for_each(|wind| {
        world.spawn(wind);
    });
    colliders().into_iter().for_each(|collider| {
        world.spawn(collider);
    });
}

#[test]
fn a_scene_repeats_itself_bit_by_bit() {
    assert_eq!(scene(ClothPlugin::default(), in_order), scene(ClothPlugin::default(), in_order));
}

#[test]
fn one_thread_and_several_give_the_same_bits() {
    let several = scene(ClothPlugin::default(), in_order);
    assert_eq!(scene(ClothPlugin::default().single_threaded(), in_order), several);
}

#[test]
fn a_small_change_changes_the_bits() {
    let other = |world: &mut World| {
        in_order(world);
        world.query::<&mut Wind>().iter_mut(world).next().unwrap().velocity.x += 1e-3;
    };
    assert_ne!(scene(ClothPlugin::default(), other), scene(ClothPlugin::default(), in_order));
}

#[test]
fn the_order_in_which_the_world_stores_others_is_irrelevant() {
    let shuffled = |world: &mut World| {
        let winds: Vec<(Entity, Wind)> = winds().into_iter().map(|wind| (world.spawn_empty().id(), wind)).collect();
        let colliders: Vec<_> = colliders().into_iter().map(|it| (world.spawn_empty().id(), it)).collect();
        for (entity, collider) in colliders.into_iter().rev() {
            world.entity_mut(entity).insert((Name::new("solid"), collider));
        }
        for (entity, wind) in winds.into_iter().rev() {
            world.entity_mut(entity).insert(wind);
        }
    };
    assert_eq!(scene(ClothPlugin::default(), shuffled), scene(ClothPlugin::default(), in_order));
}
