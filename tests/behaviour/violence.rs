//! What pulls and pushes harder than anything in a game leaves cloth whole: it isn't put back and comes to rest again.

use bevy::{asset::RenderAssetUsages, mesh::PrimitiveTopology, prelude::*};
use bevy_drape::prelude::*;

use crate::common::*;

fn put_back(app: &App) -> usize {
    let reset = &app.world().resource::<Heard>().reset;
    reset.iter().filter(|(_, cause)| *cause == ResetCause::NotFinite).count()
}

/// How far from the world's origin a cloth has come, m.
fn farthest(app: &App, cloth: Entity) -> f32 {
    positions(app, cloth).into_iter().map(Vec3::length).fold(0.0, f32::max)
}

#[test]
fn an_explicit_cloth_whose_pins_jump_by_fifty_metres_comes_after_them() {
    let mut app = headless();
    let cloth = Cloth { solver: ClothSolver::Explicit, max_substeps: 64, ..default() };
    let fabric = Fabric { warp_stiffening: 10.0, shear_stiffness: 300.0, damping: 1.0, ..default() };
    let cloth = spawn_cloth(&mut app, ClothGrid::new(0.5, 0.5, 6, 6), (cloth, fabric, Pins::corners()));
    run(&mut app, 10);
    for x in [50.0, 0.0, 50.0, 0.0] {
        get_mut::<Transform>(&mut app, cloth).translation.x = x;
        run(&mut app, 20);
    }
    run(&mut app, 200);
    assert_eq!(put_back(&app), 0);
    assert!(farthest(&app, cloth) < 1.0, "{} m", farthest(&app, cloth));
}

#[test]
fn an_explicit_cloth_that_is_cut_down_to_few_substeps_survives_steps_of_any_length() {
    let mut app = headless();
    let cloth = Cloth { solver: ClothSolver::Explicit, max_substeps: 8, ..default() };
    let stiff = Fabric { warp_stiffness: 8000.0, warp_stiffening: 10.0, bending_rigidity: 0.0, ..default() };
    spawn_cloth(
        &mut app,
        Cylinder::new(0.2, 0.5).mesh().resolution(3).segments(3),
        (cloth, stiff, Pins::indices([9, 10])),
    );
    app.world_mut().resource_mut::<Time<Virtual>>().set_max_delta(core::time::Duration::from_secs(10));
    for step in [0.0015, 0.9, 0.008, 0.08, 2.7, 0.008, 1.3, 0.03, 0.005, 0.0004, 0.05].into_iter().cycle().take(220) {
        set_rates(&mut app, step, step);
        run(&mut app, 1);
    }
    assert_eq!(put_back(&app), 0);
}

#[test]
fn a_hand_that_holds_a_pin_throws_nothing() {
    for solver in [ClothSolver::Strands, ClothSolver::Explicit] {
        let mut app = headless();
        let cloth = spawn_cloth(
            &mut app,
            ClothGrid::new(0.5, 0.5, 6, 6),
            (Cloth { solver, ..default() }, Pins::indices([0, 5])),
        );
        run(&mut app, 30);
        let triangles = state(&app, cloth).triangles().to_vec();
        let triangle = (0..).zip(&triangles).find(|(_, corners)| corners.contains(&0)).map_or(0, |(number, _)| number);
        let weight = |corner: u32| if corner == 0 { 1.0 } else { 1e-5 };
        let weights = Vec3::from(triangles[triangle as usize].map(weight));
        let grab = take_hold(&mut app, cloth, ClothPoint { triangle, weights }, ClothGrip::default());
        lead(&mut app, cloth, grab.expect("the point is on the triangle"), Vec3::Z * 3.0);
        run(&mut app, 60);
        let fastest = fastest(&app, cloth);
        assert!(fastest < 5.0, "{solver:?}: {fastest} m/s");
        assert_eq!(put_back(&app), 0, "{solver:?}");
    }
}

fn fastest(app: &App, cloth: Entity) -> f32 {
    state(app, cloth).velocities().map(Vec3::length).fold(0.0, f32::max)
}

#[test]
fn damped_bends_of_a_cloth_that_is_torn_apart_by_its_pins_throw_nothing() {
    let mut app = headless();
    let post = app.world_mut().spawn(Transform::default()).id();
    // A narrow strip whose pins come to be much farther apart than it is long.
    let fabric = Fabric { density: 0.05, bending_rigidity: 8e-5, bend_damping: 0.01, ..default() };
    let pins = Pins::indices([60, 14]).to_entity(post).and(Pins::indices([17]));
    let cloth = spawn_cloth(&mut app, ClothGrid::new(0.002, 0.06, 2, 40), (fabric, pins));
    run(&mut app, 5);
    for frame in 0..90 {
        let angle = 0.15 * frame as f32;
        get_mut::<Transform>(&mut app, post).translation = Vec3::new(ops::sin(angle), 1.0 - ops::cos(angle), 0.0) * 0.5;
        run(&mut app, 1);
    }
    assert_eq!(put_back(&app), 0);
    assert!(farthest(&app, cloth) < 5.0, "{} m", farthest(&app, cloth));
}

