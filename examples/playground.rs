//! The main scene: a curtain in the wind, a cloth on a ball, one on a box, and a flag that a glTF file brings.
//!
//! ```text
//! cargo run --all-features --example playground
//! cargo run --all-features --example playground -- --capture captures --frames 240 --every 240
//! cargo run --all-features --example playground -- --panel
//! ```

mod common;

use core::f32::consts::FRAC_PI_2;

use bevy::{
    math::{ops, primitives::InfinitePlane3d},
    prelude::*,
};
use bevy_drape::{
    debug::{ClothDebugPlugin, ClothDiagnosticsPlugin},
    panel::{ClothPanel, ClothPanelPlugin},
    prelude::*,
};
use clap::Parser;

/// A curtain in the wind, cloths on a ball and a box, and a flag.
#[derive(Parser)]
#[command(version, args_override_self = true)]
struct Command {
    /// Open the panel from the beginning
    #[arg(long)]
    panel: bool,

    #[command(flatten)]
    shared: common::Arguments,
}

fn main() -> AppExit {
    let Command { panel, shared } = Command::parse();
    common::app_with(
        shared,
        "bevy_drape playground",
        "Drag cloth, or the view   Right drag: shift   Wheel: zoom   R: reset   W: wind   Space: pause   F1: panel",
    )
    .add_plugins((ClothPlugin::default(), ClothPickingPlugin))
    .add_plugins((ClothPanelPlugin::default(), ClothDebugPlugin, ClothDiagnosticsPlugin))
    .add_systems(Startup, (common::spawn_scenery, setup))
    .add_systems(FixedUpdate, slide_rings)
    .add_systems(Update, (reset, calm, pause, common::rest_camera_while_dragging))
    .add_systems(Update, open_panel.run_if(move || panel))
    .run()
}

fn setup(mut commands: Commands, mut studio: common::Studio, server: Res<AssetServer>) {
    common::spawn_camera(&mut commands, Vec3::new(0.5, 1.5, 4.7), Vec3::new(0.15, 1.1, -0.2));
    commands.spawn(ClothCollider::from(InfinitePlane3d::default()));

    spawn_curtain(&mut commands, &mut studio);
    spawn_draped(
        &mut commands,
        &mut studio,
        "Drape on the ball",
        Sphere::new(0.36),
        Vec3::new(-0.75, 0.36, 0.9),
        Color::srgb(0.16, 0.38, 0.62),
    );
    spawn_draped(
        &mut commands,
        &mut studio,
        "Drape on the box",
        Cuboid::new(0.7, 0.6, 0.7),
        Vec3::new(0.75, 0.3, 0.7),
        Color::srgb(0.88, 0.72, 0.32),
    );
    spawn_flag(&mut commands, &mut studio, &server);
    // Each wind blows in a box of its own and leaves the two cloths in front alone.
    spawn_wind(&mut commands, Vec3::new(0.4, 0.0, 1.6), Vec3::new(-1.3, 1.3, -0.9));
    spawn_wind(&mut commands, Vec3::new(6.0, 0.0, 1.2), Vec3::new(2.1, 2.0, -0.9));
}

fn spawn_wind(commands: &mut Commands, velocity: Vec3, place: Vec3) {
    let region = WindShape::Cuboid(Cuboid::new(2.6, 2.8, 2.6));
    commands.spawn((
        Wind { velocity, region, edge: 0.3, gusts: 0.6, turbulence: 0.25, ..default() },
        Transform::from_translation(place),
    ));
}

/// A ring that slides on the curtain's rod.
#[derive(Component)]
struct Ring {
    middle: Vec3,
    side: f32,
}

