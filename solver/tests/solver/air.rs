//! The force of the air on triangles.

use bevy_math::{DVec3, Isometry3d, Quat, Vec3, Vec3A};
use drape_solver::{Ellipsoid, Gusts, Material, WindRegion, WindSource};

use crate::{
    bench_bed::{Bed, GRAVITY, bits},
    fixtures::{
        material::{Springs, springs_in_air},
        mesh::{Grid, turned_over},
    },
};

const CALM: Gusts = Gusts { strength: 0.0, period: 4.0, turbulence: 0.0, eddy_size: 1.0, seed: 7 };

fn wind(velocity: Vec3A) -> WindSource {
    let (region, origin) = (WindRegion::Everywhere, Vec3A::ZERO);
    WindSource { velocity, gusts: CALM, region, origin, travelled: DVec3::ZERO, gusts_passed: 0.0 }
}

/// A heavy square metre that lies in the air without gravity, all of it free.
fn sheet(drag: f32, lift: f32) -> Bed {
    let material = Material { density: 1.0, damping: 0.0, drag, lift, ..springs_in_air(Springs::default()) };
    Bed { gravity: Vec3A::ZERO, ..Bed::lying(5, material) }
}

/// Force on the whole sheet in the first instant of a wind, N.
fn force(mut bed: Bed, velocity: Vec3A) -> Vec3A {
    bed.winds = vec![wind(velocity)];
    let dt = 1e-4;
    bed.step(dt);
    let momentum: Vec3A =
        (0..bed.particles.len()).map(|i| bed.particles.velocity[i] / bed.particles.inverse_mass[i]).sum();
    momentum / dt
}

fn assert_near(force: Vec3A, expected: Vec3A) {
    assert!(force.distance(expected) < 0.01 * expected.length() + 1e-4, "{force} for {expected} N");
}

#[test]
fn a_wind_across_the_sheet_presses_by_half_density_area_speed_squared() {
    assert_near(force(sheet(1.2, 0.4), Vec3A::Y * 5.0), Vec3A::Y * (0.5 * 1.225 * 25.0 * 1.2));
    assert_near(force(sheet(1.2, 0.4), Vec3A::Y * -5.0), Vec3A::Y * (-0.5 * 1.225 * 25.0 * 1.2));
}

#[test]
fn a_wind_along_the_sheet_is_not_felt() {
    assert_near(force(sheet(1.2, 0.4), Vec3A::X * 20.0), Vec3A::ZERO);
}

#[test]
fn a_slanting_wind_drags_along_itself_and_lifts_across() {
    let (drag, lift, speed) = (1.0, 0.5, 4.0);
    let direction = Vec3A::new(0.8, 0.6, 0.0);
    let c = 0.6;
    let expected = 0.5 * 1.225 * speed * speed * c * (drag * direction + lift * (Vec3A::Y - c * direction));
    assert_near(force(sheet(drag, lift), direction * speed), expected);
}

#[test]
fn the_side_that_triangles_face_makes_no_difference() {
    let turned = turned_over(Grid::new(1.0, 1.0, 5, 5).lying().into());
    let bed = Bed { gravity: Vec3A::ZERO, ..Bed::new(turned, sheet(1.0, 0.5).material) };
    let velocity = Vec3A::new(2.0, 3.0, -1.0);
    assert_near(force(bed, velocity), force(sheet(1.0, 0.5), velocity));
}

#[test]
fn a_sheet_falling_flat_reaches_its_terminal_speed() {
    let material = Material { density: 0.1, damping: 0.0, drag: 1.2, lift: 0.0, ..springs_in_air(Springs::default()) };
    let mut bed = Bed::lying(5, material);
    bed.run(3.0);
    let expected = (2.0 * 0.1 * GRAVITY / (1.225 * 1.2)).sqrt();
    let speed = -bed.particles.velocity.iter().map(|v| v.y).sum::<f32>() / 25.0;
    assert!((speed / expected - 1.0).abs() < 0.01, "{speed} for {expected} m/s");
}

#[test]
fn the_lightest_sheet_in_a_hurricane_takes_its_speed_and_no_more() {
    let material = Material { density: 0.005, drag: 2.0, lift: 1.0, ..springs_in_air(Springs::default()) };
    let mut bed = Bed { gravity: Vec3A::ZERO, ..Bed::lying(5, material) };
    bed.winds = vec![wind(Vec3A::new(10.0, 60.0, 0.0))];
    for _ in 0..60 {
        bed.step(1.0 / 60.0);
        assert!(bed.fastest() < 90.0, "{} m/s", bed.fastest());
    }
}

