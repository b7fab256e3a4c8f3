//! A cloth that is fixed to a body pulls it along.

use core::f32::consts::TAU;

use bevy_math::{Mat3A, Quat, Vec3A};
use drape_solver::{AttachedPin, Body, BodyAttachment, Method};

use crate::{
    bench_bed::{ALL, Bed, GRAVITY, STABLE},
    fixtures::{
        material::{Fabric, bare},
        mesh::Grid,
    },
};

const STEP: f32 = 1.0 / 60.0;

/// A ball as a physics engine has it.
#[derive(Clone, Copy, Debug)]
struct Ball {
    mass: f32,
    radius: f32,
    centre: Vec3A,
    turn: Quat,
    velocity: Vec3A,
    spin: Vec3A,
}

impl Ball {
    fn at(centre: Vec3A, mass: f32, radius: f32) -> Self {
        Self { mass, radius, centre, turn: Quat::IDENTITY, velocity: Vec3A::ZERO, spin: Vec3A::ZERO }
    }

    fn inertia(&self) -> f32 {
        0.4 * self.mass * self.radius * self.radius
    }

    /// A step of the engine, and then one of the cloth that `particles` are fixed to it by, at `arms` of its frame.
    fn step(&mut self, bed: &mut Bed, arms: &[(u32, Vec3A)], dt: f32) {
        let before = *self;
        self.velocity += bed.gravity * dt;
        self.centre += self.velocity * dt;
        self.turn = (Quat::from_scaled_axis((self.spin * dt).into()) * self.turn).normalize();
        let world = bed.pin_motions.len() - bed.attached_pins.len();
        bed.attached_pins.clear();
        for (k, &(particle, arm)) in arms.iter().enumerate() {
            let anchor = &mut bed.pin_motions[world + k];
            assert_eq!(anchor.particle, particle);
            anchor.start = bed.particles.position[particle as usize];
            anchor.end = self.centre + self.turn * arm;
            bed.attached_pins.push(AttachedPin { pin_motion: (world + k) as u32, attachment: 0 });
        }
        let inverse_inertia = Mat3A::from_diagonal(Vec3A::splat(1.0 / self.inertia()).into());
        let body = Body { inverse_mass: 1.0 / self.mass, inverse_inertia, centre: before.centre };
        bed.body_attachments = vec![BodyAttachment { body, displacement: self.centre - before.centre }];
        bed.step(dt);
        let (impulse, displacement) = bed.scratch.attachment_impulses()[0];
        self.velocity += impulse.linear / self.mass;
        self.spin += impulse.angular / self.inertia();
        self.centre += displacement.shift;
        self.turn = (displacement.turn * self.turn).normalize();
    }

    fn place(&self, arm: Vec3A) -> Vec3A {
        self.centre + self.turn * arm
    }
}

/// A cloth with all of its edge `particles` fixed to a ball below that edge, and its arms.
fn on_a_ball(mut bed: Bed, particles: &[u32], ball: &Ball) -> (Bed, Vec<(u32, Vec3A)>) {
    let arms: Vec<_> = particles.iter().map(|&i| (i, bed.particles.position[i as usize] - ball.centre)).collect();
    bed = bed.pinned(particles.iter().copied());
    for &(pin_motion, _) in &arms {
        bed.attached_pins.push(AttachedPin { pin_motion, attachment: 0 });
    }
    (bed, arms)
}

fn cotton() -> Fabric {
    Fabric { damping: 0.0, drag: 0.0, lift: 0.0, ..Fabric::COTTON_WOVEN }
}

/// Momentum of cloth and ball, N s, and angular momentum about the origin, N m s.
fn momentum(bed: &Bed, ball: &Ball) -> [Vec3A; 2] {
    let mut sums = [ball.velocity * ball.mass, ball.spin * ball.inertia()];
    sums[1] += ball.centre.cross(sums[0]);
    for (i, (&place, &velocity)) in bed.particles.position.iter().zip(&bed.particles.velocity).enumerate() {
        let own = velocity * (bed.material.density * bed.topology.areas[i]);
        sums[0] += own;
        sums[1] += place.cross(own);
    }
    sums
}

#[test]
fn momentum_goes_from_cloth_to_body_and_back_whole() {
    for method in ALL {
        for mass in [0.005, 0.2, 20.0] {
            let mut bed = Bed::lying(9, bare(cotton())).with_substeps(8);
            (bed.method, bed.gravity) = (method, Vec3A::ZERO);
            let mut ball = Ball::at(Vec3A::new(-0.5, -0.1, 0.0), mass, 0.1);
            let (mut bed, arms) = on_a_ball(bed, &[27, 36, 45], &ball);
            for (place, velocity) in bed.particles.position.iter().zip(&mut bed.particles.velocity) {
                *velocity = Vec3A::new(1.0, 2.0 * (place.x + 0.5), 0.5 * place.x);
            }
            for &(particle, _) in &arms {
                bed.particles.velocity[particle as usize] = Vec3A::ZERO;
            }
            let [linear, angular] = momentum(&bed, &ball);
            for _ in 0..60 {
                ball.step(&mut bed, &arms, STEP);
            }
            let [linear_end, angular_end] = momentum(&bed, &ball);
            let (lost, turned) = ((linear_end - linear).length(), (angular_end - angular).length());
            // Rounding moves what is heavy by 0.1 mm/s.
            let rounding = 1e-4 * mass;
            // What weighs less than the cloth at its anchors follows the explicit method's forces one substep late.
            let exact = if method == Method::Explicit { 0.1 } else { 0.01 };
            assert!(lost < exact * linear.length() + rounding, "{method:?}, {mass} kg: {linear_end} of {linear}");
            assert!(turned < 0.03 * linear.length(), "{method:?}, {mass} kg: {angular_end} of {angular}");
            assert!(ball.velocity.length() > 0.0, "{method:?}, {mass} kg");
        }
    }
}

