//! Garments of irregular triangles, cut and sewn in code: they hang, or fall on balls.
//!
//! ```text
//! cargo run --all-features --example garments
//! cargo run --all-features --example garments -- dropped --capture captures --frames 300 --every 300
//! ```

#[path = "../common/mod.rs"]
mod common;
mod curve;
mod flat;
mod garment;
mod props;
mod shirt;
mod trousers;
mod wardrobe;

use bevy::{math::primitives::InfinitePlane3d, prelude::*};
use bevy_drape::prelude::*;
use clap::{Parser, ValueEnum};

use wardrobe::{Hook, Item};

#[derive(Parser)]
struct Command {
    /// What is shown
    #[arg(value_enum, default_value = "hung")]
    show: Show,
    #[command(flatten)]
    shared: common::Arguments,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Show {
    /// On a rod, by what each hangs by
    Hung,
    /// Each on a ball
    Dropped,
}

/// Height of the rod, m.
const ROD: f32 = 1.75;

/// Radius of the balls, m.
const BALL: f32 = 0.34;

/// From one ball to the next to the right, and by how much every other one is farther back, m.
const SPACING: Vec2 = Vec2::new(0.80, 0.75);

fn main() -> AppExit {
    let Command { show, shared } = Command::parse();
    common::app_with(shared, "Garments", "Garments of irregular triangles, cut and sewn in code")
        .add_plugins(ClothPlugin::default())
        .add_systems(Startup, common::spawn_scenery)
        .add_systems(Startup, (hang.run_if(move || show == Show::Hung), drop.run_if(move || show == Show::Dropped)))
        .add_systems(Update, display)
        .run()
}

fn hang(mut commands: Commands, mut studio: common::Studio) {
    common::spawn_camera(&mut commands, Vec3::new(0.0, 1.2, 2.85), Vec3::new(0.0, 1.2, 0.0));
    let end = Vec3::new(2.6, ROD, 0.0);
    studio.spawn_rod(&mut commands, end * Vec3::new(-1.0, 1.0, 1.0), end, 0.012);
    for item in wardrobe::items() {
        let place = Transform { translation: item.hung.translation + Vec3::Y * ROD, ..item.hung };
        match item.hook {
            Hook::Hanger => props::spawn_hanger(&mut commands, &mut studio, place, ROD),
            Hook::Hoop => props::spawn_hoop(&mut commands, &mut studio, place, ROD),
            Hook::Pegs(ref pegs) => {
                for &peg in pegs {
                    let at_rod = place.transform_point(peg).with_y(ROD);
                    props::spawn_peg(&mut commands, &mut studio, place.with_translation(at_rod));
                }
            }
        }
        spawn(&mut commands, &mut studio, item, place, true);
    }
}

fn drop(mut commands: Commands, mut studio: common::Studio) {
    common::spawn_camera(&mut commands, Vec3::new(0.0, 1.5, 2.75), Vec3::new(0.0, 0.34, -0.2));
    commands.spawn(ClothCollider::from(InfinitePlane3d::default()));
    let ball = Sphere::new(BALL);
    for (i, item) in wardrobe::items().into_iter().enumerate() {
        let below = Vec3::new(SPACING.x * (i as f32 - 2.0), BALL, -SPACING.y * (i % 2) as f32);
        let stone = studio.solid(ball.mesh().uv(64, 32), Color::srgb(0.55, 0.53, 0.50));
        commands.spawn((stone, ClothCollider::from(ball), Transform::from_translation(below)));
        let top = below + Vec3::Y * BALL;
        let place = Transform { translation: item.dropped.translation + top, ..item.dropped };
        spawn(&mut commands, &mut studio, item, place, false);
    }
}

/// What the display calls it.
#[derive(Component)]
struct Label(String);

fn spawn(commands: &mut Commands, studio: &mut common::Studio, item: Item, place: Transform, is_hung: bool) {
    let fabric = Fabric::PRESETS.into_iter().find(|preset| preset.fabric == item.fabric);
    let fabric = fabric.map_or_else(String::new, |preset| preset.name.replace('_', " "));
    commands.spawn((
        studio.cloth(item.mesh, item.color),
        Cloth {
            self_collision: true,
            // They meet themselves and what they fall on, and not each other.
            collision_layers: 2,
            collision_mask: 1,
            ..default()
        },
        item.fabric,
        if is_hung { item.hook.pins() } else { Pins::none() },
        place,
        Label(format!("{}, {fabric}", item.name)),
    ));
}

fn display(cloths: Query<(&Label, &ClothState, &ClothReport)>, mut overlay: ResMut<common::Overlay>) {
    let lines = cloths.iter().filter_map(|(label, state, report)| {
        let (strain, substeps) = (100.0 * state.strain().largest, report.latest()?.substeps);
        let particles = state.particle_count();
        Some(format!("{}: {particles} particles, {substeps} substeps, stretched by {strain:.1} % at most", label.0))
    });
    overlay.readings = lines.collect::<Vec<_>>().join("\n");
}
