//! Cloth runs in the schedule that the plugin is given, by that schedule's time.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::common::*;

const GRID: ClothGrid = ClothGrid { size: Vec2::splat(0.4), particles: UVec2::new(4, 4), lying: false };

/// Height that a free cloth has lost after `frames` updates.
fn fall(app: &mut App, frames: usize) -> f32 {
    let cloth = spawn_cloth(app, GRID, undamped());
    run(app, frames);
    let rest = points(&GRID.into())[0].y;
    rest - place(app, cloth, 0).y
}

#[track_caller]
fn assert_near(a: f32, b: f32, share: f32) {
    assert!((a / b - 1.0).abs() < share, "{a} and {b}");
}

#[test]
fn any_schedule_will_do() {
    let expected = fall(&mut headless(), 60);
    assert_near(expected, 0.5 * 9.81, 0.01);
    for plugin in [
        ClothPlugin::new(FixedUpdate),
        ClothPlugin::new(FixedFirst),
        ClothPlugin::new(Update),
        ClothPlugin::new(PostUpdate),
        ClothPlugin::new(PreUpdate),
    ] {
        assert_near(fall(&mut headless_with(plugin), 60), expected, 0.04);
    }
}

#[test]
fn a_fixed_schedule_runs_as_often_as_its_time_asks() {
    let mut app = headless();
    set_rates(&mut app, 1.0 / 64.0, 1.0 / 128.0);
    let cloth = spawn_cloth(&mut app, GRID, undamped());
    run(&mut app, 64);
    let velocity = state(&app, cloth).velocity(0).unwrap().y;
    assert_near(velocity, -9.81, 0.01);
}

#[test]
fn another_schedule_follows_the_frame_rate() {
    let mut app = headless_with(ClothPlugin::new(Update));
    set_rates(&mut app, 1.0 / 30.0, 1.0 / 60.0);
    assert_near(fall(&mut app, 30), 0.5 * 9.81, 0.02);
}

#[test]
fn paused_time_stops_the_cloth_and_keeps_its_forces() {
    for plugin in [ClothPlugin::default(), ClothPlugin::new(Update)] {
        let mut app = headless_with(plugin);
        let cloth = spawn_cloth(&mut app, GRID, undamped());
        run(&mut app, 10);
        app.world_mut().resource_mut::<Time<Virtual>>().pause();
        run(&mut app, 1);
        let before = (positions(&app, cloth), state(&app, cloth).velocity(0));
        get_mut::<ClothState>(&mut app, cloth).add_force(0, Vec3::X);
        run(&mut app, 30);
        assert_eq!((positions(&app, cloth), state(&app, cloth).velocity(0)), before);
        app.world_mut().resource_mut::<Time<Virtual>>().unpause();
        run(&mut app, 1);
        assert!(place(&app, cloth, 0).x > before.0[0].x + 1e-4, "{plugin:?}");
    }
}

#[test]
fn half_the_speed_is_half_the_time() {
    for plugin in [ClothPlugin::default(), ClothPlugin::new(Update)] {
        let mut app = headless_with(plugin);
        app.world_mut().resource_mut::<Time<Virtual>>().set_relative_speed(0.5);
        // Half of a step in whole nanoseconds is a little short: the last step may be left out.
        assert_near(fall(&mut app, 120), 0.5 * 9.81, 0.04);
    }
}

#[test]
fn systems_of_a_game_can_be_ordered_around_the_stages() {
    #[derive(Resource, Default)]
    struct Heights(Vec<f32>);
    let look = |cloth: Single<&ClothState>, mut heights: ResMut<Heights>| {
        heights.0.extend(cloth.position(0).map(|place| place.y));
    };
    let mut app = headless();
    app.init_resource::<Heights>()
        .add_systems(FixedPostUpdate, (look.before(ClothSystems::Simulate), look.after(ClothSystems::Finalize)));
    spawn_cloth(&mut app, GRID, ());
    run(&mut app, 1);
    let heights = &app.world().resource::<Heights>().0;
    assert_eq!(heights.len(), 2);
    assert!(heights[1] < heights[0]);
}
