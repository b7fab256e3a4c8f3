//! Pause, single step and slow motion of the game's clock.

use bevy::prelude::*;
use bevy_drape::prelude::*;
use bevy_egui::egui::accesskit::Role;

use crate::common::*;

/// How often each thing has run.
#[derive(Resource, Default, Debug)]
struct Counts {
    steps: u32,
    time: f32,
}

fn counting() -> (App, Entity) {
    let mut app = app();
    app.init_resource::<Counts>().add_systems(
        FixedPostUpdate,
        (|mut counts: ResMut<Counts>, time: Res<Time>| {
            counts.steps += 1;
            counts.time += time.delta_secs();
        })
        .in_set(ClothSystems::Simulate),
    );
    let cloth = spawn_cloth(&mut app, "Curtain", Pins::none());
    (app, cloth)
}

#[test]
fn pause_stops_the_cloth_and_a_step_moves_it_by_one() {
    let (app, cloth) = counting();
    let mut desk = Desk::new(app);
    let height = |desk: &Desk| desk.get::<ClothState>(cloth).position(0).expect("a particle").y;
    desk.click(Role::Button, "Pause");
    assert!(desk.resource::<Time<Virtual>>().is_paused());
    let (before, steps) = (height(&desk), desk.resource::<Counts>().steps);
    desk.frames(10);
    assert_eq!((height(&desk), desk.resource::<Counts>().steps), (before, steps));
    for n in 1..=3 {
        let (before, overstep) = (height(&desk), desk.resource::<Time<Fixed>>().overstep());
        desk.click(Role::Button, "Step");
        desk.frames(5);
        assert_eq!(desk.resource::<Counts>().steps, steps + n);
        assert!(height(&desk) < before);
        assert_eq!(desk.resource::<Time<Fixed>>().overstep(), overstep, "nothing of a step is left over");
    }
    assert!(
        (desk.resource::<Counts>().time / desk.resource::<Counts>().steps as f32 - step().as_secs_f32()).abs() < 1e-6
    );
    desk.click(Role::Button, "Resume");
    desk.frames(5);
    assert!(desk.resource::<Counts>().steps >= steps + 3 + 5);
}

#[test]
fn a_step_is_one_step_with_time_left_over_and_at_any_speed() {
    let (mut app, _) = counting();
    app.world_mut().resource_mut::<Time<Fixed>>().accumulate_overstep(step().mul_f32(0.99));
    let mut desk = Desk::new(app);
    desk.type_value("Game speed", "0.1");
    desk.click(Role::Button, "Pause");
    let steps = desk.resource::<Counts>().steps;
    desk.click(Role::Button, "Step");
    desk.frames(4);
    assert_eq!(desk.resource::<Counts>().steps, steps + 1);
}

#[test]
fn a_step_is_one_step_also_for_cloth_that_steps_once_a_frame() {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), bevy::mesh::MeshPlugin))
        .add_plugins((ClothPlugin::new(Update), bevy_drape::panel::ClothPanelPlugin { window: false, ..default() }))
        .init_resource::<Heard>();
    app.finish();
    app.cleanup();
    let cloth = spawn_cloth(&mut app, "Curtain", Pins::none());
    let mut desk = Desk::new(app);
    desk.click(Role::Button, "Pause");
    let before = desk.get::<ClothState>(cloth).velocity(0).expect("a particle").y;
    desk.click(Role::Button, "Step");
    desk.frames(4);
    let after = desk.get::<ClothState>(cloth).velocity(0).expect("a particle").y;
    let gained = (after - before) / (-9.81 * desk.resource::<Time<Fixed>>().timestep().as_secs_f32());
    assert!((gained - 1.0).abs() < 0.05, "the speed of one step: {gained}");
}

#[test]
fn a_step_cant_be_asked_for_while_the_clock_runs() {
    let (app, _) = counting();
    let mut desk = Desk::new(app);
    let steps = desk.resource::<Counts>().steps;
    desk.click(Role::Button, "Step");
    desk.frames(3);
    assert_eq!(desk.resource::<Counts>().steps, steps + 4);
}

#[test]
fn slow_motion_slows_the_games_clock() {
    let (app, _) = counting();
    let mut desk = Desk::new(app);
    desk.type_value("Game speed", "0.25");
    assert_eq!(desk.resource::<Time<Virtual>>().relative_speed(), 0.25);
    let steps = desk.resource::<Counts>().steps;
    desk.frames(40);
    assert_eq!(desk.resource::<Counts>().steps, steps + 10);
}