#[test]
fn a_region_has_a_soft_edge_and_ends() {
    let ball = WindRegion::Sphere { centre: Vec3A::X, radius: 2.0, edge: 1.0 };
    assert_eq!(ball.weight(Vec3A::X), 1.0);
    assert!((ball.weight(Vec3A::X * 2.9) - ball.weight(Vec3A::X * -0.9)).abs() < 1e-6);
    assert_eq!(ball.weight(Vec3A::X * 2.5), 0.5);
    assert_eq!(ball.weight(Vec3A::X * 3.1), 0.0);
    let turned = Isometry3d::new(Vec3::X, Quat::from_rotation_z(core::f32::consts::FRAC_PI_2));
    let shape = Ellipsoid { half_size: Vec3::new(4.0, 2.0, 2.0) };
    let egg = WindRegion::Ellipsoid { pose: turned, shape, edge: 1.0 };
    assert_eq!(egg.weight(Vec3A::X), 1.0);
    for place in [Vec3A::new(1.0, -3.5, 0.0), Vec3A::X * 2.5, Vec3A::new(1.0, 0.0, 1.5)] {
        assert!((egg.weight(place) - 0.5).abs() < 1e-5, "{place}: half a metre from the surface");
    }
    assert_eq!(egg.weight(Vec3A::X * 3.1), 0.0);
    let quarter_turn = Quat::from_rotation_y(core::f32::consts::FRAC_PI_2);
    let pose = Isometry3d::new(Vec3::Y, quarter_turn);
    let block = WindRegion::Cuboid { pose, half_size: Vec3A::new(4.0, 1.0, 1.0), edge: 0.0 };
    assert_eq!(block.weight(Vec3A::new(0.0, 1.0, 3.5)), 1.0);
    assert_eq!(block.weight(Vec3A::new(3.5, 1.0, 0.0)), 0.0);
}

#[test]
fn gusts_are_the_same_on_every_run_and_differ_by_seed_place_and_time() {
    let blown = |seed: u32, place: f32, start: f32| {
        let mut bed = sheet(1.2, 0.4).pinned([0, 4]);
        let gusts = Gusts { strength: 0.6, turbulence: 0.3, seed, ..CALM };
        bed.winds = vec![WindSource { gusts, origin: Vec3A::X * place, ..wind(Vec3A::new(3.0, 2.0, 0.0)) }];
        bed.winds[0].advance(start);
        bed.run(0.5);
        bits(&bed.particles)
    };
    let same = blown(1, 0.0, 0.0);
    assert_eq!(same, blown(1, 0.0, 0.0));
    assert_ne!(same, blown(2, 0.0, 0.0));
    assert_ne!(same, blown(1, 5.0, 0.0));
    assert_ne!(same, blown(1, 0.0, 9.0));
}

#[test]
fn eddies_have_the_strength_that_was_asked_for() {
    // The speed along the sheet isn't felt, so the press is measured over many moments of a wind across it.
    let gusts = Gusts { turbulence: 0.2, ..CALM };
    let (mut sum, mut squares, count) = (0.0, 0.0, 400);
    for moment in 0..count {
        let mut bed = sheet(1.0, 0.0);
        bed.winds = vec![WindSource { gusts, ..wind(Vec3A::Y * 4.0) }];
        bed.winds[0].advance(moment as f32 * 0.7);
        bed.step(1e-4);
        let speed_gained: f32 = bed.particles.velocity[12].y / 1e-4;
        let air_speed = (speed_gained / (0.5 * 1.225)).max(0.0).sqrt();
        sum += air_speed;
        squares += air_speed * air_speed;
    }
    let mean = sum / count as f32;
    let deviation = (squares / count as f32 - mean * mean).sqrt();
    assert!((mean - 4.0).abs() < 0.3, "{mean} m/s");
    assert!((0.12..0.28).contains(&(deviation / 4.0)), "{deviation} m/s");
}

/// Change of the air's push from one size of the sheet, or one velocity of the wind, to the next, N.
fn largest_jump(pushes: Vec<Vec3A>) -> f32 {
    pushes.array_windows().map(|[one, next]| one.distance(*next)).fold(0.0, f32::max)
}

#[test]
fn a_cloth_that_grows_through_the_eddies_feels_no_jump() {
    let gusts = Gusts { turbulence: 0.3, ..CALM };
    let push = |i: u32| {
        let side = 0.9 + 0.002 * i as f32;
        let grid = Grid::new(side, side, 5, 5).lying();
        let mut bed = Bed { gravity: Vec3A::ZERO, ..Bed::new(grid, sheet(1.0, 0.0).material) };
        bed.winds = vec![WindSource { gusts, ..wind(Vec3A::Y * 5.0) }];
        bed.winds[0].advance(3.0);
        bed.step(1e-4);
        bed.particles.velocity[12] / 1e-4
    };
    let pushes: Vec<Vec3A> = (0..120).map(push).collect();
    let strength = pushes[0].length();
    let jump = largest_jump(pushes);
    assert!(jump < 0.02 * strength, "{jump} of {strength} m/s²");
}

#[test]
fn a_wind_that_turns_after_an_hour_turns_as_gently_as_at_the_start() {
    let gusts = Gusts { strength: 0.4, turbulence: 0.2, ..CALM };
    let roughness = |start: f32| {
        let mut source = WindSource { gusts, ..wind(Vec3A::new(4.0, 4.0, 0.0)) };
        source.advance(start);
        let push = |i: i32| {
            source.velocity = Vec3A::from(Quat::from_rotation_y(0.005 * i as f32) * Vec3::new(4.0, 4.0, 0.0));
            source.advance(1.0 / 60.0);
            let mut bed = sheet(1.0, 0.0);
            bed.winds = vec![source];
            bed.step(1e-4);
            bed.particles.velocity[12] / 1e-4
        };
        largest_jump((0..120).map(push).collect())
    };
    let (early, late) = (roughness(1.0), roughness(3600.0));
    assert!(late < 2.0 * early, "{late} after an hour, {early} at the start");
}
