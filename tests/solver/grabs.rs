//! A cloth that is held and pulled by hand.

use bevy::{
    math::{Isometry3d, Vec3A},
    prelude::*,
};
use bevy_drape::{
    build,
    prelude::{ClothGrid, ClothGrip, Fabric},
    solver::{ColliderShape, Grab, Material, Method, Obstacle, measure},
};

use crate::bench_bed::Bed;

const STEP: f32 = 1.0 / 60.0;

fn cotton() -> Material {
    Fabric::default().material().expect("valid constants")
}

/// A hand at `weights` of a triangle.
pub fn hand(bed: &Bed, triangle: usize, weights: [f32; 3], grip: ClothGrip) -> Grab {
    let particles = bed.topology.triangles[triangle];
    let corners = particles.map(|i| bed.particles.position[i as usize]);
    let place = corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2];
    Grab {
        particles,
        weights,
        start: place,
        end: place,
        stiffness: grip.stiffness,
        damping: grip.damping,
        max_force: grip.max_force,
        mass: grip.mass,
        tethers: build::grab_tethers(&bed.topology, particles, weights).into(),
    }
}

/// A bed with a hand in the middle of a triangle near its centre.
fn held(mut bed: Bed, grip: ClothGrip) -> Bed {
    let triangle = bed.topology.triangles.len() / 2 + (bed.topology.triangles.len() as f32).sqrt() as usize / 2;
    bed.grabs = vec![hand(&bed, triangle, [0.5, 0.2, 0.3], grip)];
    bed
}

/// The point that the first hand holds.
fn point(bed: &Bed) -> Vec3A {
    let Grab { particles, weights, .. } = &bed.grabs[0];
    (0..3).map(|i| bed.particles.position[particles[i] as usize] * weights[i]).sum()
}

/// Leads the first hand to `target` at the default grip's speed, and looks at the cloth after each step.
fn lead(bed: &mut Bed, target: Vec3A, seconds: f32, mut look: impl FnMut(&Bed)) {
    for _ in 0..(seconds / STEP).round() as u32 {
        let grab = &mut bed.grabs[0];
        grab.start = grab.end;
        grab.end = grab.start.move_towards(target, ClothGrip::default().max_speed * STEP);
        bed.step(STEP);
        look(bed);
    }
}

/// A square metre that hangs by two corners and has come to rest.
fn hanging(n: u32) -> Bed {
    let mut bed = Bed::new(ClothGrid::new(1.0, 1.0, n, n), cotton()).pinned([0, n - 1]);
    bed.tethers = build::tethers(&bed.topology, &[0, n - 1]);
    bed.run(1.0);
    bed
}

#[test]
fn a_held_point_goes_where_the_hand_goes() {
    for method in [Method::Xpbd, Method::Explicit] {
        let mut bed = held(hanging(17), ClothGrip::default());
        bed.method = method;
        let target = point(&bed) + Vec3A::new(0.05, 0.15, 0.25);
        lead(&mut bed, target, 1.0, |_| {});
        let off = point(&bed).distance(target);
        assert!(off < 0.003, "{method:?}: {off} m");
    }
}

#[test]
fn a_hand_lifts_a_cloth_by_a_point_and_no_farther_than_its_force_allows() {
    // The cloth weighs 2 N, the hand itself 1 N.
    for (max_force, is_lifted) in [(20.0, true), (1.0, false)] {
        let mut bed = held(Bed::lying(32, cotton()), ClothGrip { max_force, ..default() });
        let target = point(&bed) + Vec3A::Y;
        lead(&mut bed, target, 2.0, |_| {});
        let off = point(&bed).distance(target);
        println!("{max_force} N: {off} m, {:?}", measure::strain(&bed.particles, &bed.topology));
        assert_eq!(off < 0.01, is_lifted, "{max_force} N: {off} m");
    }
}

