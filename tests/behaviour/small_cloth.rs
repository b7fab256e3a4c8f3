//! Cloth of millimetres: its margin fits it, and one warning says so.

use bevy::{mesh::VertexAttributeValues, prelude::*};
use bevy_drape::prelude::*;

use crate::{common::*, quiet::Quiet};

/// Side of a stamp, m.
const STAMP: f32 = 0.005;

fn grid() -> Mesh {
    ClothGrid::new(STAMP, STAMP, 12, 12).lying().into()
}

/// The same without rows and columns.
fn irregular() -> Mesh {
    let mut mesh = grid();
    let Some(VertexAttributeValues::Float32x3(places)) = mesh.attribute_mut(Mesh::ATTRIBUTE_POSITION) else {
        panic!("a grid has positions")
    };
    for (k, place) in places.iter_mut().enumerate() {
        place[0] += 1e-4 * ops::sin(12.9 * k as f32);
        place[2] += 1e-4 * ops::sin(78.2 * k as f32);
    }
    mesh
}

fn closed() -> Mesh {
    Sphere::new(STAMP / 2.0).mesh().ico(5).expect("few triangles")
}

/// Strain of the sides of all triangles: the mean, that of one in a hundred, and the largest.
fn strain(app: &App, cloth: Entity) -> [f32; 3] {
    let (state, places) = (state(app, cloth), positions(app, cloth));
    let rest = &state.topology().rest;
    let sides = state.triangles().iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let mut strains: Vec<f32> = sides
        .map(|side| side.map(|i| i as usize))
        .map(|[a, b]| (places[a].distance(places[b]) / rest[a].distance(rest[b]) - 1.0).max(0.0))
        .collect();
    strains.sort_unstable_by(f32::total_cmp);
    let count = strains.len();
    [strains.iter().sum::<f32>() / count as f32, strains[count * 99 / 100], strains[count - 1]]
}

fn fastest(app: &App, cloth: Entity) -> f32 {
    state(app, cloth).velocities().map(Vec3::length).fold(0.0, f32::max)
}

/// A cloth of one of these meshes at `place`, with a ball of 1 cm around the origin, after three seconds.
#[track_caller]
fn settled(mesh: Mesh, place: Vec3, more: impl Bundle) -> ([f32; 3], f32) {
    let mut app = headless();
    app.world_mut().spawn((ClothCollider { friction: 4.0, ..Sphere::new(0.005).into() }, Transform::default()));
    let cloth = spawn_cloth(&mut app, mesh, (Transform::from_translation(place), more));
    run(&mut app, 180);
    assert_eq!(get::<ClothStatus>(&app, cloth), &ClothStatus::Ready);
    assert_eq!(app.world().resource::<Heard>().reset, []);
    (strain(&app, cloth), fastest(&app, cloth))
}

#[test]
fn a_stamp_that_falls_on_a_ball_of_a_centimetre_is_not_stretched() {
    for (name, mesh) in [("grid", grid()), ("irregular", irregular()), ("closed", closed())] {
        let (strain, fastest) = settled(mesh, Vec3::new(0.0, 0.012, 0.0), ());
        println!("{name}: {strain:?}, {fastest} m/s");
        assert!(strain[2] < 0.05, "{name}: {strain:?}");
    }
}

#[test]
fn a_stamp_that_hangs_next_to_a_ball_is_not_stretched() {
    for (name, mesh, pins) in [
        ("grid", grid(), Pins::indices([0, 11])),
        ("irregular", irregular(), Pins::indices([0, 11])),
        ("closed", closed(), Pins::indices([0])),
    ] {
        // Its pinned corners are half a millimetre beside the ball, and it hangs down along that.
        let (strain, fastest) = settled(mesh, Vec3::new(0.0, 0.003, 0.0055 + STAMP / 2.0), pins);
        println!("{name}: {strain:?}, {fastest} m/s");
        assert!(strain[1] < 0.05, "{name}: {strain:?}");
    }
}

/// The warnings that tell of a margin within some frames.
fn told(quiet: &mut Quiet) -> Vec<String> {
    quiet.run(3).into_iter().filter(|line| line.contains("margin")).collect()
}

#[test]
fn a_margin_that_does_not_fit_is_told_of_once_until_it_did() {
    for mesh in [grid(), irregular(), closed()] {
        let mut quiet = Quiet::new();
        let cloth = spawn_cloth(&mut quiet.app, mesh, ());
        let said = told(&mut quiet);
        assert_eq!(said.len(), 1, "{said:?}");
        let words = [&format!("cloth {cloth}"), "margin of 5.00 mm", "keeps 1.2", "Cloth::collision_margin"];
        assert!(words.iter().all(|word| said[0].contains(word)), "{said:?}");
        let in_force = |quiet: &Quiet| state(&quiet.app, cloth).collision_margin();
        assert!((in_force(&quiet) - STAMP / 4.0).abs() < 5e-5, "{} m", in_force(&quiet));
        // As a slider is moved.
        for margin in [0.004, 0.003, 0.002] {
            get_mut::<Cloth>(&mut quiet.app, cloth).collision_margin = margin;
            assert_eq!(told(&mut quiet), Vec::<String>::new(), "{margin} m");
        }
        get_mut::<Cloth>(&mut quiet.app, cloth).collision_margin = 0.001;
        assert_eq!(told(&mut quiet), Vec::<String>::new());
        assert_eq!(in_force(&quiet), 0.001);
        get_mut::<Cloth>(&mut quiet.app, cloth).collision_margin = 0.003;
        assert_eq!(told(&mut quiet).len(), 1);
    }
}

#[test]
fn a_cloth_that_is_rebuilt_at_another_scale_has_the_margin_that_fits_it_then() {
    let mut quiet = Quiet::new();
    let cloth = spawn_cloth(&mut quiet.app, grid(), Transform::from_scale(Vec3::splat(10.0)));
    assert_eq!(told(&mut quiet), Vec::<String>::new());
    assert_eq!(state(&quiet.app, cloth).collision_margin(), 0.005);
    for (scale, margin, count) in [(2.0, 0.0025, 1), (1.0, 0.001_25, 0), (10.0, 0.005, 0), (3.0, 0.003_75, 1)] {
        get_mut::<Transform>(&mut quiet.app, cloth).scale = Vec3::splat(scale);
        command(&mut quiet.app, cloth, |cloth| cloth.reset_cloth());
        assert_eq!(told(&mut quiet).len(), count, "{scale} times");
        let in_force = state(&quiet.app, cloth).collision_margin();
        assert!((in_force - margin).abs() < 1e-6, "{in_force} m for {margin}");
    }
}

#[test]
fn a_ribbon_keeps_its_margin() {
    let mut quiet = Quiet::new();
    let cloth = spawn_cloth(&mut quiet.app, ClothGrid::new(0.2, STAMP, 80, 3).lying(), ());
    assert_eq!(told(&mut quiet), Vec::<String>::new());
    assert_eq!(state(&quiet.app, cloth).collision_margin(), 0.005);
}
