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

/// Twenty times as long as it is wide, and no wider than a stamp.
fn ribbon() -> Mesh {
    ClothGrid::new(0.1, STAMP, 121, 7).lying().into()
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

/// A cloth at `place`, with a ball of 1 cm around the origin, after three seconds: its strain and its fastest particle, m/s.
#[track_caller]
fn settled(mesh: Mesh, place: Vec3, more: impl Bundle) -> ([f32; 3], f32) {
    let mut app = headless();
    app.world_mut().spawn((ClothCollider::from(Sphere::new(0.005)), Transform::default()));
    let cloth = spawn_cloth(&mut app, mesh, (Transform::from_translation(place), more));
    run(&mut app, 180);
    assert!(get::<ClothStatus>(&app, cloth).is_running());
    assert_eq!(app.world().resource::<Heard>().reset, []);
    (strain(&app, cloth), fastest(&app, cloth))
}

#[test]
fn a_stamp_that_falls_on_a_ball_comes_to_rest_there() {
    for (name, mesh) in [("grid", grid()), ("irregular", irregular())] {
        let (strain, fastest) = settled(mesh, Vec3::new(0.0, 0.012, 0.0), ());
        println!("{name}: {strain:?}, {fastest} m/s");
        // To lie on a ball of its size, it has to shear by some per cent.
        assert!(strain[2] < 0.12 && fastest < 1e-3, "{name}: {strain:?}, {fastest} m/s");
    }
}

#[test]
fn a_stamp_that_hangs_next_to_a_ball_is_stretched_as_if_it_kept_no_margin() {
    for (name, mesh, pins) in [
        ("grid", grid(), Pins::indices([0, 11])),
        ("irregular", irregular(), Pins::indices([0, 11])),
        ("ribbon", ribbon(), Pins::edge(ClothEdge::Top)),
        ("closed", closed(), Pins::indices([0])),
    ] {
        let [kept, none] = [0.005, 0.0].map(|collision_margin| {
            // What is pinned is less than two millimetres off the ball, and the rest hangs down beside that.
            let place = Vec3::new(0.0, 0.003, 0.0065 + STAMP / 2.0);
            settled(mesh.clone(), place, (pins.clone(), Cloth { collision_margin, ..default() }))
        });
        println!("{name}: {kept:?} m/s, without a margin {none:?} m/s");
        assert!(kept.0[1] < none.0[1] + 0.02 && kept.1 < none.1 + 2e-3, "{name}: {kept:?}, without a margin {none:?}");
    }
}

/// The margin that a cloth keeps, m.
fn in_force_margin(app: &App, cloth: Entity) -> f32 {
    get::<Cloth>(app, cloth).collision_margin.min(state(app, cloth).largest_margin())
}

/// The warnings that tell of a margin within some frames.
fn told(quiet: &mut Quiet) -> Vec<String> {
    quiet.run(3).into_iter().filter(|line| line.contains("margin")).collect()
}

#[test]
fn a_margin_that_does_not_fit_is_told_of_once_until_it_did() {
    for mesh in [grid(), irregular(), ribbon(), closed()] {
        let mut quiet = Quiet::new();
        let cloth = spawn_cloth(&mut quiet.app, mesh, ());
        let said = told(&mut quiet);
        assert_eq!(said.len(), 1, "{said:?}");
        let words = [&format!("cloth {cloth}"), "margin of 5.00 mm", "keeps 1.", "Cloth::collision_margin"];
        assert!(words.iter().all(|word| said[0].contains(word)), "{said:?}");
        let in_force = |quiet: &Quiet| in_force_margin(&quiet.app, cloth);
        assert!((in_force(&quiet) - STAMP / 4.0).abs() < 1e-4, "{} m", in_force(&quiet));
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
    assert_eq!(in_force_margin(&quiet.app, cloth), 0.005);
    for (scale, margin, count) in [(2.0, 0.0025, 1), (1.0, 0.001_25, 0), (10.0, 0.005, 0), (3.0, 0.003_75, 1)] {
        get_mut::<Transform>(&mut quiet.app, cloth).scale = Vec3::splat(scale);
        command(&mut quiet.app, cloth, |cloth| cloth.reset_cloth());
        assert_eq!(told(&mut quiet).len(), count, "{scale} times");
        let in_force = in_force_margin(&quiet.app, cloth);
        assert!((in_force - margin).abs() < 1e-6, "{in_force} m for {margin}");
    }
}
