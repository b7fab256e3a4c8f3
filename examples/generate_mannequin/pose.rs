//! A pose of the skeleton, its legs bent so that the feet are where they ought to be.

use core::f32::consts::PI;

use bevy::math::{Mat3, Quat, Vec3};

use super::skeleton::{CHEST, COUNT, HEAD, JOINTS, LEFT, NECK, PELVIS, RIGHT, SPINE, Side, quaternion};

/// Turn that takes the arm from the bind pose to where it hangs, rad.
const HANG: f32 = 0.56;

/// Where the foot rolls on the ground, m in front of the ankle.
const HEEL: f32 = -0.045;
const TOES: f32 = 0.172;

/// Height of the ankle above the sole, m.
const ANKLE: f32 = 0.085;

#[derive(Clone)]
pub struct Pose {
    /// Shift of the pelvis from its place in the bind pose, m.
    pub shift: Vec3,
    /// Turn of each joint in its parent, along the axes of the model.
    pub turns: [Mat3; COUNT],
}

/// Where a foot is.
#[derive(Clone, Copy)]
pub struct Step {
    /// Place of the ankle if the sole were flat on the ground, from where it is in the bind pose, m.
    pub place: Vec3,
    /// Toes down, rolled over them where positive and over the heel where negative, rad.
    pub pitch: f32,
}

impl Pose {
    pub fn bind() -> Self {
        Self { shift: Vec3::ZERO, turns: [Mat3::IDENTITY; COUNT] }
    }

    /// Turn of a joint from the bind pose, and its place in the model.
    pub fn global(&self, joint: usize) -> (Mat3, Vec3) {
        match JOINTS[joint].parent {
            Some(parent) => {
                let (turn, place) = self.global(parent);
                (turn * self.turns[joint], place + turn * (JOINTS[joint].place - JOINTS[parent].place))
            }
            None => (self.turns[joint], JOINTS[joint].place + self.shift),
        }
    }

    /// The turn of a joint in its parent as the file has it.
    pub fn local(&self, joint: usize) -> Quat {
        let parent = JOINTS[joint].parent.map_or(Mat3::IDENTITY, |parent| JOINTS[parent].axes());
        quaternion(parent.transpose() * self.turns[joint] * JOINTS[joint].axes())
    }

    /// Bends trunk and neck: leans forward, turns and leans to the left, each in rad.
    pub fn bend(&mut self, joints: [usize; 2], lean: f32, yaw: f32, roll: f32) {
        for joint in joints {
            self.turns[joint] =
                self.turns[joint] * turn(Vec3::Y, yaw / 2.0) * turn(Vec3::X, lean / 2.0) * turn(Vec3::Z, -roll / 2.0);
        }
    }

    pub fn bend_trunk(&mut self, lean: f32, yaw: f32, roll: f32) {
        self.bend([SPINE, CHEST], lean, yaw, roll);
    }

    pub fn bend_neck(&mut self, lean: f32, yaw: f32) {
        self.bend([NECK, HEAD], lean, yaw, 0.0);
    }

    /// Lets an arm hang, swings it forward and away from the body, and bends its elbow, each in rad.
    pub fn hold_arm(&mut self, side: Side, swing: f32, aside: f32, elbow: f32) {
        let along = JOINTS[side.lower_arm].tip - JOINTS[side.lower_arm].place;
        let hinge = along.cross(Vec3::Z).normalize();
        self.turns[side.upper_arm] = turn(Vec3::X, -swing) * turn(Vec3::Z, side.sign * (aside - HANG));
        self.turns[side.lower_arm] = turn(hinge, elbow);
        self.turns[side.hand] = turn(hinge, 0.1);
    }

    /// Bends a leg so that its foot is at a step. `yaw` turns the foot, to the left.
    pub fn put_foot(&mut self, side: Side, step: Step, yaw: f32) {
        let foot = turn(Vec3::Y, yaw) * turn(Vec3::X, step.pitch);
        let ankle = JOINTS[side.foot].place + step.place + turn(Vec3::Y, yaw) * rolled(step.pitch);
        let (pelvis, hip) = (self.global(PELVIS).0, self.global(side.thigh).1);
        let [bind_thigh, bind_shin] = [side.thigh, side.shin].map(|joint| JOINTS[joint].tip - JOINTS[joint].place);
        let [thigh, shin] = bent(ankle - hip, pelvis * Vec3::Z, bind_thigh.length(), bind_shin.length());
        let hinge = thigh.cross(shin).normalize();
        let upper = frame(thigh, hinge) * frame(bind_thigh, Vec3::X).transpose();
        let lower = frame(shin, hinge) * frame(bind_shin, Vec3::X).transpose();
        self.turns[side.thigh] = pelvis.transpose() * upper;
        self.turns[side.shin] = upper.transpose() * lower;
        self.turns[side.foot] = lower.transpose() * foot;
    }

    /// Puts both feet on the same kind of step, each on its side.
    pub fn put_feet(&mut self, step: Step) {
        for side in [LEFT, RIGHT] {
            let place = step.place * Vec3::new(side.sign, 1.0, 1.0);
            self.put_foot(side, Step { place, ..step }, 0.0);
        }
    }
}

/// How far the ankle moves as the foot rolls over its heel or its toes.
fn rolled(pitch: f32) -> Vec3 {
    let pivot = Vec3::new(0.0, -ANKLE, if pitch > 0.0 { TOES } else { HEEL });
    pivot - turn(Vec3::X, pitch) * pivot
}

/// Thigh and shin from the hip to the ankle, the knee towards `forward`.
fn bent(way: Vec3, forward: Vec3, thigh: f32, shin: f32) -> [Vec3; 2] {
    // A leg is never quite straight: the last millimetres would snap the knee.
    let distance = way.length().clamp(0.3 * thigh, 0.9985 * (thigh + shin));
    let along = way.normalize();
    let aside = (forward - along * forward.dot(along)).normalize();
    let cosine = (thigh * thigh + distance * distance - shin * shin) / (2.0 * thigh * distance);
    let knee = along * (thigh * cosine) + aside * (thigh * (1.0 - cosine * cosine).max(0.0).sqrt());
    [knee, along * distance - knee]
}

/// Axes with Y along a bone and X as near to `hinge` as that allows.
fn frame(along: Vec3, hinge: Vec3) -> Mat3 {
    let along = along.normalize();
    let across = (hinge - along * hinge.dot(along)).normalize();
    Mat3::from_cols(across, along, across.cross(along))
}

/// A turn about an axis of length 1 (Rodrigues).
pub fn turn(axis: Vec3, angle: f32) -> Mat3 {
    let (sin, cos) = (libm::sinf(angle), libm::cosf(angle));
    let column = |v: Vec3| v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos));
    Mat3::from_cols(column(Vec3::X), column(Vec3::Y), column(Vec3::Z))
}

/// The sine of a share of a whole turn.
pub fn wave(turns: f32) -> f32 {
    libm::sinf(2.0 * PI * turns)
}
