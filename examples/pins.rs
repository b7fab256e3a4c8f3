//! The ways to pin a cloth, and pins that come and go while it runs.

mod common;

use bevy::{math::ops, prelude::*};
use bevy_drape::prelude::*;

fn main() -> AppExit {
    common::app("Pins", "An edge, two corners, chosen by a function, a moving bar, and one that comes and goes")
        .add_plugins(ClothPlugin::default())
        .add_systems(Startup, (common::spawn_scenery, setup))
        .add_systems(FixedUpdate, (swing, let_go))
        .run()
}

/// The bar that two corners are pinned to.
#[derive(Component)]
struct Swinging;

/// The cloth that loses a pin and gets it back.
#[derive(Component)]
struct LettingGo;

fn setup(mut commands: Commands, mut studio: common::Studio) {
    common::spawn_camera(&mut commands, Vec3::new(0.0, 1.6, 4.6), Vec3::new(0.0, 1.3, 0.0));
    let place = |i: i32| Vec3::new(1.15 * i as f32, 1.5, 0.0);
    let bar = studio.spawn_rod(
        &mut commands,
        place(1) + Vec3::new(-0.5, 0.46, 0.0),
        place(1) + Vec3::new(0.5, 0.46, 0.0),
        0.02,
    );
    commands.entity(bar).insert(Swinging);
    let grid = ClothGrid::new(0.9, 0.9, 28, 28);
    // Every ninth vertex of the top row, as rings on a rail would hold it.
    let rings = Pins::predicate(|vertex| vertex.position.y > 0.44 && vertex.index % 9 == 0);
    let cloths = [
        (-2, Pins::edge(ClothEdge::Top), Color::srgb(0.72, 0.20, 0.18)),
        (-1, Pins::edge_corners(ClothEdge::Top), Color::srgb(0.88, 0.62, 0.24)),
        (0, rings, Color::srgb(0.36, 0.52, 0.32)),
        (1, Pins::edge_corners(ClothEdge::Top).to_entity(bar), Color::srgb(0.20, 0.44, 0.62)),
        (2, Pins::indices([grid.vertex(0, 0), grid.vertex(27, 0)]).to_world(), Color::srgb(0.46, 0.30, 0.52)),
    ];
    for (i, pins, color) in cloths {
        let mut cloth = commands.spawn((
            studio.cloth(grid, color),
            Cloth::default(),
            Fabric::COTTON_WOVEN,
            pins,
            Transform::from_translation(place(i)),
        ));
        if i == 2 {
            cloth.insert(LettingGo);
        }
    }
    commands.spawn(Wind { velocity: Vec3::new(0.6, 0.0, 1.2), gusts: 0.8, turbulence: 0.5, ..default() });
}

fn swing(time: Res<Time>, mut bars: Query<&mut Transform, With<Swinging>>) {
    for mut bar in &mut bars {
        bar.translation.z = 0.25 * ops::sin(2.0 * time.elapsed_secs());
    }
}

/// Unpins the right corner for a second out of three.
fn let_go(time: Res<Time>, mut commands: Commands, cloth: Single<Entity, With<LettingGo>>, mut is_free: Local<bool>) {
    let free = time.elapsed_secs() % 3.0 > 2.0;
    if free != *is_free {
        *is_free = free;
        let corner = Pins::indices([27]);
        if free {
            commands.entity(*cloth).unpin_cloth(corner);
        } else {
            commands.entity(*cloth).pin_cloth(corner);
        }
    }
}