#[test]
fn a_body_falls_with_its_cloth_as_fast_as_anything() {
    for mass in [0.001, 1.0] {
        let bed = Bed::lying(9, bare(cotton())).with_substeps(8);
        let mut ball = Ball::at(Vec3A::ZERO, mass, 0.1);
        let (mut bed, arms) = on_a_ball(bed, &[36, 44], &ball);
        for _ in 0..30 {
            ball.step(&mut bed, &arms, STEP);
        }
        let speed = GRAVITY * 0.5;
        assert!((ball.velocity.y + speed).abs() < 0.01 * speed, "{mass} kg: {}", ball.velocity);
    }
}

#[test]
fn a_body_hangs_on_a_cloth_whatever_its_mass() {
    for method in STABLE {
        for mass in [0.001, 0.1, 5.0] {
            // Hung by its upper edge, with a ball at the middle of the lower one.
            let stiff = Fabric { warp_stiffness: 20_000.0, weft_stiffness: 20_000.0, damping: 1.0, ..cotton() };
            let material = stiff.material();
            let mut bed = Bed::new(Grid::new(0.4, 1.0, 5, 11), material).with_substeps(16).pinned(0..5);
            bed = bed.tethered(&[0, 1, 2, 3, 4]);
            (bed.method, bed.tether_slack) = (method, 0.005);
            let bottom = bed.particles.position[52];
            let mut ball = Ball::at(bottom - Vec3A::Y * 0.05, mass, 0.05);
            let (mut bed, arms) = on_a_ball(bed, &[52], &ball);
            for _ in 0..300 {
                ball.step(&mut bed, &arms, STEP);
                assert!(bed.particles.is_finite(), "{method:?}, {mass} kg");
            }
            let sunk = bottom.y - ball.place(arms[0].1).y;
            assert!((-0.001..0.02).contains(&sunk), "{method:?}, {mass} kg: sank by {sunk} m");
            let before = ball.centre;
            ball.step(&mut bed, &arms, STEP);
            let moved = (ball.centre - before).length();
            assert!(moved < 1e-3, "{method:?}, {mass} kg moved by {moved} m");
            let apart = bed.particles.position[52].distance(ball.place(arms[0].1));
            assert!(apart < 1e-4, "{method:?}, {mass} kg: {apart} m apart");
        }
    }
}

#[test]
fn a_ball_on_a_ribbon_swings_as_a_pendulum() {
    let ribbon = Grid::new(0.02, 1.0, 2, 21);
    let mut bed = Bed::new(ribbon, bare(cotton())).with_substeps(16).pinned([0, 1]).tethered(&[0, 1]);
    bed.tether_slack = 0.005;
    let (top, bottom) = (bed.particles.position[0].y, bed.particles.position[40].y);
    let mut ball = Ball::at(Vec3A::Y * bottom, 2.0, 0.01);
    let (mut bed, arms) = on_a_ball(bed, &[40, 41], &ball);
    ball.velocity = Vec3A::Z * 0.3;
    let (mut crossings, mut before) = (Vec::new(), 0.0);
    for i in 0..600 {
        ball.step(&mut bed, &arms, STEP);
        if before < 0.0 && ball.centre.z >= 0.0 {
            crossings.push(i as f32 * STEP);
        }
        before = ball.centre.z;
    }
    let period = (crossings[crossings.len() - 1] - crossings[0]) / (crossings.len() - 1) as f32;
    let expected = TAU * ((top - bottom) / GRAVITY).sqrt();
    assert!((period / expected - 1.0).abs() < 0.03, "{period} s for {expected} s");
}

#[test]
fn a_feather_on_the_whole_edge_of_a_heavy_cloth_stays_finite() {
    for method in ALL {
        for (mass, radius) in [(1e-4, 0.01), (0.01, 0.05)] {
            let mut bed = Bed::lying(17, bare(cotton())).with_substeps(8);
            bed.method = method;
            let edge: Vec<u32> = (0..17).map(|row| row * 17).collect();
            let mut ball = Ball::at(Vec3A::new(-0.5, 0.3, 0.0), mass, radius);
            let (bed, arms) = on_a_ball(bed, &edge, &ball);
            let mut bed = bed.pinned([16 * 17 + 16]);
            // Those of the ball come last.
            bed.pin_motions.rotate_right(1);
            for _ in 0..240 {
                ball.step(&mut bed, &arms, STEP);
                assert!(ball.centre.is_finite() && bed.particles.is_finite(), "{method:?}: {ball:?}");
            }
        }
    }
}
