//! A wind's velocity as a designer thinks of it: where to, how steep, how fast.

use core::f32::consts::PI;

use bevy::{math::ops, prelude::*};

use crate::parameter::Parameter;

/// Direction and speed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Reflect)]
pub(super) struct Aim {
    /// Where the wind blows to, seen from above, in degrees: 0 along +Z, 90 along +X, as a rotation about Y turns. The wind's
    /// entity turns it further.
    #[reflect(@Parameter::within("°", (-360.0, 360.0), (-180.0, 180.0)))]
    pub heading: f32,
    /// How steeply the wind blows upwards, in degrees. 0 for along the ground.
    #[reflect(@Parameter::within("°", (-90.0, 90.0), (-90.0, 90.0)))]
    pub elevation: f32,
    /// m/s.
    pub speed: f32,
}

impl Aim {
    pub fn of(velocity: Vec3) -> Self {
        let level = Vec2::new(velocity.x, velocity.z).length();
        // By hand: a conversion by factor keeps 90 degrees 90.
        let degrees = |y: f32, x: f32| ops::atan2(y, x) / PI * 180.0;
        let heading = if level > 0.0 { degrees(velocity.x, velocity.z) } else { 0.0 };
        Self { heading, elevation: degrees(velocity.y, level), speed: velocity.length() }
    }

    pub fn velocity(self) -> Vec3 {
        let (sin, cos) = ops::sin_cos(self.heading / 180.0 * PI);
        let (up, level) = ops::sin_cos(self.elevation / 180.0 * PI);
        let velocity = Vec3::new(sin * level, up, cos * level) * self.speed;
        // Along an axis it is exactly along it.
        velocity.map(|v| if v.abs() < 1e-6 * self.speed { 0.0 } else { v })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_those_of_the_axes() {
        for (velocity, heading, elevation) in [
            (Vec3::Z, 0.0, 0.0),
            (Vec3::X, 90.0, 0.0),
            (Vec3::NEG_X, -90.0, 0.0),
            (Vec3::NEG_Z, 180.0, 0.0),
            (Vec3::Y, 0.0, 90.0),
        ] {
            let aim = Aim { heading, elevation, speed: 3.0 };
            assert_eq!(Aim::of(velocity * 3.0), aim);
            assert_eq!(aim.velocity(), velocity * 3.0);
        }
    }

    #[test]
    fn a_velocity_comes_back() {
        for velocity in [Vec3::new(1.0, 2.0, 3.0), Vec3::new(-4.0, -0.1, 0.2), Vec3::ZERO, Vec3::new(0.0, -5.0, 1e-3)] {
            assert!(Aim::of(velocity).velocity().abs_diff_eq(velocity, 1e-5), "{velocity}");
        }
    }
}
