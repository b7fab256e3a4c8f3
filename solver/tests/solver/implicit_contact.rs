//! Implicit steps of sheets that lie on obstacles: they rest there, slide as Coulomb says, and gain no energy.

use core::f32::consts::TAU;

use bevy_math::{
    Dir3, Isometry3d, Quat, Vec3, Vec3A, ops,
    primitives::{Capsule3d, Cuboid, InfinitePlane3d, Sphere},
};
use drape_solver::{Elasticity, Material, Moduli, Obstacle, Solid, measure, step_together};

use crate::{
    bench_bed::{Bed, GRAVITY, rms, together},
    fixtures::mesh::{Grid, both, shaped, turned_over, uneven},
};

/// How stiff woven cotton is.
fn woven() -> Elasticity {
    let moduli = Moduli::from_strips([4000.0; 2], 50.0, [0.0; 2], 1.0).expect("a sheet");
    Elasticity::Moduli(Moduli { bending: 18e-6, ..moduli })
}

/// A piece of woven cotton of so many vertices along a side, which lies at height 0.
fn cotton(length: f32, side: u32, damping: f32, friction: f32) -> Bed {
    let mesh = uneven(Grid::new(length, length, side, side).lying(), 0.25);
    let bed = Bed::new(mesh, Material { damping, friction, ..Material::bare(0.15, woven()) });
    assert!(bed.topology.two_grid.is_some() && bed.topology.lattice.is_none());
    Bed { fluid_density: 0.0, ..bed }
}

/// A flat cushion of two uneven pieces, sewn together all around.
fn cushion() -> Bed {
    let half = |side: f32| {
        let piece = uneven(Grid::new(0.4, 0.4, 24, 24).lying(), 0.25);
        let bulge = |x: f32| 1.0 - (x / 0.2) * (x / 0.2);
        shaped(piece, |p| Vec3::new(p.x, side * 0.01 * bulge(p.x) * bulge(p.z), p.z))
    };
    let mesh = both(half(1.0), turned_over(half(-1.0)));
    let bed = Bed::new(mesh, Material { damping: 0.2, friction: 0.5, ..Material::bare(0.15, woven()) });
    Bed { fluid_density: 0.0, self_collision: true, margin: 2e-3, ..bed }
}

/// Energy of a bed, J.
fn energy(bed: &Bed) -> f32 {
    measure::energy(&bed.particles, &bed.topology, &bed.material, bed.gravity).total()
}

/// By how much that grows in all of some `seconds`, J.
fn gained(bed: &mut Bed, seconds: u32) -> f32 {
    let (mut least, mut gained) = (energy(bed), 0.0);
    for _ in 0..60 * seconds {
        bed.step(1.0 / 60.0);
        let now = energy(bed);
        gained += (now - least).max(0.0);
        least = now;
    }
    gained
}

#[test]
fn a_sheet_that_falls_on_something_loses_energy_all_the_time_and_comes_to_rest() {
    let ball = (Solid::Sphere(Sphere::new(0.4)), Vec3::NEG_Y * 0.45, Quat::IDENTITY);
    let bar = (Solid::Capsule(Capsule3d::new(0.1, 0.6)), Vec3::NEG_Y * 0.15, Quat::from_rotation_z(1.5));
    let table = (Solid::Cuboid(Cuboid::new(0.5, 0.3, 0.5)), Vec3::NEG_Y * 0.2, Quat::IDENTITY);
    for (name, (solid, place, turn)) in [("table", table), ("ball", ball), ("bar", bar)] {
        let mut bed = cotton(1.0, 48, 0.2, 0.5);
        // As a game has it: so deep, triangles may cut into what is round between their corners.
        bed.margin = 5e-3;
        bed.obstacles = vec![Obstacle::still(solid, Isometry3d::new(place, turn))];
        let begun = energy(&bed);
        let gained = gained(&mut bed, 6);
        let before = bed.particles.clone();
        bed.step(1.0 / 60.0);
        let (seen, lost) = (rms(&bed.particles, &before) * 60.0, begun - energy(&bed));
        let strain = measure::strain(&bed.particles, &bed.topology).largest;
        let fastest = bed.particles.velocity.iter().map(|v| v.length()).fold(0.0, f32::max);
        println!("{name}: {seen} m/s rms, {fastest} at most, gained {gained} J of {lost} J, strain {strain}");
        // Where contact came after the step only, 0.1 to 0.4 m/s, and as much gained as lost; on the table, strains of 30 to 40 %.
        assert!(seen < 5e-3 && fastest < 0.01, "{name}: {seen} m/s rms, {fastest} at most");
        assert!(gained < 0.01 * lost, "{name}: {gained} J of {lost} J");
        assert!(strain < 0.1, "{name}: {strain}");
    }
}

