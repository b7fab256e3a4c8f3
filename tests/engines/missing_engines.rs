//! Any order of plugins will do, and without one of them nothing panics.

use avian3d::prelude::PhysicsPlugins;
use bevy::prelude::*;
use bevy_drape::prelude::*;
use bevy_rapier3d::prelude as rapier;

use crate::{
    common::*,
    engine::{Engine, Form, avian_plugins, rapier_plugins},
    places::patch,
};

#[test]
fn without_an_engine_or_cloth_nothing_panics() {
    run(&mut headless_with((ClothPlugin::default(), ClothAvianPlugin, ClothRapierPlugin)), 3);
    run(&mut headless_with((PhysicsPlugins::default(), ClothAvianPlugin)), 3);
    let rapier = rapier::RapierPhysicsPlugin::<rapier::NoUserData>::default();
    run(&mut headless_with((rapier, ClothRapierPlugin)), 3);
}

/// Heights of patches that fell on a box of Avian's and on one of Rapier's.
fn heights(mut app: App) -> [f32; 2] {
    app.update();
    let cube = Form::Cuboid(Vec3::splat(0.3));
    Engine::Avian.fixed(&mut app, &cube, Transform::from_xyz(-1.0, 0.0, 0.0));
    Engine::Rapier.fixed(&mut app, &cube, Transform::from_xyz(1.0, 0.1, 0.0));
    let patches = [-1.0, 1.0].map(|x| patch(&mut app, Vec3::new(x, 0.5, 0.0)));
    run(&mut app, 40);
    patches.map(|patch| place(&app, patch, 12).y)
}

#[test]
fn both_engines_are_met_in_any_order_of_plugins() {
    let expected = [0.306, 0.406];
    let apps = [
        headless_with((ClothPlugin::default(), avian_plugins(), rapier_plugins())),
        headless_with((rapier_plugins(), avian_plugins(), ClothPlugin::default())),
    ];
    for app in apps {
        let heights = heights(app);
        for (height, expected) in heights.into_iter().zip(expected) {
            assert!((height - expected).abs() < 2e-3, "{heights:?}");
        }
    }
}
