//! The animations. All but the turn are loops, in place: the game moves the model.

use core::f32::consts::PI;

use bevy::math::Vec3;

use super::{
    field::smooth,
    gait::{RUN, WALK},
    pose::{Pose, Step, turn, wave},
    skeleton::{COUNT, LEFT, PELVIS, RIGHT},
};

/// Keys a second.
const RATE: f32 = 30.0;

/// How far resting arms are swung forward, held off the clothes and bent, rad.
const SWING: f32 = 0.03;
const ASIDE: f32 = 0.14;
const ELBOW: f32 = 0.2;

/// m/s²
const GRAVITY: f32 = 9.81;

/// Poses at evenly spaced times.
pub struct Clip {
    pub name: &'static str,
    /// s
    pub times: Vec<[f32; 1]>,
    /// Place of the pelvis, m.
    pub places: Vec<[f32; 3]>,
    /// Turns of each joint.
    pub turns: [Vec<[f32; 4]>; COUNT],
}

pub fn clips() -> Vec<Clip> {
    vec![
        cycle("idle", 3.0, |time| idle(time / 3.0)),
        cycle("walk", WALK.period, |time| WALK.pose(time / WALK.period)),
        cycle("run", RUN.period, |time| RUN.pose(time / RUN.period)),
        cycle("jump", 1.4, jump),
        // 30 Hz would miss its end by a fifteenth of a second.
        Clip::new("turn", (0..=8).map(|key| key as f32 / 32.0), |time| half_turn(time / 0.25)),
        cycle("sit", 4.0, sit),
    ]
}

/// A clip whose last key is its first.
fn cycle(name: &'static str, duration: f32, pose: impl Fn(f32) -> Pose) -> Clip {
    let keys = (duration * RATE).round() as usize;
    let times = (0..=keys).map(|key| key as f32 / RATE);
    Clip::new(name, times, |time| pose(if time * RATE > keys as f32 - 0.5 { 0.0 } else { time }))
}

impl Clip {
    fn new(name: &'static str, times: impl Iterator<Item = f32>, pose: impl Fn(f32) -> Pose) -> Self {
        let mut clip = Self { name, times: Vec::new(), places: Vec::new(), turns: [const { Vec::new() }; COUNT] };
        for time in times {
            let pose = pose(time);
            clip.times.push([time]);
            clip.places.push(pose.global(PELVIS).1.to_array());
            for (joint, turns) in clip.turns.iter_mut().enumerate() {
                let next = pose.local(joint).to_array();
                // Of both quaternions of a turn, the one that is near the last key's.
                let is_near = turns.last().is_none_or(|last| dot(last, &next) >= 0.0);
                turns.push(if is_near { next } else { next.map(|part| -part) });
            }
        }
        clip
    }
}

fn dot(a: &[f32; 4], b: &[f32; 4]) -> f32 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn idle(phase: f32) -> Pose {
    let (breath, sway) = (wave(phase), wave(phase + 0.1));
    let mut pose = Pose::bind();
    pose.shift = Vec3::new(0.008 * sway, -0.012 + 0.003 * breath, 0.0);
    pose.turns[PELVIS] = turn(Vec3::Z, 0.008 * sway);
    pose.bend_trunk(0.02 - 0.02 * breath, 0.012 * sway, 0.012 * sway);
    pose.bend_neck(0.01 * breath, 0.02 * sway);
    for side in [LEFT, RIGHT] {
        pose.hold_arm(side, SWING + 0.01 * breath, ASIDE + 0.012 * breath, ELBOW);
    }
    pose.put_feet(Step { place: Vec3::new(-0.01, 0.0, 0.0), pitch: 0.0 });
    pose
}

/// What has values at some times, and moves smoothly between them.
fn keyed(time: f32, keys: &[(f32, f32)]) -> f32 {
    let later = keys.partition_point(|key| key.0 <= time).clamp(1, keys.len() - 1);
    let (from, to) = (keys[later - 1], keys[later]);
    from.1 + (to.1 - from.1) * smooth(from.0, to.0, time)
}