#[test]
fn a_sheet_on_a_slope_stays_or_slides_as_coulomb_says() {
    // It slides from 26.6 degrees on.
    const FRICTION: f32 = 0.5;
    for degrees in [10.0_f32, 20.0, 30.0, 45.0, 60.0] {
        let slope = degrees.to_radians();
        let mut bed = cotton(0.5, 20, 0.0, FRICTION);
        let ground = Solid::HalfSpace(InfinitePlane3d { normal: Dir3::Y });
        let below = Isometry3d::from_translation(Vec3::NEG_Y * 1e-3);
        bed.obstacles = vec![Obstacle::still(ground, below)];
        bed.gravity = Vec3A::new(ops::sin(slope), -ops::cos(slope), 0.0) * GRAVITY;
        bed.run(0.5);
        let along = |bed: &Bed| {
            let sum = |points: &[Vec3A]| points.iter().sum::<Vec3A>().x / points.len() as f32;
            [sum(&bed.particles.position), sum(&bed.particles.velocity)]
        };
        let [from, speed] = along(&bed);
        bed.run(1.0);
        let [to, faster] = along(&bed);
        let expected = GRAVITY * (ops::sin(slope) - FRICTION * ops::cos(slope));
        println!("{degrees}: by {} m, {} m/s², expected {expected}", to - from, faster - speed);
        if expected < 0.0 {
            assert!((to - from).abs() < 1e-5, "{degrees}: it creeps by {} m", to - from);
        } else {
            assert!((faster - speed - expected).abs() < 0.02 * expected + 0.02, "{degrees}: {} m/s²", faster - speed);
        }
    }
}

#[test]
fn a_sheet_that_a_board_lifts_goes_with_it() {
    let mut bed = cotton(0.5, 20, 0.0, 0.5);
    let board = |height: f32| {
        let solid = Solid::HalfSpace(InfinitePlane3d { normal: Dir3::Y });
        Obstacle::still(solid, Isometry3d::from_translation(Vec3::Y * height))
    };
    bed.obstacles = vec![board(-1e-3)];
    bed.run(0.5);
    for frame in 0..60 {
        let [from, to] = [frame, frame + 1].map(|frame| board(-1e-3 + frame as f32 / 60.0).start);
        bed.obstacles[0].start = from;
        bed.obstacles[0].end = to;
        bed.step(1.0 / 60.0);
    }
    for (place, velocity) in bed.particles.position.iter().zip(&bed.particles.velocity) {
        assert!((place.y - 1.0).abs() < 2e-3, "at {place}");
        assert!((velocity.y - 1.0).abs() < 0.02, "{velocity}");
    }
}

#[test]
fn a_sheet_that_is_lifted_by_a_side_comes_off_the_ground_and_rests() {
    let mut bed = cotton(0.5, 20, 0.0, 0.5);
    let ground = Solid::HalfSpace(InfinitePlane3d { normal: Dir3::Y });
    bed.obstacles = vec![Obstacle::still(ground, Isometry3d::from_translation(Vec3::NEG_Y * 1e-3))];
    bed.run(0.5);
    let is_at_side = |&i: &u32| bed.particles.position[i as usize].x < -0.2499;
    let side: Vec<u32> = (0..bed.particles.len() as u32).filter(is_at_side).collect();
    bed = bed.pinned(side);
    for _ in 0..60 {
        for pin in &mut bed.pin_motions {
            pin.start = pin.end;
            pin.end += Vec3A::Y * (0.25 / 60.0);
        }
        bed.step(1.0 / 60.0);
    }
    bed.pin_motions.iter_mut().for_each(|pin| pin.start = pin.end);
    bed.run(3.0);
    let before = bed.particles.clone();
    bed.step(1.0 / 60.0);
    let (seen, strain) = (rms(&bed.particles, &before) * 60.0, measure::strain(&bed.particles, &bed.topology).largest);
    let down = bed.particles.position.iter().filter(|place| place.y < 1e-3).count();
    println!("{seen} m/s rms, strain {strain}, {down} of {} lie", before.len());
    // Of a heavy chain that friction holds, 0.21 m lie.
    assert!((160..200).contains(&down), "{down} of {} lie", before.len());
    assert!(seen < 5e-3 && strain < 0.01, "{seen} m/s rms, strain {strain}");
}

#[test]
fn a_cushion_whose_sides_touch_swings_without_gaining_energy() {
    let mut bed = cushion();
    let along = |i: &u32| bed.particles.position[*i as usize].dot(Vec3A::new(1.0, 0.0, 1.0));
    let corner = (0..bed.particles.len() as u32).min_by(|i, j| along(i).total_cmp(&along(j)));
    bed = bed.pinned(corner);
    let gained = gained(&mut bed, 8);
    let strain = measure::strain(&bed.particles, &bed.topology).mean;
    println!("gained {gained} J, strain {strain}");
    // It falls by 0.14 J. Where cloth met itself after the step only, 25 J were gained, and it ran wild at 6 m/s.
    assert!(gained < 0.03, "{gained} J");
    assert!(strain < 5e-3, "{strain}");
}

