//! Walking and running: feet that stay where they stand while the body goes on.

use bevy::math::Vec3;

use super::{
    field::smooth,
    pose::{Pose, Step, turn, wave},
    skeleton::{LEFT, PELVIS, RIGHT},
};

/// A way to go, as shares of a cycle that begins when the left heel strikes the ground.
pub struct Gait {
    /// m/s
    pub speed: f32,
    /// Duration of two steps, s.
    pub period: f32,
    /// Share of the cycle for which a foot is on the ground.
    pub stance: f32,
    /// Shares of the stance between which the sole is flat.
    pub flat: [f32; 2],
    /// Place of the ankle in the middle of the stance, m in front of its place in the bind pose.
    pub ahead: f32,
    /// How far the feet are nearer together than in the bind pose, m.
    pub inwards: f32,
    /// Pitch of the foot where it strikes and where it leaves the ground, rad.
    pub pitch: [f32; 2],
    /// How much higher the ankle gets while it swings, m.
    pub lift: f32,
    /// Height of the pelvis, and how much higher it is in the middle of a stance than between, m.
    pub height: f32,
    pub bob: f32,
    /// Turn and roll of the pelvis, rad.
    pub yaw: f32,
    pub roll: f32,
    /// Shift of the pelvis over the standing foot, m.
    pub sway: f32,
    /// Lean of the trunk, rad.
    pub lean: f32,
    /// Swing of the arms about their middle, and that, rad.
    pub swing: f32,
    pub arms_ahead: f32,
    /// How far the arms are held off the clothes, rad.
    pub arms_aside: f32,
    /// Bend of the elbow behind and in front, rad.
    pub elbow: [f32; 2],
}

pub const WALK: Gait = Gait {
    speed: 1.4,
    period: 1.0,
    stance: 0.58,
    flat: [0.2, 0.5],
    ahead: -0.005,
    inwards: 0.03,
    pitch: [-0.35, 0.85],
    lift: 0.0,
    height: -0.035,
    bob: 0.016,
    yaw: 0.11,
    roll: 0.05,
    sway: 0.02,
    lean: 0.05,
    swing: 0.42,
    arms_ahead: 0.04,
    arms_aside: 0.13,
    elbow: [0.22, 0.55],
};

pub const RUN: Gait = Gait {
    speed: 5.0,
    period: 20.0 / 30.0,
    stance: 0.25,
    flat: [0.15, 0.35],
    ahead: -0.02,
    inwards: 0.06,
    pitch: [-0.12, 1.0],
    lift: 0.22,
    height: -0.065,
    bob: -0.03,
    yaw: 0.16,
    roll: 0.06,
    sway: 0.01,
    lean: 0.24,
    swing: 0.75,
    arms_ahead: 0.0,
    arms_aside: 0.15,
    elbow: [1.45, 1.75],
};

impl Gait {
    /// The pose at a share of the cycle.
    pub fn pose(&self, phase: f32) -> Pose {
        let forward = wave(phase + 0.25);
        let over_left = wave(phase - self.stance / 2.0 + 0.25);
        let bob = wave(2.0 * (phase - self.stance / 2.0) + 0.25);

        let mut pose = Pose::bind();
        pose.shift = Vec3::new(self.sway * over_left, self.height + self.bob * bob, 0.0);
        pose.turns[PELVIS] =
            turn(Vec3::Y, -self.yaw * forward) * turn(Vec3::X, 0.4 * self.lean) * turn(Vec3::Z, self.roll * over_left);
        // The shoulders turn against the hips.
        pose.bend_trunk(0.6 * self.lean, 2.0 * self.yaw * forward, self.roll * over_left);
        pose.bend_neck(-0.8 * self.lean, -self.yaw * forward);

        for (side, phase) in [(LEFT, phase), (RIGHT, phase + 0.5)] {
            let ahead = -wave(phase + 0.25);
            let elbow = self.elbow[0] + (self.elbow[1] - self.elbow[0]) * (0.5 + 0.5 * ahead);
            pose.hold_arm(side, self.arms_ahead + self.swing * ahead, self.arms_aside, elbow);
            let mut step = self.step(phase - phase.floor());
            step.place.x -= self.inwards * side.sign;
            pose.put_foot(side, step, 0.0);
        }
        pose
    }

    /// Where a foot is at a share of the cycle after its strike.
    fn step(&self, phase: f32) -> Step {
        if phase <= self.stance {
            return self.stand(phase);
        }
        let span = 1.0 - self.stance;
        let ends = [self.stand(self.stance), self.stand(0.0)];
        let nudge = 1e-3;
        let before = self.stand(self.stance - nudge);
        let after = self.stand(nudge);
        let t = (phase - self.stance) / span;
        let between = |value: fn(&Step) -> f32| {
            let [start, end] = ends.each_ref().map(value);
            let slopes = [(start - value(&before)) / nudge * span, (value(&after) - end) / nudge * span];
            hermite(t, [start, end], slopes)
        };
        let lift = self.lift * smooth(0.0, 0.45, t) * smooth(1.0, 0.35, t);
        Step {
            place: Vec3::new(0.0, between(|step| step.place.y) + lift, between(|step| step.place.z)),
            pitch: between(|step| step.pitch),
        }
    }

    /// A foot on the ground, which moves back under the body.
    fn stand(&self, phase: f32) -> Step {
        let (share, [flat_from, flat_to]) = (phase / self.stance, self.flat);
        let rise = ((share - flat_to) / (1.0 - flat_to)).max(0.0);
        let pitch = self.pitch[0] * (1.0 - smooth(0.0, flat_from, share)) + self.pitch[1] * rise * rise;
        let way = self.speed * self.period * (phase - self.stance / 2.0);
        Step { place: Vec3::new(0.0, 0.0, self.ahead - way), pitch }
    }
}

/// The cubic from one value and slope to another.
pub fn hermite(t: f32, [start, end]: [f32; 2], [start_slope, end_slope]: [f32; 2]) -> f32 {
    let (t2, t3) = (t * t, t * t * t);
    start * (2.0 * t3 - 3.0 * t2 + 1.0)
        + start_slope * (t3 - 2.0 * t2 + t)
        + end * (3.0 * t2 - 2.0 * t3)
        + end_slope * (t3 - t2)
}
