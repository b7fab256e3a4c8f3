//! The eight presets side by side: a piece of each, 45 cm square, hung up by its middle.

mod common;

use bevy::prelude::*;
use bevy_drape::prelude::*;

/// In the order of their bending length.
const HELP: &str = "Above: jersey, silk, wool flannel, polyester. Below: woven cotton, denim, rubber, leather";

/// Side of each piece, m, and particles along it.
const SIDE: f32 = 0.45;
const PARTICLES: u32 = 41;

/// From one hook to the next, m.
const SPACING: f32 = 0.42;

/// Heights of the two rails, m.
const RAILS: [f32; 2] = [1.25, 0.75];

fn main() -> AppExit {
    common::app("Fabrics", HELP)
        .add_plugins(ClothPlugin::default())
        .add_systems(Startup, (common::spawn_scenery, setup))
        .run()
}

fn setup(mut commands: Commands, mut studio: common::Studio) {
    let mut presets = Vec::from(Fabric::PRESETS);
    presets.sort_by(|a, b| a.fabric.bending_length().total_cmp(&b.fabric.bending_length()));
    common::spawn_camera(&mut commands, Vec3::new(0.0, 1.0, 1.75), Vec3::new(0.0, 0.88, 0.0));
    for height in RAILS {
        let end = Vec3::new(2.0 * SPACING, height + 0.012, 0.0);
        studio.spawn_rod(&mut commands, end * Vec3::new(-1.0, 1.0, 1.0), end, 0.012);
    }
    let grid = ClothGrid::new(SIDE, SIDE, PARTICLES, PARTICLES).lying();
    let middle = PARTICLES / 2;
    // What a hook takes hold of: 2 cm of the cloth.
    let hook = (middle - 1..=middle + 1).flat_map(|row| (middle - 1..=middle + 1).map(move |column| (column, row)));
    let hook: Vec<u32> = hook.map(|(column, row)| grid.vertex(column, row)).collect();
    for (i, preset) in presets.into_iter().enumerate() {
        let place = Vec3::new(SPACING * ((i % 4) as f32 - 1.5), RAILS[i / 4], 0.0);
        commands.spawn((
            studio.cloth(grid, color_of(preset.name)),
            Cloth::default(),
            // Loses its swing sooner than in a game, so that it hangs when one looks.
            Fabric { damping: 1.0, ..preset.fabric },
            Pins::indices(hook.clone()),
            Transform::from_translation(place).with_rotation(Quat::from_rotation_y(0.4)),
        ));
    }
}

fn color_of(name: &str) -> Color {
    match name {
        "silk" => Color::srgb(0.72, 0.16, 0.30),
        "cotton_jersey" => Color::srgb(0.55, 0.57, 0.60),
        "wool_flannel" => Color::srgb(0.24, 0.26, 0.30),
        "polyester_tablecloth" => Color::srgb(0.88, 0.86, 0.80),
        "cotton_woven" => Color::srgb(0.40, 0.56, 0.74),
        "denim" => Color::srgb(0.14, 0.20, 0.36),
        "leather" => Color::srgb(0.40, 0.22, 0.12),
        _ => Color::srgb(0.10, 0.10, 0.11),
    }
}
