//! The body's shape: a tailor's dummy of lofts and ellipsoids, 1.8 m tall.
//!
//! All of it is symmetric: only the left half (x > 0) is described.

use bevy::math::Vec3;

use super::{
    field::{Loft, capsule, ellipsoid, union},
    skeleton::{JOINTS, Joint, LEFT},
};

/// Height; half width and half depth; centre towards x and z, of the ellipses through trunk and neck, m.
const TRUNK: [[f32; 5]; 15] = [
    [0.865, 0.095, 0.070, 0.0, 0.0],
    [0.90, 0.140, 0.094, 0.0, -0.006],
    [0.95, 0.163, 0.104, 0.0, -0.010],
    [1.00, 0.158, 0.104, 0.0, -0.004],
    [1.06, 0.140, 0.096, 0.0, 0.002],
    [1.12, 0.128, 0.090, 0.0, 0.004],
    [1.19, 0.136, 0.095, 0.0, 0.004],
    [1.27, 0.152, 0.107, 0.0, 0.006],
    [1.34, 0.163, 0.112, 0.0, 0.002],
    [1.40, 0.163, 0.102, 0.0, -0.008],
    [1.445, 0.138, 0.082, 0.0, -0.018],
    [1.48, 0.085, 0.067, 0.0, -0.022],
    [1.51, 0.059, 0.060, 0.0, -0.020],
    [1.56, 0.053, 0.056, 0.0, -0.010],
    [1.64, 0.052, 0.056, 0.0, 0.004],
];

/// Place along the limb; half width and half depth; centre across it, m.
const UPPER_ARM: [[f32; 5]; 6] = [
    [0.0, 0.052, 0.053, 0.0, 0.0],
    [0.03, 0.056, 0.056, 0.0, 0.0],
    [0.09, 0.053, 0.050, 0.0, 0.0],
    [0.17, 0.046, 0.043, 0.0, 0.0],
    [0.25, 0.040, 0.037, 0.0, 0.0],
    [0.29, 0.039, 0.036, 0.0, 0.0],
];
const LOWER_ARM: [[f32; 5]; 6] = [
    [0.0, 0.039, 0.036, 0.0, 0.0],
    [0.06, 0.042, 0.038, 0.0, 0.0],
    [0.13, 0.037, 0.033, 0.0, 0.0],
    [0.20, 0.030, 0.026, 0.0, 0.0],
    [0.25, 0.028, 0.021, 0.0, 0.0],
    [0.27, 0.028, 0.020, 0.0, 0.0],
];
const HAND: [[f32; 5]; 6] = [
    [0.0, 0.028, 0.021, 0.0, 0.0],
    [0.04, 0.036, 0.0225, 0.002, 0.0],
    [0.08, 0.040, 0.0220, 0.004, -0.001],
    [0.125, 0.036, 0.0205, 0.003, -0.004],
    [0.155, 0.030, 0.0185, 0.001, -0.007],
    [0.165, 0.027, 0.0175, 0.0, -0.008],
];
const THIGH: [[f32; 5]; 6] = [
    [-0.01, 0.064, 0.078, -0.004, -0.004],
    [0.06, 0.076, 0.088, -0.004, 0.0],
    [0.15, 0.073, 0.084, -0.002, 0.004],
    [0.28, 0.065, 0.071, 0.0, 0.006],
    [0.38, 0.055, 0.058, 0.0, 0.002],
    [0.43, 0.052, 0.055, 0.0, 0.003],
];
const SHIN: [[f32; 5]; 6] = [
    [0.0, 0.052, 0.055, 0.0, 0.002],
    [0.05, 0.049, 0.053, 0.0, -0.004],
    [0.13, 0.053, 0.057, 0.002, -0.015],
    [0.25, 0.041, 0.044, 0.0, -0.008],
    [0.34, 0.032, 0.037, 0.0, 0.0],
    [0.40, 0.031, 0.038, 0.0, 0.0],
];
/// Place from the heel to the toes.
const FOOT: [[f32; 5]; 6] = [
    [0.026, 0.027, 0.032, 0.0, 0.034],
    [0.06, 0.032, 0.048, 0.0, 0.040],
    [0.12, 0.037, 0.040, 0.0, 0.030],
    [0.19, 0.045, 0.030, 0.0, 0.020],
    [0.225, 0.042, 0.024, 0.0, 0.016],
    [0.245, 0.033, 0.019, 0.0, 0.013],
];