#[test]
fn a_cushion_comes_to_rest_on_a_ball() {
    let mut bed = cushion();
    let ball = Solid::Sphere(Sphere::new(0.2));
    bed.obstacles = vec![Obstacle::still(ball, Isometry3d::from_translation(Vec3::NEG_Y * 0.3))];
    let gained = gained(&mut bed, 5);
    let before = bed.particles.clone();
    bed.step(1.0 / 60.0);
    let (seen, strain) = (rms(&bed.particles, &before) * 60.0, measure::strain(&bed.particles, &bed.topology));
    println!("{seen} m/s rms, gained {gained} J, strain {strain:?}");
    assert!(seen < 2e-3, "{seen} m/s rms");
    assert!(gained < 5e-3, "{gained} J");
    assert!(strain.mean < 3e-3, "{strain:?}");
}

#[test]
fn a_sheet_comes_to_rest_on_another_that_lies_on_a_ball() {
    let mut beds = [0.0, 0.4].map(|turn| {
        let mut bed = cotton(1.0, 32, 0.2, 0.5);
        bed.self_collision = true;
        bed.margin = 5e-3;
        let ball = Solid::Sphere(Sphere::new(0.4));
        bed.obstacles = vec![Obstacle::still(ball, Isometry3d::from_translation(Vec3::NEG_Y * 0.45))];
        for place in &mut bed.particles.position {
            *place = Quat::from_rotation_y(turn) * *place + Vec3A::Y * (0.1 * turn);
        }
        bed
    });
    let energy = |beds: &[Bed; 2]| beds.iter().map(energy).sum::<f32>();
    let (mut least, mut gained, mut before) = (energy(&beds), 0.0, beds.clone());
    for _ in 0..300 {
        before.clone_from(&beds);
        together(&mut beds, 1.0 / 60.0, step_together);
        let now = energy(&beds);
        gained += (now - least).max(0.0);
        least = now;
    }
    println!("gained {gained} J");
    // Where they met each other after the step only, 30 J, and they were thrown off.
    assert!(gained < 1e-3, "{gained} J");
    for (bed, before) in beds.iter().zip(&before) {
        let (seen, strain) =
            (rms(&bed.particles, &before.particles) * 60.0, measure::strain(&bed.particles, &bed.topology));
        println!("{seen} m/s rms, {strain:?}");
        assert!(seen < 5e-3, "{seen} m/s rms");
        assert!(strain.mean < 2e-3, "{strain:?}");
    }
}

/// How far the vertices of a circle skirt have come down, on average, m, 0.6 s after it was let go: it hangs by the waist, and falls into folds.
fn fallen_skirt(self_collision: bool, unevenness: f32) -> f32 {
    let cloth = uneven(Grid::new(1.0, 1.0, 100, 20).lying(), unevenness);
    let mesh = shaped(cloth, |p| {
        let (angle, radius) = ((p.x + 0.5) * TAU, 0.14 + 0.36 * (p.z + 0.5));
        Vec3::new(radius * ops::cos(angle), 0.0, radius * ops::sin(angle))
    });
    let moduli = Moduli::from_strips([2500.0; 2], 20.0, [0.0; 2], 1.0).expect("a sheet");
    let silk = Elasticity::Moduli(Moduli { bending: 5e-6, ..moduli });
    let bed = Bed::new(mesh, Material { damping: 0.5, friction: 0.3, ..Material::bare(0.06, silk) });
    let is_waist = |&i: &u32| bed.particles.position[i as usize].length() < 0.1401;
    let waist: Vec<u32> = (0..bed.particles.len() as u32).filter(is_waist).collect();
    let mut bed = Bed { self_collision, ..bed }.pinned(waist);
    bed.run(0.6);
    -bed.centre().y
}

#[test]
fn a_skirt_that_meets_itself_falls_into_folds_nearly_as_fast_as_one_that_does_not() {
    // One touch more or less decides where a single one folds.
    let unevennesses = [0.2, 0.21, 0.22, 0.23];
    let average = |self_collision| {
        let fallen = unevennesses.map(|unevenness| fallen_skirt(self_collision, unevenness));
        fallen.iter().sum::<f32>() / fallen.len() as f32
    };
    let [free, met] = [false, true].map(average);
    println!("fallen by {met} m, {free} m without self-collision");
    // Where the first touch of a few particles stopped the whole skirt, a third of it.
    assert!(met > 0.65 * free, "{met} m of {free} m");
}
