//! Bevy's diagnostics know what cloths cost, as of the latest step and no older one.

use bevy::{
    diagnostic::{Diagnostic, DiagnosticPath, DiagnosticsStore},
    prelude::*,
};
use bevy_drape::{debug::ClothDiagnosticsPlugin, prelude::*};

use crate::common::*;

const ALL: [DiagnosticPath; 4] = [
    ClothDiagnosticsPlugin::STEP_TIME,
    ClothDiagnosticsPlugin::CLOTHS,
    ClothDiagnosticsPlugin::PARTICLES,
    ClothDiagnosticsPlugin::CONTACTS,
];

fn diagnostic(app: &App, path: DiagnosticPath) -> &Diagnostic {
    app.world().resource::<DiagnosticsStore>().get(&path).expect("it is registered")
}

fn value(app: &App, path: DiagnosticPath) -> f64 {
    diagnostic(app, path).value().expect("it was measured")
}

fn measured(app: &App) -> usize {
    let counts = ALL.map(|path| diagnostic(app, path).history_len());
    assert!(counts.iter().all(|&count| count == counts[0]), "all are measured at once: {counts:?}");
    counts[0]
}

fn measuring(plugin: ClothPlugin) -> App {
    // Before the plugin that it measures: the order doesn't matter.
    headless_with((ClothDiagnosticsPlugin, plugin))
}

#[test]
fn the_latest_step_is_measured() {
    let mut app = measuring(ClothPlugin::default());
    let lying = ClothGrid::new(1.0, 1.0, 8, 8).lying();
    let above = |height| Transform::from_xyz(0.0, height, 0.0);
    let cloths = [0.05, 0.3].map(|height| spawn_cloth(&mut app, lying, above(height)));
    let failed = spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 3, 3), Cloth { substeps: Some(0), ..default() });
    app.world_mut().spawn(ClothCollider::from(Sphere::new(0.05)));
    app.world_mut().spawn((ClothCollider::from(Cuboid::new(3.0, 1.0, 3.0)), above(-0.5)));
    run(&mut app, 60);
    let contacts: u32 = cloths.iter().map(|&cloth| report(&app, cloth).contacts).sum();
    let step_time = |cloth| get::<ClothReport>(&app, cloth).step_time().as_secs_f64() * 1e3;
    let time: f64 = cloths.into_iter().map(step_time).sum();
    assert!(contacts > 50 && time > 0.0);
    assert_eq!(value(&app, ClothDiagnosticsPlugin::CONTACTS), f64::from(contacts));
    assert_eq!(value(&app, ClothDiagnosticsPlugin::STEP_TIME), time);
    let most = cloths.iter().map(|&cloth| report(&app, cloth).substeps).max().unwrap();
    assert_eq!(value(&app, ClothDiagnosticsPlugin::SUBSTEPS), f64::from(most));
    assert_eq!(value(&app, ClothDiagnosticsPlugin::CLOTHS), 2.0);
    assert_eq!(value(&app, ClothDiagnosticsPlugin::PARTICLES), 128.0);
    assert_eq!(diagnostic(&app, ClothDiagnosticsPlugin::STEP_TIME).suffix, "ms");
    assert!(matches!(get(&app, failed), ClothStatus::Failed(_)));

    for cloth in cloths {
        app.world_mut().despawn(cloth);
    }
    run(&mut app, 1);
    assert_eq!(ALL.map(|path| value(&app, path)), [0.0; 4]);
}

#[test]
fn each_step_is_measured_once_and_nothing_between_steps() {
    let mut app = measuring(ClothPlugin::default());
    spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 4, 4), Pins::corners());
    let mut measured_in = |update: f64, step: f64, frames| {
        set_rates(&mut app, update, step);
        run(&mut app, 2);
        let before = measured(&app);
        run(&mut app, frames);
        measured(&app) - before
    };
    assert_eq!(measured_in(1.0 / 64.0, 1.0 / 64.0, 10), 10);
    assert_eq!(measured_in(1.0 / 64.0, 1.0 / 16.0, 20), 5, "four frames a step");
    assert_eq!(measured_in(1.0 / 16.0, 1.0 / 64.0, 5), 20, "four steps a frame");
}

#[test]
fn nothing_is_measured_while_time_stands_still() {
    for plugin in [ClothPlugin::default(), ClothPlugin::new(Update)] {
        let mut app = measuring(plugin);
        spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 4, 4), Pins::corners());
        run(&mut app, 5);
        assert_eq!(measured(&app), 5, "{plugin:?}");
        app.world_mut().resource_mut::<Time<Virtual>>().pause();
        run(&mut app, 5);
        assert_eq!(measured(&app), 5, "{plugin:?}");
    }
}

#[test]
fn a_diagnostic_that_is_off_is_not_measured() {
    let mut app = measuring(ClothPlugin::default());
    let mut store = app.world_mut().resource_mut::<DiagnosticsStore>();
    store.get_mut(&ClothDiagnosticsPlugin::CONTACTS).unwrap().is_enabled = false;
    run(&mut app, 3);
    assert_eq!(diagnostic(&app, ClothDiagnosticsPlugin::CONTACTS).history_len(), 0);
    assert_eq!(diagnostic(&app, ClothDiagnosticsPlugin::CLOTHS).history_len(), 3);
}
