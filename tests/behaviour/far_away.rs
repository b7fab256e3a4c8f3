//! Far from the world's origin, a cloth is as exact as at it.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::common::*;

/// What a cloth in one place becomes: its vertices relative to its entity, and the contacts that it has had.
fn after_two_seconds(at: Vec3) -> (Vec<Vec3>, u32) {
    let mut app = headless();
    let grid = ClothGrid::new(1.0, 1.0, 16, 16).lying();
    let pins = Pins::indices([0, 1]).and(Pins::indices([15]).to_world());
    let cloth = spawn_cloth(&mut app, grid, (pins, Transform::from_translation(at)));
    let ball = at + Vec3::new(0.125, -0.375, 0.0625);
    app.world_mut().spawn((ClothCollider::from(Sphere::new(0.3)), Transform::from_translation(ball)));
    // Gusts belong to the world, so they differ from place to place.
    let steady = Wind { velocity: Vec3::new(2.0, 0.5, 1.0), gusts: 0.0, turbulence: 0.0, ..default() };
    app.world_mut().spawn(steady);
    let mut contacts = 0;
    for _ in 0..120 {
        run(&mut app, 1);
        contacts += report(&app, cloth).contacts;
    }
    (points(drawn(&app, cloth)), contacts)
}

#[test]
fn ten_kilometres_away_a_cloth_does_what_it_does_at_the_origin() {
    let (here, contacts) = after_two_seconds(Vec3::ZERO);
    assert!(contacts > 1000, "the cloth lies on the ball");
    for distance in [10_240.0, 10_000.0] {
        let (there, _) = after_two_seconds(Vec3::new(distance, 0.0, -distance));
        for (here, there) in here.iter().zip(there) {
            assert_close(*here, there, 1e-4);
        }
    }
}

#[test]
fn a_cloth_that_travels_ten_kilometres_stays_exact() {
    let swing = |velocity: f32| {
        let mut app = headless_with(ClothPlugin::new(Update));
        let air = Cloth { fluid_density: 0.0, ..default() };
        let grid = ClothGrid::new(1.0, 1.0, 8, 8);
        let cloth = spawn_cloth(&mut app, grid, (Pins::edge(ClothEdge::Top), air, undamped()));
        // Up to speed within the first second, so that the frames are of one kind from then on.
        let mut place = 0.0_f64;
        for frame in 0..1200 {
            place += f64::from(velocity / 60.0) * (f64::from(frame) / 60.0).min(1.0);
            get_mut::<Transform>(&mut app, cloth).translation.x = place as f32;
            run(&mut app, 1);
        }
        let mesh = points(drawn(&app, cloth));
        let longest = state(&app, cloth).topology().springs.iter().map(|s| s.rest).fold(0.0, f32::max);
        (place, mesh, longest)
    };
    let (place, mesh, longest) = swing(480.0);
    assert!(place > 9_000.0);
    // No particle is left behind, neighbours on a row are still a cell apart, and pins are exact to 1/20 mm: without
    // an origin that comes along, numbers that large would tell only whole millimetres apart.
    assert!(mesh.iter().all(|point| point.length() < 1.5));
    for row in mesh.chunks(8) {
        for pair in row.windows(2) {
            assert!(pair[0].distance(pair[1]) < 1.05 * longest);
        }
    }
    for (pinned, rest) in mesh[..8].iter().zip(points(&ClothGrid::new(1.0, 1.0, 8, 8).into())) {
        assert_close(*pinned, rest, 5e-5);
    }
}