#[test]
fn a_strip_that_a_pin_pulls_out_to_hundreds_of_metres_comes_after_it() {
    let mut app = headless();
    let post = app.world_mut().spawn(Transform::default()).id();
    let fabric = Fabric {
        density: 1.0,
        warp_stiffness: 47.0,
        weft_stiffness: 960.0,
        warp_stiffening: 17.0,
        weft_stiffening: 17.0,
        shear_stiffness: 40.0,
        ..default()
    };
    // The middle of its first row is between two pins.
    let pins = Pins::edge(ClothEdge::Left).and(Pins::indices([2]).to_entity(post));
    spawn_cloth(&mut app, ClothGrid::new(0.015, 0.15, 3, 17), (fabric, pins));
    run(&mut app, 5);
    for way in [Vec3::new(400.0, 590.0, -190.0), Vec3::ZERO, Vec3::new(-700.0, 3.0, 1.0), Vec3::ZERO] {
        get_mut::<Transform>(&mut app, post).translation = way;
        run(&mut app, 20);
    }
    assert_eq!(put_back(&app), 0);
}

/// Triangles in a row, 0.3 m long.
fn triangle_strip(count: u32) -> Mesh {
    let step = 0.3 / count as f32;
    let places: Vec<[f32; 3]> = (0..count).map(|i| [(i % 2) as f32 * 2.0 * step, i as f32 * -step, 0.0]).collect();
    Mesh::new(PrimitiveTopology::TriangleStrip, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, places)
}

#[test]
fn a_cloth_that_is_scaled_up_bends_as_calmly_as_before() {
    let mut app = headless();
    let cloth = Cloth { substeps: Some(1), gravity_scale: 0.1, ..default() };
    let fabric = Fabric { density: 0.128, bending_rigidity: 1e-5, bend_damping: 0.0, ..default() };
    let cloth = spawn_cloth(&mut app, triangle_strip(78), (cloth, fabric, Pins::none()));
    run(&mut app, 5);
    get_mut::<Transform>(&mut app, cloth).scale = Vec3::splat(2.2);
    run(&mut app, 120);
    assert_eq!(put_back(&app), 0);
    assert!(fastest(&app, cloth) < 5.0, "{} m/s", fastest(&app, cloth));
}

#[test]
fn a_copy_of_a_cloth_that_meets_cloth_parts_from_it() {
    for pins in [Pins::none(), Pins::indices([1]).to_world()] {
        let mut app = headless();
        let cloth = Cloth { self_collision: true, gravity_scale: 0.2, ..default() };
        let cloth = spawn_cloth(&mut app, ClothGrid::new(0.25, 0.4, 2, 4), (cloth, pins));
        run(&mut app, 20);
        let copy = app.world_mut().entity_mut(cloth).clone_and_spawn();
        for _ in 0..60 {
            run(&mut app, 1);
            for cloth in [cloth, copy] {
                assert!(fastest(&app, cloth) < 20.0, "{} m/s", fastest(&app, cloth));
            }
        }
        assert_eq!(put_back(&app), 0);
    }
}

#[test]
fn what_is_pinned_to_an_entity_of_infinite_size_is_drawn_as_it_was() {
    let mut app = headless();
    let post = app.world_mut().spawn(Transform::default()).id();
    let cloth = spawn_cloth(&mut app, ClothGrid::new(0.5, 0.5, 4, 4), Pins::corners().to_entity(post));
    run(&mut app, 10);
    for scale in [f32::INFINITY, f32::NAN, 1e38] {
        get_mut::<Transform>(&mut app, post).scale = Vec3::splat(scale);
        run(&mut app, 3);
        assert!(points(drawn(&app, cloth)).into_iter().all(Vec3::is_finite), "a scale of {scale}");
    }
}

#[test]
fn a_wind_blows_at_the_end_of_the_world() {
    let mut app = headless();
    app.world_mut().spawn(Wind { velocity: Vec3::Z * 1e6, gusts: 1.0, gust_period: 0.0, eddy_size: 0.0, ..default() });
    let far = Transform::from_xyz(1e12, 0.0, -1e12);
    let cloth = spawn_cloth(&mut app, ClothGrid::new(0.5, 0.5, 4, 4), (Pins::corners(), far));
    run(&mut app, 30);
    assert!(positions(&app, cloth).into_iter().all(Vec3::is_finite));
}
