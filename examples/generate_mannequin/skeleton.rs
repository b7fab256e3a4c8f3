//! The armature: 17 joints in their bind pose, arms halfway down.

use bevy::math::{Mat3, Quat, Vec3};

pub const COUNT: usize = 17;

pub const PELVIS: usize = 0;
pub const SPINE: usize = 1;
pub const CHEST: usize = 2;
pub const NECK: usize = 3;
pub const HEAD: usize = 4;

/// The joints of one side's limbs.
#[derive(Clone, Copy)]
pub struct Side {
    /// 1 on the left, which is towards positive x, and -1 on the right.
    pub sign: f32,
    pub upper_arm: usize,
    pub lower_arm: usize,
    pub hand: usize,
    pub thigh: usize,
    pub shin: usize,
    pub foot: usize,
}

pub const LEFT: Side = Side { sign: 1.0, upper_arm: 5, lower_arm: 6, hand: 7, thigh: 11, shin: 12, foot: 13 };
pub const RIGHT: Side = Side { sign: -1.0, upper_arm: 8, lower_arm: 9, hand: 10, thigh: 14, shin: 15, foot: 16 };

/// A joint in the bind pose.
pub struct Joint {
    pub name: &'static str,
    pub parent: Option<usize>,
    pub place: Vec3,
    /// Where its bone ends.
    pub tip: Vec3,
}

const fn joint(name: &'static str, parent: usize, place: [f32; 3], tip: [f32; 3]) -> Joint {
    let parent = if parent == COUNT { None } else { Some(parent) };
    Joint { name, parent, place: Vec3::from_array(place), tip: Vec3::from_array(tip) }
}

/// Each joint after its parent.
pub const JOINTS: [Joint; COUNT] = [
    joint("pelvis", COUNT, [0.0, 0.96, 0.0], [0.0, 1.07, 0.0]),
    joint("spine", PELVIS, [0.0, 1.07, 0.0], [0.0, 1.24, -0.01]),
    joint("chest", SPINE, [0.0, 1.24, -0.01], [0.0, 1.49, -0.025]),
    joint("neck", CHEST, [0.0, 1.49, -0.025], [0.0, 1.585, 0.0]),
    joint("head", NECK, [0.0, 1.585, 0.0], [0.0, 1.8, 0.01]),
    joint("upper_arm.L", CHEST, [0.178, 1.43, -0.02], [0.362, 1.208, -0.03]),
    joint("lower_arm.L", LEFT.upper_arm, [0.362, 1.208, -0.03], [0.528, 1.008, -0.01]),
    joint("hand.L", LEFT.lower_arm, [0.528, 1.008, -0.01], [0.642, 0.872, 0.0]),
    joint("upper_arm.R", CHEST, [-0.178, 1.43, -0.02], [-0.362, 1.208, -0.03]),
    joint("lower_arm.R", RIGHT.upper_arm, [-0.362, 1.208, -0.03], [-0.528, 1.008, -0.01]),
    joint("hand.R", RIGHT.lower_arm, [-0.528, 1.008, -0.01], [-0.642, 0.872, 0.0]),
    joint("thigh.L", PELVIS, [0.094, 0.92, 0.0], [0.104, 0.5, 0.012]),
    joint("shin.L", LEFT.thigh, [0.104, 0.5, 0.012], [0.112, 0.085, -0.02]),
    joint("foot.L", LEFT.shin, [0.112, 0.085, -0.02], [0.128, 0.02, 0.17]),
    joint("thigh.R", PELVIS, [-0.094, 0.92, 0.0], [-0.104, 0.5, 0.012]),
    joint("shin.R", RIGHT.thigh, [-0.104, 0.5, 0.012], [-0.112, 0.085, -0.02]),
    joint("foot.R", RIGHT.shin, [-0.112, 0.085, -0.02], [-0.128, 0.02, 0.17]),
];

impl Joint {
    /// Its axes in the bind pose: as in Blender, Y points along the bone.
    pub fn axes(&self) -> Mat3 {
        let along = (self.tip - self.place).normalize();
        let across = along.cross(Vec3::new(0.0, 0.3, 1.0)).normalize();
        Mat3::from_cols(across, along, across.cross(along))
    }

    /// Place and turn in its parent, or in the model.
    pub fn local(&self) -> (Vec3, Quat) {
        match self.parent.map(|parent| &JOINTS[parent]) {
            Some(parent) => {
                let into_parent = parent.axes().transpose();
                (into_parent * (self.place - parent.place), quaternion(into_parent * self.axes()))
            }
            None => (self.place, quaternion(self.axes())),
        }
    }

    /// The inverse of its bind pose, by columns.
    pub fn inverse_bind(&self) -> [f32; 16] {
        let turn = self.axes().transpose();
        let shift = -(turn * self.place);
        let [x, y, z] = turn.to_cols_array_2d();
        let mut matrix = [0.0; 16];
        for (column, value) in matrix.chunks_exact_mut(4).zip([x, y, z, shift.to_array()]) {
            column[..3].copy_from_slice(&value);
        }
        matrix[15] = 1.0;
        matrix
    }
}

/// A turn as glTF wants it.
pub fn quaternion(turn: Mat3) -> Quat {
    Quat::from_mat3(&turn)
}
