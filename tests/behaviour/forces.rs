//! Forces and impulses act as Newton says, and only on what is free.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::common::*;

const GRID: ClothGrid = ClothGrid { size: Vec2::ONE, particles: UVec2::new(5, 5), lying: false };
const FLOATING: f32 = 0.0;

/// A cloth of 1 kg in 16 cells without springs, weight and air: each particle is on its own.
fn dust(pins: Pins) -> (App, Entity) {
    let mut app = headless();
    let fabric = Fabric { density: 1.0, ..undamped() };
    let springs = ClothSprings { structural_stiffness: 0.0, shear_stiffness: 0.0, bend_stiffness: 0.0, ..default() };
    let cloth = Cloth { gravity_scale: FLOATING, tether_slack: None, ..default() };
    let cloth = spawn_cloth(&mut app, GRID, (fabric, springs, cloth, pins));
    run(&mut app, 1);
    (app, cloth)
}

/// Mass of a particle, kg: its share of the area at 1 kg/m².
fn mass(app: &App, cloth: Entity, particle: usize) -> f32 {
    state(app, cloth).topology().areas[particle]
}

fn velocity(app: &App, cloth: Entity, particle: usize) -> Vec3 {
    state(app, cloth).velocity(particle).unwrap()
}

fn momentum(app: &App, cloth: Entity) -> Vec3 {
    state(app, cloth).velocities().enumerate().map(|(i, velocity)| velocity * mass(app, cloth, i)).sum()
}

#[test]
fn the_particles_weigh_what_the_cloth_weighs() {
    let (app, cloth) = dust(Pins::none());
    let total: f32 = (0..25).map(|i| mass(&app, cloth, i)).sum();
    assert!((total - 1.0).abs() < 1e-5);
}

#[test]
fn a_force_acts_for_one_step() {
    let (mut app, cloth) = dust(Pins::none());
    let force = Vec3::new(0.3, -0.2, 0.1);
    get_mut::<ClothState>(&mut app, cloth).add_force(12, force);
    get_mut::<ClothState>(&mut app, cloth).add_force(12, force);
    let expected = 2.0 * force / mass(&app, cloth, 12) * STEP;
    for _ in 0..3 {
        run(&mut app, 1);
        assert_close(velocity(&app, cloth, 12), expected, 1e-3 * expected.length());
        assert_eq!(velocity(&app, cloth, 11), Vec3::ZERO);
    }
}

#[test]
fn an_impulse_acts_at_once() {
    let (mut app, cloth) = dust(Pins::none());
    let impulse = Vec3::new(0.003, 0.0, -0.001);
    get_mut::<ClothState>(&mut app, cloth).add_impulse(7, impulse);
    let expected = impulse / mass(&app, cloth, 7);
    assert_close(velocity(&app, cloth, 7), expected, 1e-6);
    run(&mut app, 5);
    assert_close(velocity(&app, cloth, 7), expected, 1e-4);
}

#[test]
fn a_force_in_a_radius_adds_up_to_what_was_asked() {
    let (mut app, cloth) = dust(Pins::indices([0, 6]));
    let force = Vec3::new(0.0, 0.5, 2.0);
    get_mut::<ClothState>(&mut app, cloth).add_force_in_radius(Vec3::new(-0.2, 0.2, 0.05), 0.6, force);
    run(&mut app, 1);
    assert_close(momentum(&app, cloth), force * STEP, 1e-4);
    assert_eq!((velocity(&app, cloth, 0), velocity(&app, cloth, 6)), (Vec3::ZERO, Vec3::ZERO));
    // Nearer particles are accelerated more, and those beyond the radius aren't.
    assert!(velocity(&app, cloth, 7).z > velocity(&app, cloth, 13).z && velocity(&app, cloth, 13).z > 0.0);
    assert_eq!(velocity(&app, cloth, 24), Vec3::ZERO);
}

#[test]
fn an_impulse_in_a_radius_adds_up_to_what_was_asked() {
    let (mut app, cloth) = dust(Pins::indices([12]));
    let impulse = Vec3::new(0.01, 0.0, 0.02);
    get_mut::<ClothState>(&mut app, cloth).add_impulse_in_radius(Vec3::ZERO, 0.4, impulse);
    assert_close(momentum(&app, cloth), impulse, 1e-6);
    assert_eq!(velocity(&app, cloth, 12), Vec3::ZERO);
}

#[test]
fn nothing_moves_what_is_pinned() {
    let (mut app, cloth) = dust(Pins::indices([12]));
    for _ in 0..5 {
        let mut state = get_mut::<ClothState>(&mut app, cloth);
        state.add_force(12, Vec3::splat(1e6));
        state.add_impulse(12, Vec3::splat(1e6));
        run(&mut app, 1);
    }
    assert_eq!(place(&app, cloth, 12), Vec3::ZERO);
    assert_eq!(velocity(&app, cloth, 12), Vec3::ZERO);
    // Nor is a force stored up until it is free.
    *get_mut::<Pins>(&mut app, cloth) = Pins::none();
    run(&mut app, 5);
    assert_eq!(place(&app, cloth, 12), Vec3::ZERO);
}
