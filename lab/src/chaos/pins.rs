//! Pins of every kind.

use bevy::{math::Rect, prelude::*};
use bevy_drape::prelude::*;

use super::dice::Dice;

/// Pins of a mesh with so many vertices, to some of these entities among others.
pub fn roll(dice: &mut Dice, vertices: usize, targets: &[Entity]) -> Pins {
    let mut pins = Pins::none();
    for _ in 0..dice.one_of([0, 1, 1, 1, 2]) {
        let group = PinGroup { select: select(dice, vertices as u32), to: target(dice, targets) };
        pins.groups.push(group);
    }
    pins
}

fn select(dice: &mut Dice, vertices: u32) -> PinSelector {
    let last = vertices.saturating_sub(1);
    match dice.count(0..=19) {
        0 => PinSelector::Corners,
        1 | 2 => PinSelector::Edge(edge(dice)),
        3 => PinSelector::EdgeCorners(edge(dice)),
        4 | 5 => PinSelector::Region { min: dice.vector(1.0), max: dice.vector(1.0) },
        6 => PinSelector::UvRegion(Rect::new(0.0, 0.0, dice.within(0.0, 1.0), dice.within(0.0, 1.0))),
        7 => {
            let every = dice.count(2..=9);
            PinSelector::Predicate(PinPredicate::new(move |vertex| vertex.index.is_multiple_of(every)))
        }
        8 if dice.wild(0.5) => PinSelector::Attribute("Pin".into()),
        8 if dice.wild(0.5) => PinSelector::VertexColor(LinearRgba::RED),
        8 if dice.wild(0.5) => PinSelector::Indices(vec![0, vertices, u32::MAX]),
        9 => PinSelector::Indices((0..=last).collect()),
        _ => PinSelector::Indices((0..dice.count(1..=6)).map(|_| dice.count(0..=last)).collect()),
    }
}

fn edge(dice: &mut Dice) -> ClothEdge {
    dice.one_of([ClothEdge::Top, ClothEdge::Bottom, ClothEdge::Left, ClothEdge::Right])
}

fn target(dice: &mut Dice, targets: &[Entity]) -> PinTarget {
    match dice.count(0..=9) {
        0 => PinTarget::World,
        1..=3 => PinTarget::Entity(dice.any(targets)),
        4 if dice.chance(0.3) => PinTarget::Free,
        _ => PinTarget::Cloth,
    }
}
