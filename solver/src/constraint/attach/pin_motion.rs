//! Fixed particles follow their pins.

use bevy_math::Vec3A;

use crate::{input::PinMotion, particles::lanes::Lanes};

/// Puts every anchored particle where its pin is at the fraction `end` (0..=1) of a step of `dt` seconds.
pub(crate) fn advance(lanes: &mut Lanes, pin_motions: &[PinMotion], end: f32, dt: f32) {
    for anchor in pin_motions {
        let i = lanes.order.slot(anchor.particle);
        lanes.position.set(i, anchor.start.lerp(anchor.end, end));
        lanes.velocity.set(i, (anchor.end - anchor.start) / dt);
    }
}

/// Mean velocity of what holds the cloth, m/s; none where nothing does.
pub(crate) fn mean_velocity(pin_motions: &[PinMotion], dt: f32) -> Vec3A {
    let way: Vec3A = pin_motions.iter().map(|anchor| anchor.end - anchor.start).sum();
    way / (pin_motions.len().max(1) as f32 * dt)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::order::Order;
    #[test]
    fn a_pin_goes_straight_and_steadily_over_the_step() {
        let mut lanes = Lanes { order: Order::plain(1), ..Lanes::default() };
        lanes.position.resize(1);
        lanes.velocity.resize(1);
        let pin_motions = [PinMotion { particle: 0, start: Vec3A::X, end: Vec3A::X * 3.0 }];
        for quarter in 1..=4 {
            let end = quarter as f32 / 4.0;
            advance(&mut lanes, &pin_motions, end, 0.5);
            assert_eq!(lanes.position.get(0), Vec3A::X * (1.0 + 2.0 * end));
            assert_eq!(lanes.velocity.get(0), Vec3A::X * 4.0);
        }
    }
}