/// Fillet where lofts go on in each other, which they would thicken, m.
const JOINT: f32 = 0.004;

/// Roundness of the place between the thighs, m.
const CROTCH: f32 = 0.01;

pub struct Anatomy {
    trunk: Loft,
    arm: [Loft; 3],
    leg: [Loft; 3],
}

impl Anatomy {
    pub fn new() -> Self {
        let along = |joint: usize, wide: Vec3, rows: &[[f32; 5]]| {
            let Joint { place, tip, .. } = JOINTS[joint];
            Loft::new(place, tip - place, wide, rows)
        };
        let toes = JOINTS[LEFT.foot].tip;
        let heel = Vec3::new(JOINTS[LEFT.foot].place.x - 0.003, 0.0, -0.085);
        Self {
            trunk: Loft::new(Vec3::ZERO, Vec3::Y, Vec3::X, &TRUNK),
            arm: [
                along(LEFT.upper_arm, Vec3::Z, &UPPER_ARM),
                along(LEFT.lower_arm, Vec3::Z, &LOWER_ARM),
                along(LEFT.hand, Vec3::Z, &HAND),
            ],
            leg: [
                along(LEFT.thigh, Vec3::NEG_X, &THIGH),
                along(LEFT.shin, Vec3::NEG_X, &SHIN),
                Loft::new(heel, (toes - heel).with_y(0.0), Vec3::NEG_X, &FOOT),
            ],
        }
    }

    /// About the distance to the skin.
    pub fn body(&self, point: Vec3) -> f32 {
        let trunk = union(self.trunk(point), self.leg(point), 0.05);
        union(trunk, self.arm(point), 0.035)
    }

    /// Head, neck and trunk.
    pub fn trunk(&self, point: Vec3) -> f32 {
        let point = left_half(point);
        let mut field = self.trunk.field(point);
        let seat = ellipsoid(point, Vec3::new(0.072, 0.905, -0.055), Vec3::new(0.080, 0.085, 0.072));
        field = union(field, seat, 0.05);
        let front = ellipsoid(point, Vec3::new(0.0, 0.880, 0.026), Vec3::new(0.065, 0.060, 0.055));
        field = union(field, front, 0.05);
        let slope = capsule(point, (Vec3::new(0.03, 1.50, -0.034), 0.036), (Vec3::new(0.165, 1.445, -0.026), 0.032));
        field = union(field, slope, 0.05);
        let breast = ellipsoid(point, Vec3::new(0.072, 1.325, 0.068), Vec3::new(0.072, 0.062, 0.044));
        field = union(field, breast, 0.05);
        union(field, head(point), 0.025)
    }

    /// From the shoulder to the fingers.
    pub fn arm(&self, point: Vec3) -> f32 {
        let point = left_half(point);
        let [upper, lower, hand] = &self.arm;
        let arm = union(upper.field(point), lower.field(point), JOINT);
        let wrist = JOINTS[LEFT.hand].place;
        let along = hand.axis;
        let thumb = capsule(
            point,
            (wrist + along * 0.035 + Vec3::Z * 0.026, 0.016),
            (wrist + along * 0.095 + Vec3::Z * 0.056, 0.0125),
        );
        union(union(arm, hand.field(point), JOINT), thumb, 0.02)
    }

    /// From the hip to the toes.
    pub fn leg(&self, point: Vec3) -> f32 {
        // Where both thighs meet there is no crease.
        let point = point.with_x((point.x * point.x + CROTCH * CROTCH).sqrt());
        let [thigh, shin, foot] = &self.leg;
        let leg = union(thigh.field(point), shin.field(point), JOINT);
        // The sole is flat.
        let foot = -union(-foot.field(point), point.y, 0.012);
        union(leg, foot, 0.02)
    }
}

fn head(point: Vec3) -> f32 {
    let skull = ellipsoid(point, Vec3::new(0.0, 1.703, -0.008), Vec3::new(0.074, 0.097, 0.092));
    let face = ellipsoid(point, Vec3::new(0.0, 1.650, 0.034), Vec3::new(0.055, 0.080, 0.062));
    union(skull, face, 0.05)
}

fn left_half(point: Vec3) -> Vec3 {
    Vec3::new(point.x.abs(), point.y, point.z)
}
