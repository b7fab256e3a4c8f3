//! Things whose transform changes from frame to frame.

use core::f32::consts::TAU;

use bevy::prelude::*;

use super::{dice::Dice, place};

/// How something moves.
#[derive(Clone, Copy, Debug)]
pub enum Way {
    /// It stays.
    Still,
    /// On and on, m/s.
    Drift(Vec3),
    /// To and fro, m, so many times a second.
    Swing(Vec3, f32),
    /// Around an axis, rad/s.
    Spin(Vec3, f32),
    /// It grows and shrinks by this share, so many times a second.
    Breathe(f32, f32),
    /// It jumps in one frame of so many.
    Jump(u32),
}

impl Way {
    pub fn roll(dice: &mut Dice) -> Self {
        match dice.count(0..=8) {
            0 => Self::Drift(dice.direction() * dice.spread(0.1, 30.0)),
            1 | 2 => Self::Swing(dice.direction() * dice.spread(0.05, 2.0), dice.spread(0.2, 5.0)),
            3 => Self::Spin(dice.direction(), dice.spread(0.5, 50.0)),
            4 => Self::Breathe(dice.within(0.05, 0.6), dice.spread(0.2, 5.0)),
            5 => Self::Jump(dice.count(3..=30)),
            _ => Self::Still,
        }
    }
}

/// Something that moves.
#[derive(Debug)]
pub struct Mover {
    pub entity: Entity,
    pub way: Way,
    /// Where it was when it began.
    pub home: Transform,
    /// For how long it has moved, s.
    pub age: f32,
}

impl Mover {
    pub fn new(entity: Entity, way: Way, home: Transform) -> Self {
        Self { entity, way, home, age: 0.0 }
    }

    /// Where it is `dt` seconds later. None where it stays.
    pub fn advance(&mut self, dt: f32, dice: &mut Dice) -> Option<Transform> {
        self.age += dt;
        let home = self.home;
        Some(match self.way {
            Way::Still => return None,
            Way::Drift(velocity) => home.with_translation(home.translation + velocity * self.age),
            Way::Swing(way, rate) => home.with_translation(home.translation + way * ops::sin(TAU * rate * self.age)),
            Way::Spin(axis, speed) => {
                home.with_rotation(Quat::from_axis_angle(axis, (speed * self.age) % TAU) * home.rotation)
            }
            Way::Breathe(share, rate) => home.with_scale(home.scale * (1.0 + share * ops::sin(TAU * rate * self.age))),
            Way::Jump(every) => {
                if dice.count(1..=every) > 1 {
                    return None;
                }
                let farthest = dice.spread(0.05, 5.0);
                self.home = place::beginning(dice, farthest);
                self.home
            }
        })
    }
}