/// A curtain that two corners hold on a rod, by rings that slide to and fro.
fn spawn_curtain(commands: &mut Commands, studio: &mut common::Studio) {
    let grid = ClothGrid::new(1.5, 1.8, 46, 54);
    let middle = Vec3::new(-1.3, 2.2, -0.9);
    studio.spawn_rod(commands, middle - Vec3::X * 0.8, middle + Vec3::X * 0.8, 0.018);
    let mut ring = |side: f32| {
        let torus = studio.solid(Torus::new(0.02, 0.035), Color::srgb(0.75, 0.62, 0.35));
        let place = Transform::from_translation(middle + Vec3::X * 0.75 * side);
        let upright = place.with_rotation(Quat::from_rotation_z(FRAC_PI_2));
        commands.spawn((torus, Ring { middle, side }, upright)).id()
    };
    let left = Pins::indices([grid.vertex(0, 0)]).to_entity(ring(-1.0));
    let right = Pins::indices([grid.vertex(45, 0)]).to_entity(ring(1.0));
    commands.spawn((
        studio.cloth(grid, Color::srgb(0.72, 0.16, 0.14)),
        Cloth::default(),
        Fabric::COTTON_WOVEN,
        left.and(right),
        Transform::from_translation(middle - Vec3::Y * 0.93),
        Name::new("Curtain"),
    ));
}

fn slide_rings(time: Res<Time>, mut rings: Query<(&Ring, &mut Transform)>) {
    let reach = 0.58 + 0.17 * ops::cos(0.8 * time.elapsed_secs());
    for (ring, mut transform) in &mut rings {
        transform.translation = ring.middle + Vec3::X * ring.side * reach;
    }
}

/// A cloth that falls on an obstacle.
fn spawn_draped<S>(
    commands: &mut Commands,
    studio: &mut common::Studio,
    name: &'static str,
    solid: S,
    place: Vec3,
    color: Color,
) where
    S: Into<Mesh> + Into<ClothCollider> + Copy,
{
    commands.spawn((
        studio.solid(solid, Color::srgb(0.82, 0.80, 0.76)),
        Into::<ClothCollider>::into(solid),
        Transform::from_translation(place),
    ));
    commands.spawn((
        studio.cloth(ClothGrid::new(1.25, 1.25, 48, 48).lying(), color),
        Cloth { collision_margin: 0.008, ..default() },
        Fabric::COTTON_WOVEN,
        Transform::from_translation(place + Vec3::Y * 0.75).with_rotation(Quat::from_rotation_y(0.5)),
        Name::new(name),
    ));
}

/// A pole, and a model that says itself that it is cloth, of which fabric, and where it is held.
fn spawn_flag(commands: &mut Commands, studio: &mut common::Studio, server: &AssetServer) {
    let foot = Vec3::new(1.25, 0.0, -0.9);
    studio.spawn_rod(commands, foot, foot + Vec3::Y * 2.5, 0.025);
    commands.spawn((
        WorldAssetRoot(server.load(GltfAssetLabel::Scene(0).from_asset("flag.glb"))),
        Transform::from_translation(foot + Vec3::new(0.03, 2.45, 0.0)),
    ));
}

fn reset(keys: Res<ButtonInput<KeyCode>>, mut commands: Commands, cloths: Query<Entity, With<Cloth>>) {
    if keys.just_pressed(KeyCode::KeyR) {
        for cloth in &cloths {
            commands.entity(cloth).reset_cloth();
        }
    }
}

/// Turns the wind off and on again.
fn calm(keys: Res<ButtonInput<KeyCode>>, mut winds: Query<&mut Wind>, mut calmed: Local<Vec3>) {
    if keys.just_pressed(KeyCode::KeyW) {
        for mut wind in &mut winds {
            core::mem::swap(&mut wind.velocity, &mut calmed);
        }
    }
}

/// Opens the panel once time goes on: while a capture loads, its picture is too small for a window.
fn open_panel(mut panel: ResMut<ClothPanel>, time: Res<Time>, mut is_done: Local<bool>) {
    if time.delta_secs() > 0.0 && !core::mem::replace(&mut *is_done, true) {
        panel.open = true;
    }
}

fn pause(keys: Res<ButtonInput<KeyCode>>, mut time: ResMut<Time<Virtual>>) {
    if keys.just_pressed(KeyCode::Space) {
        if time.is_paused() { time.unpause() } else { time.pause() }
    }
}
