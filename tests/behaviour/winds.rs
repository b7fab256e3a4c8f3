//! Winds blow where and whither their transforms say.

use core::f32::consts::FRAC_PI_2;

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::common::*;

/// Mean velocity after a fifth of a second of a weightless cloth at `place` in `wind`.
fn blown(wind: Wind, transform: Transform, place: Vec3) -> Vec3 {
    let mut app = headless();
    let steady = Wind { gusts: 0.0, turbulence: 0.0, ..wind };
    app.world_mut().spawn((steady, transform));
    // A ball catches wind from all sides.
    let cloth = (Cloth { gravity_scale: 0.0, ..default() }, Transform::from_translation(place));
    let cloth = spawn_cloth(&mut app, Sphere::new(0.3).mesh().ico(3).unwrap(), cloth);
    run(&mut app, 12);
    let velocities: Vec<Vec3> = state(&app, cloth).velocities().collect();
    velocities.iter().sum::<Vec3>() / velocities.len() as f32
}

fn along_x() -> Wind {
    Wind { velocity: Vec3::X * 4.0, ..default() }
}

#[test]
fn a_wind_turns_with_its_transform() {
    let straight = blown(along_x(), Transform::default(), Vec3::ZERO);
    assert!(straight.x > 0.5 && straight.x > 10.0 * straight.yz().length(), "{straight}");
    let turned = Transform::from_rotation(Quat::from_rotation_y(FRAC_PI_2));
    let turned = blown(along_x(), turned, Vec3::ZERO);
    assert!(turned.z < -0.5 && -turned.z > 10.0 * turned.xy().length(), "{turned}");
    let mirrored = blown(along_x(), Transform::from_scale(Vec3::new(-3.0, 1.0, 1.0)), Vec3::ZERO);
    assert_close(mirrored, Vec3::new(-straight.x, straight.y, straight.z), 0.1 * straight.x);
}

#[test]
fn a_wind_blows_in_its_region_only() {
    let at = Transform::from_xyz(10.0, 0.0, 0.0).with_rotation(Quat::from_rotation_z(FRAC_PI_2));
    let regions = [WindShape::Sphere(Sphere::new(2.0)), WindShape::Cuboid(Cuboid::new(3.0, 6.0, 3.0))];
    for region in regions {
        let wind = || Wind { velocity: Vec3::Y * -4.0, region, edge: 0.1, ..default() };
        assert!(blown(wind(), at, Vec3::new(10.5, 0.0, 0.0)).x > 0.5, "{region:?}");
        // To the bit as without it: a ball that is at rest may tremble by what its numbers are rounded.
        let calm = blown(Wind { velocity: Vec3::ZERO, ..wind() }, at, Vec3::new(10.0, 4.0, 0.0));
        assert!(calm.length() < 1e-5, "{calm}");
        assert_eq!(blown(wind(), at, Vec3::new(10.0, 4.0, 0.0)), calm, "{region:?}");
    }
    // The box is long along its own y, which lies along the world's x.
    let long = Wind { velocity: Vec3::Y * -4.0, region: regions[1], edge: 0.1, ..default() };
    assert!(blown(long, at, Vec3::new(12.4, 0.0, 0.0)).x > 0.5);
}

#[test]
fn a_ball_of_wind_is_scaled_as_it_is_seen() {
    // 3 m long along its own x, which lies along the world's y, and half a metre thick.
    let drawn_out = Transform::from_xyz(10.0, 0.0, 0.0)
        .with_rotation(Quat::from_rotation_z(FRAC_PI_2))
        .with_scale(Vec3::new(3.0, -0.5, 0.5));
    let region = WindShape::Sphere(Sphere::new(1.0));
    let wind = Wind { velocity: Vec3::Z * 4.0, region, edge: 0.01, ..default() };
    assert!(blown(wind.clone(), drawn_out, Vec3::new(10.0, 2.4, 0.0)).z > 0.5);
    let calm = blown(Wind { velocity: Vec3::ZERO, ..wind.clone() }, drawn_out, Vec3::new(11.0, 0.0, 0.0));
    assert_eq!(blown(wind, drawn_out, Vec3::new(11.0, 0.0, 0.0)), calm);
}

#[test]
fn winds_add_up() {
    let mut app = headless();
    for velocity in [Vec3::X * 3.0, Vec3::X * -3.0] {
        app.world_mut().spawn(Wind { velocity, gusts: 0.0, turbulence: 0.0, ..default() });
    }
    let cloth = spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 4, 4), Cloth { gravity_scale: 0.0, ..default() });
    run(&mut app, 30);
    assert_close(place(&app, cloth, 0), Vec3::new(-0.5, 0.5, 0.0), 1e-4);
}
