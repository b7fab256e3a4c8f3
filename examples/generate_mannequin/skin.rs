//! Weights: how much each joint holds of a point, from where it is among the bones.

use bevy::math::Vec3;

use super::{
    anatomy::Anatomy,
    field::smooth,
    skeleton::{CHEST, COUNT, HEAD, JOINTS, LEFT, NECK, PELVIS, RIGHT, SPINE, Side},
};

/// A weight of 1 in the file.
const WHOLE: u16 = u16::MAX;

/// The share of each joint. Their sum is 1.
pub type Shares = [f32; COUNT];

/// Joints and weights of a vertex, as the file has them.
#[derive(Clone, Copy, Default, PartialEq)]
pub struct Influences {
    pub joints: [u8; 4],
    pub weights: [u16; 4],
}

/// The four largest shares, in whole parts whose sum is exactly [`WHOLE`].
pub fn influences(shares: &Shares) -> Influences {
    let mut order: Vec<usize> = (0..COUNT).collect();
    order.sort_by(|&a, &b| shares[b].total_cmp(&shares[a]));
    let strongest = [order[0], order[1], order[2], order[3]];
    let sum: f32 = strongest.iter().map(|&joint| shares[joint]).sum();
    let mut weights = strongest.map(|joint| (shares[joint] / sum * f32::from(WHOLE)) as u16);
    weights[0] = WHOLE - weights[1] - weights[2] - weights[3];
    // A joint that holds nothing is none: zeros, as exporters write them.
    let joints = std::array::from_fn(|slot| if weights[slot] > 0 { strongest[slot] as u8 } else { 0 });
    Influences { joints, weights }
}

/// Shares of a point of the body's skin.
pub fn of_body(anatomy: &Anatomy, point: Vec3) -> Shares {
    let mut shares = of_trunk(point);
    for side in [LEFT, RIGHT] {
        // Fields are symmetric, which limbs' shares aren't.
        let is_here = smooth(0.0, 0.02, point.x * side.sign);
        if is_here > 0.0 {
            let arm = is_here * arm_share(anatomy, point, side);
            let leg = is_here * leg_share(point, side);
            shares = shares.map(|share| share * (1.0 - arm) * (1.0 - leg));
            add_chain(&mut shares, point, arm, [side.upper_arm, side.lower_arm, side.hand], [0.045, 0.03]);
            add_chain(&mut shares, point, leg * (1.0 - arm), [side.thigh, side.shin, side.foot], [0.055, 0.04]);
        }
    }
    shares
}

/// Shares by height only, as if there were no limbs.
pub fn of_trunk(point: Vec3) -> Shares {
    let mut shares = [0.0; COUNT];
    let mut rest = 1.0;
    for (joint, reach) in [(HEAD, 0.03), (NECK, 0.035), (CHEST, 0.08), (SPINE, 0.07)] {
        let above = smooth(-reach, reach, point.y - JOINTS[joint].place.y);
        shares[joint] = rest * above;
        rest *= 1.0 - above;
    }
    shares[PELVIS] = rest;
    shares
}

/// Shares of cloth that hangs about the hips: from hip to knee, thighs hold more and more of it.
pub fn of_skirt(point: Vec3) -> Shares {
    let mut shares = of_trunk(point);
    let legs = 0.8 * smooth(0.98, 0.58, point.y);
    // In front and behind it hangs between both legs.
    let left = smooth(-0.14, 0.14, point.x);
    shares = shares.map(|share| share * (1.0 - legs));
    shares[LEFT.thigh] = legs * left;
    shares[RIGHT.thigh] = legs * (1.0 - left);
    shares
}

/// Shares of a cape: those of the skin at its collar, and lower down those of the trunk.
pub fn of_cape(anatomy: &Anatomy, point: Vec3, looseness: f32) -> Shares {
    let (skin, trunk) = (of_body(anatomy, point), of_trunk(point));
    std::array::from_fn(|joint| skin[joint] + (trunk[joint] - skin[joint]) * looseness)
}

fn arm_share(anatomy: &Anatomy, point: Vec3, side: Side) -> f32 {
    let shoulder = JOINTS[side.upper_arm].place;
    let outwards = Vec3::new(0.93 * side.sign, -0.37, 0.0);
    let is_nearer = smooth(-0.035, 0.035, anatomy.trunk(point) - anatomy.arm(point));
    is_nearer * smooth(-0.055, 0.055, (point - shoulder).dot(outwards))
}

fn leg_share(point: Vec3, side: Side) -> f32 {
    let hip = JOINTS[side.thigh].place;
    let downwards = Vec3::new(0.37 * side.sign, -0.93, 0.0);
    smooth(-0.06, 0.09, (point - hip).dot(downwards))
}

/// Shares out `whole` along a limb: each of its lower joints takes over within `reach` of its place.
fn add_chain(shares: &mut Shares, point: Vec3, whole: f32, chain: [usize; 3], reach: [f32; 2]) {
    let mut rest = whole;
    for (index, reach) in [(2, reach[1]), (1, reach[0])] {
        let (upper, lower) = (&JOINTS[chain[index - 1]], &JOINTS[chain[index]]);
        let along = (lower.place - upper.place).normalize() + (lower.tip - lower.place).normalize();
        let beyond = smooth(-reach, reach, (point - lower.place).dot(along.normalize()));
        shares[chain[index]] += rest * beyond;
        rest *= 1.0 - beyond;
    }
    shares[chain[0]] += rest;
}
