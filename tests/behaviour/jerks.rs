//! Cloth that is jerked, flat to the last bit or not, finds back to its length.

use core::f32::consts::FRAC_PI_2;

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::common::*;

/// A cape of 0.5 m x 1 m on its upper edge, after two seconds at rest.
fn cape(app: &mut App) -> Entity {
    let cape = spawn_cloth(app, ClothGrid::new(0.5, 1.0, 12, 24), Pins::edge(ClothEdge::Top));
    run(app, 120);
    cape
}

/// By how much the most stretched side of a triangle is longer than at rest, no unit.
fn largest_stretch(app: &App, cloth: Entity) -> f32 {
    state(app, cloth).strain().largest
}

#[test]
fn a_dash_leaves_no_cell_stretched() {
    for direction in [Vec3::X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z] {
        let mut app = headless();
        let cape = cape(&mut app);
        // 20 m/s for a quarter of a second.
        for frame in 1..=15 {
            get_mut::<Transform>(&mut app, cape).translation = direction * (frame as f32 * 20.0 * STEP);
            run(&mut app, 1);
        }
        run(&mut app, 120);
        let stretch = largest_stretch(&app, cape);
        println!("dash along {direction}: {:.2} %", 100.0 * stretch);
        assert!(stretch < 0.02, "along {direction}: {stretch}");
    }
}

#[test]
fn a_turn_by_a_quarter_in_one_frame_leaves_no_cell_stretched() {
    for axis in [Vec3::X, Vec3::Y] {
        let mut app = headless();
        let cape = cape(&mut app);
        get_mut::<Transform>(&mut app, cape).rotation = Quat::from_axis_angle(axis, FRAC_PI_2);
        run(&mut app, 120);
        let stretch = largest_stretch(&app, cape);
        println!("turn about {axis}: {:.2} %", 100.0 * stretch);
        assert!(stretch < 0.02, "about {axis}: {stretch}");
    }
}

#[test]
fn a_turn_within_its_own_plane_leaves_a_cloth_as_stretched_as_one_that_hangs_like_that() {
    // Its upper edge is upright then: the weight hangs on one corner, which is stretched by more than the rest.
    let turn = Quat::from_rotation_z(FRAC_PI_2);
    let mut app = headless();
    let cape = cape(&mut app);
    get_mut::<Transform>(&mut app, cape).rotation = turn;
    run(&mut app, 240);
    // Nothing would take this one out of its plane but a breath of wind.
    let mut other = headless();
    other.world_mut().spawn(Wind { velocity: Vec3::Z * 0.1, ..default() });
    let place = Transform::from_rotation(turn);
    let flag = spawn_cloth(&mut other, ClothGrid::new(0.5, 1.0, 12, 24), (Pins::edge(ClothEdge::Top), place));
    run(&mut other, 360);
    let [turned, expected] = [(&app, cape), (&other, flag)].map(|(app, cloth)| {
        let mut strains = strains(app, cloth);
        strains.sort_unstable_by(f32::total_cmp);
        [0.9, 0.99, 1.0].map(|share| strains[(share * (strains.len() - 1) as f32) as usize])
    });
    println!("turned: {turned:?}, never turned: {expected:?}");
    for (turned, expected) in turned.into_iter().zip(expected) {
        assert!(turned < 1.25 * expected + 0.005, "{turned} instead of {expected}");
    }
}