/// Crouches, leaves the ground at 0.5 s, comes back at 0.9 s.
fn jump(time: f32) -> Pose {
    const OFF: f32 = 0.5;
    const DOWN: f32 = 0.9;
    let mut pose = idle(0.0);
    let flight = (time - OFF) * (DOWN - time) * 0.5 * GRAVITY;
    let crouch = keyed(time, &[(0.0, 0.0), (0.32, -0.26), (0.56, 0.03), (0.84, 0.02), (1.02, -0.2), (1.4, 0.0)]);
    pose.shift.y += crouch + flight.max(0.0);
    pose.shift.z += 0.3 * crouch.min(0.0);
    let lean = -2.6 * crouch.min(0.0);
    pose.turns[PELVIS] = turn(Vec3::X, 0.5 * lean);
    pose.bend_trunk(0.5 * lean + 0.02, 0.0, 0.0);
    pose.bend_neck(-0.6 * lean, 0.0);
    let swing = keyed(time, &[(0.0, SWING), (0.32, -0.9), (0.6, 2.3), (0.95, 0.7), (1.4, SWING)]);
    let elbow = keyed(time, &[(0.0, ELBOW), (0.32, 0.3), (0.6, 0.5), (1.4, ELBOW)]);
    for side in [LEFT, RIGHT] {
        pose.hold_arm(side, swing, ASIDE, elbow);
    }
    let tuck = keyed(time, &[(OFF, 0.0), (0.7, 0.09), (DOWN, 0.0)]);
    let place = Vec3::new(-0.01, flight.max(0.0) + tuck, 0.0);
    let pitch = keyed(time, &[(0.36, 0.0), (OFF + 0.04, 0.75), (DOWN, 0.25), (0.97, 0.0)]);
    pose.put_feet(Step { place, pitch });
    pose
}

/// Turns on the spot by half a turn to the left.
fn half_turn(phase: f32) -> Pose {
    let mut pose = idle(0.0);
    let middle = wave(phase / 2.0);
    // Half evenly and half from rest to rest, which alone would be half as fast again in the middle.
    let about = turn(Vec3::Y, 0.5 * PI * (phase + smooth(0.0, 1.0, phase)));
    pose.turns[PELVIS] = about * pose.turns[PELVIS];
    pose.shift = about * pose.shift;
    // The head goes ahead, and the arms fly.
    pose.bend_trunk(0.0, 0.15 * wave(phase), 0.0);
    pose.bend_neck(0.0, 0.3 * middle);
    for side in [LEFT, RIGHT] {
        pose.hold_arm(side, SWING, ASIDE + 0.3 * middle, ELBOW + 0.3 * middle);
    }
    pose
}

/// Sits down on a seat 0.42 m high, and gets up again.
fn sit(time: f32) -> Pose {
    let down = keyed(time, &[(0.2, 0.0), (1.3, 1.0), (2.5, 1.0), (3.6, 0.0)]);
    let lean = keyed(time, &[(0.1, 0.0), (0.75, 0.6), (1.45, 0.04), (2.3, 0.04), (3.0, 0.65), (3.8, 0.0)]);
    let mut pose = idle(0.0);
    pose.shift += Vec3::new(0.0, -0.43, -0.42) * down + Vec3::new(0.0, 0.0, -0.08 * wave(down / 2.0));
    pose.turns[PELVIS] = turn(Vec3::X, 0.6 * lean - 0.1 * down);
    pose.bend_trunk(0.5 * lean + 0.1 * down + 0.02, 0.0, 0.0);
    pose.bend_neck(-0.5 * lean, 0.0);
    for side in [LEFT, RIGHT] {
        pose.hold_arm(side, SWING + 0.41 * down + 0.5 * lean, ASIDE * (1.0 - 0.6 * down), ELBOW + 0.55 * down);
    }
    pose.put_feet(Step { place: Vec3::new(-0.01, 0.0, 0.0), pitch: 0.0 });
    pose
}
