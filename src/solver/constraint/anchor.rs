//! Fixed particles follow their pins.

use bevy::math::Vec3A;

use crate::solver::{Anchor, Lanes};

/// Puts every anchored particle where its pin is at the fraction `end` (0..=1) of a step of `dt` seconds.
pub(in crate::solver) fn advance(lanes: &mut Lanes, anchors: &[Anchor], end: f32, dt: f32) {
    for anchor in anchors {
        let i = lanes.order.slot(anchor.particle);
        lanes.position.set(i, anchor.start.lerp(anchor.end, end));
        lanes.velocity.set(i, (anchor.end - anchor.start) / dt);
    }
}

/// Mean velocity of what holds the cloth, m/s; none where nothing does.
pub(in crate::solver) fn mean_velocity(anchors: &[Anchor], dt: f32) -> Vec3A {
    let way: Vec3A = anchors.iter().map(|anchor| anchor.end - anchor.start).sum();
    way / (anchors.len().max(1) as f32 * dt)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::order::Order;
    #[test]
    fn a_pin_goes_straight_and_steadily_over_the_step() {
        let mut lanes = Lanes { order: Order::plain(1), ..Lanes::default() };
        lanes.position.resize(1);
        lanes.velocity.resize(1);
        let anchors = [Anchor { particle: 0, start: Vec3A::X, end: Vec3A::X * 3.0 }];
        for quarter in 1..=4 {
            let end = quarter as f32 / 4.0;
            advance(&mut lanes, &anchors, end, 0.5);
            assert_eq!(lanes.position.get(0), Vec3A::X * (1.0 + 2.0 * end));
            assert_eq!(lanes.velocity.get(0), Vec3A::X * 4.0);
        }
    }
}
