//! Transforms at random.

use bevy::prelude::*;

use super::dice::Dice;

/// Where something begins: not far from where the others do.
pub fn beginning(dice: &mut Dice, farthest: f32) -> Transform {
    let rotation = if dice.chance(0.5) { dice.turn() } else { Quat::IDENTITY };
    let translation = dice.vector(farthest);
    Transform { translation, rotation, scale: scale(dice) }
}

/// Where something finds itself all of a sudden.
pub fn elsewhere(dice: &mut Dice) -> Transform {
    let farthest = dice.spread(0.01, 1000.0);
    let mut place = beginning(dice, farthest);
    if dice.wild(0.3) {
        let odd = Vec3::splat(dice.anything());
        match dice.count(0..=3) {
            0 => place.translation = odd,
            1 => place.scale = odd,
            2 => place.scale.y = 0.0,
            _ => place.rotation = Quat::from_xyzw(odd.x, 0.0, 0.0, 1.0),
        }
    }
    place
}

/// A scale: most often none, and now and then mirrored.
pub fn scale(dice: &mut Dice) -> Vec3 {
    match dice.count(0..=9) {
        0 => Vec3::splat(dice.spread(0.2, 5.0)),
        1 => Vec3::new(dice.spread(0.3, 3.0), dice.spread(0.3, 3.0), dice.spread(0.3, 3.0)),
        2 => Vec3::new(-1.0, 1.0, dice.spread(0.5, 2.0)),
        _ if dice.wild(0.1) => Vec3::splat(dice.anything()),
        _ => Vec3::ONE,
    }
}