#[test]
fn a_jerk_of_a_metre_neither_tears_nor_throws_the_cloth() {
    for n in [32, 64] {
        let mut bed = held(hanging(n), ClothGrip::default());
        let start = point(&bed);
        let tethers = bed.tethers.clone();
        let (mut largest, mut mean, mut excess, mut speed) = (0.0_f32, 0.0_f32, 0.0_f32, 0.0_f32);
        for target in [Vec3A::Z, -Vec3A::Z, Vec3A::Y * 2.0, Vec3A::X] {
            lead(&mut bed, start + target, 0.5, |bed| {
                let strain = measure::strain(&bed.particles, &bed.topology);
                largest = largest.max(strain.largest);
                mean = mean.max(strain.mean);
                speed = speed.max(bed.fastest());
                for tether in &tethers {
                    let ends = [tether.particle, tether.pin].map(|i| bed.particles.position[i as usize]);
                    excess = excess.max(ends[0].distance(ends[1]) - tether.length);
                }
            });
        }
        // What is whipped about stretches the most, at the free corners as near the hand.
        println!("{n} x {n}: largest strain {largest}, mean {mean}, {excess} m beyond the tethers, {speed} m/s");
        assert!(bed.particles.is_finite());
        assert!(largest < 0.7 && mean < 0.03 && excess < 0.03 && speed < 20.0);
        bed.grabs.clear();
        bed.run(5.0);
        let left = measure::strain(&bed.particles, &bed.topology).largest;
        assert!(left < 0.01, "{n} x {n} keeps a strain of {left}");
    }
}

#[test]
fn a_hand_pulls_no_cloth_into_an_obstacle() {
    let ball = ColliderShape::Sphere(Sphere::new(0.2));
    let board = ColliderShape::Cuboid(Cuboid::new(2.0, 0.02, 2.0));
    for shape in [ball, board] {
        let place = Isometry3d::IDENTITY;
        let mut bed = Bed::lying(32, cotton());
        bed.particles.position.iter_mut().for_each(|p| p.y += 0.25);
        bed.obstacles = vec![Obstacle { shape, start: place, end: place, friction: 1.0 }];
        bed.run(1.0);
        let mut bed = held(bed, ClothGrip::default());
        lead(&mut bed, Vec3A::NEG_Y, 1.0, |bed| {
            let deepest = bed.particles.position.iter().map(|&p| shape.surface(p).distance).fold(f32::MAX, f32::min);
            assert!(deepest > 0.0, "{shape:?}: {deepest} m");
        });
        let above = bed.particles.position.iter().filter(|p| p.y > 0.0).count();
        assert!(above > 32 * 16 || matches!(shape, ColliderShape::Sphere(_)), "{above} particles are above the board");
    }
}

#[test]
fn what_is_let_go_keeps_its_speed() {
    let mut bed = Bed::lying(16, cotton());
    bed.gravity = Vec3A::ZERO;
    let mut bed = held(bed, ClothGrip { max_force: 1000.0, ..default() });
    for _ in 0..30 {
        let grab = &mut bed.grabs[0];
        (grab.start, grab.end) = (grab.end, grab.end + Vec3A::Y * 2.0 * STEP);
        bed.step(STEP);
    }
    let speed = |bed: &Bed| bed.particles.velocity.iter().sum::<Vec3A>() / bed.particles.len() as f32;
    bed.grabs.clear();
    let before = speed(&bed);
    assert!(before.y > 1.0, "{before}");
    bed.fluid_density = 0.0;
    bed.material.damping = 0.0;
    bed.run(0.2);
    assert!(speed(&bed).distance(before) < 0.01 * before.y, "{} after {before}", speed(&bed));
}

#[test]
fn tethers_to_a_held_point_are_as_long_as_the_straight_line_on_a_flat_grid() {
    let bed = Bed::lying(33, cotton());
    let grab = hand(&bed, 999, [0.2, 0.3, 0.5], ClothGrip::default());
    assert_eq!(grab.tethers.len(), 33 * 33 - 3);
    for tether in &*grab.tethers {
        let straight = bed.particles.position[tether.particle as usize].distance(grab.start);
        assert!((-1e-3..2e-3).contains(&(tether.length / straight - 1.0)), "{tether:?}: {straight} m");
    }
}
